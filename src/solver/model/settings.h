// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

enum class Integrator { ImplicitEuler, Bdf2 };

/// Thrown within a step where Settings::is_interrupted says so. The state stays that of the last accepted
/// part.
struct Interrupted {};

/// Numbers a user may choose.
struct Settings {
    Integrator integrator = Integrator::Bdf2;
    double step = 0.005;      ///< s, the longest step
    double tolerance = 1e-9;  ///< greatest relative KKT residual accepted; lower is free down to about 1e-12
    bool (*is_interrupted)() = nullptr;  ///< asked several times in each solve; may be null

    void stop_if_interrupted() const
    {
        if (is_interrupted && is_interrupted()) throw Interrupted();
    }
};

}  // namespace arris
