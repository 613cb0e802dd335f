// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/obstacle_input/formats/input_file.h"
#include "geometry/obstacle_input/usd/usda_stage.h"

namespace arris {

/// An operation of `xformOpOrder`, with its values in time.
struct UsdOperation {
    /// Axes of rotation in the order in which they turn, "XYZ"; empty for the others.
    std::string axes;
    enum class Kind { Translate, Scale, Rotate, Orient, Transform } kind = Kind::Translate;
    bool is_inverse = false;
    std::vector<double> time_codes;              ///< empty: one value for all times
    std::vector<std::array<double, 16>> values;  ///< of each time code
};

/// The placement of a prim in the world: its operations and those of the prims above it. Between time codes
/// values are interpolated as in OpenUSD: linearly, quaternions along the shorter arc.
class UsdTransform {
  public:
    /// Reads all values. Throws InputError, one line that begins with the file's path, for operations that
    /// are missing or unknown, and for numbers that are not finite.
    UsdTransform(const InputFile& file, const UsdStage& stage, int prim);

    /// Time codes of all operations, ascending.
    const std::vector<double>& time_codes() const { return time_codes_; }

    /// Takes column vectors of the prim to the world, in the file's units and axes.
    Eigen::Matrix4d at(double time_code) const;

  private:
    std::vector<UsdOperation> operations_;  // the world's first
    std::vector<double> time_codes_;
};

}  // namespace arris
