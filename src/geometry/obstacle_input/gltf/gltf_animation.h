// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/obstacle_input/gltf/gltf_accessors.h"
#include "geometry/obstacle_input/gltf/gltf_figure.h"

namespace arris {

/// Values in time, glTF 2.0, Appendix C: LINEAR (rotations by slerp along the shorter arc), STEP or
/// CUBICSPLINE. Before the first and after the last key the value is held.
struct GltfSampler {
    enum class Kind { Linear, Step, CubicSpline } kind = Kind::Linear;
    bool is_rotation = false;    ///< x, y, z, w
    std::size_t columns = 0;     ///< numbers of a value
    std::vector<double> times;   ///< s, ascending, at least one
    std::vector<double> values;  ///< one value a key; of a spline tangent in, value, tangent out

    std::vector<double> at(double time) const;
};

/// An animation of a glTF file: translations, rotations and scales of nodes, and weights of their morph
/// targets.
class GltfAnimation {
  public:
    /// The animation named `name`; by default the only one. Throws InputError, without the file's name: where
    /// there is none or more than one, with their names; for keys that do not ascend, numbers that do not fit
    /// the keys, targets that are not there, and rotations of length 0.
    GltfAnimation(const nlohmann::json& file, const std::optional<std::string>& name,
                  const GltfFigure& figure, GltfAccessors& accessors);

    double first_key() const { return first_key_; }  ///< s
    double last_key() const { return last_key_; }    ///< s

    /// Changes what the animation moves to its state at a time.
    void apply(double time, GltfPose& pose) const;

  private:
    enum class Path { Translation, Rotation, Scale, Weights };
    struct Channel {
        std::size_t node = 0;
        Path path = Path::Translation;
        GltfSampler sampler;
    };

    std::vector<Channel> channels_;
    double first_key_ = 0.0, last_key_ = 0.0;
};

}  // namespace arris
