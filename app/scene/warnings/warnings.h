// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "app/scene/keys/scene_document.h"
#include "app/text/printable.h"
#include "geometry/vectors.h"

namespace arris {

/// Whether a value of the scene file is 0. An exact test suffices, as 0 is written as 0.
inline bool is_zero(double value)
{
    return !(value < 0.0) && !(value > 0.0);
}
inline bool is_zero(const Vec3& value)
{
    return is_zero(value.squaredNorm());
}

/// Collects warnings about keys that are written.
class Warnings {
  public:
    explicit Warnings(const SceneDocument& document) : document_(document) {}

    bool is_written(const std::string& key) const { return document_.find(key) != nullptr; }

    void add(const std::string& key, const std::string& why)
    {
        if (is_written(key))
            lines_.push_back(fmt::format("{}: has no effect: {}", document_.describe(key), why));
    }

    /// For a key that takes effect, but with a surprising result.
    void note(const std::string& key, const std::string& what)
    {
        lines_.push_back(fmt::format("{}: {}", document_.describe(key), what));
    }

    /// For the scene as a whole.
    void note(const std::string& what)
    {
        lines_.push_back(fmt::format("{}: {}", printable(document_.path()), what));
    }

    std::vector<std::string> lines_;

  private:
    const SceneDocument& document_;
};

}  // namespace arris
