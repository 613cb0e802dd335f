// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// A step as the caller asks for it. `advance` may make it in several parts. Remeshing goes by planned steps:
/// only the first part may change cells, and only the last one counts the step.
struct PlannedStep {
    double begin, end;  ///< s

    double length() const { return end - begin; }
    bool begins_at(double time) const { return time <= begin; }
    bool ends_at(double time) const { return time >= end; }
};

}  // namespace arris
