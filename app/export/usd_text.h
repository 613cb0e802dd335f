// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <iterator>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

// Values of a USD text file: put() appends one; numbers read back to the same double.

inline void put(fmt::memory_buffer& out, std::string_view text)
{
    out.append(text);
}

inline void put(fmt::memory_buffer& out, int value)
{
    fmt::format_to(std::back_inserter(out), "{}", value);
}

inline void put(fmt::memory_buffer& out, double value)
{
    fmt::format_to(std::back_inserter(out), "{}", value);
}

inline void put(fmt::memory_buffer& out, const Face& face)
{
    fmt::format_to(std::back_inserter(out), "{}, {}, {}", face[0], face[1], face[2]);
}

template <class Vector>
void put(fmt::memory_buffer& out, const Vector& vector)
{
    for (Eigen::Index i = 0; i < vector.size(); ++i) {
        put(out, std::string_view(i == 0 ? "(" : ", "));
        put(out, vector[i]);
    }
    put(out, std::string_view(")"));
}

template <class Items>
void put_array(fmt::memory_buffer& out, const Items& items)
{
    std::string_view separator = "[";
    for (const auto& item : items) {
        put(out, separator);
        put(out, item);
        separator = ", ";
    }
    put(out, std::string_view(items.empty() ? "[]" : "]"));
}

/// Appends the bounding box of points as an attribute `extent` has it; zeros without points.
inline void put_bounds(fmt::memory_buffer& out, const std::vector<Vec3>& points)
{
    Vec3 least = Vec3::Zero(), greatest = Vec3::Zero();
    if (!points.empty()) least = greatest = points.front();
    for (const Vec3& x : points) {
        least = least.cwiseMin(x);
        greatest = greatest.cwiseMax(x);
    }
    put_array(out, std::array{least, greatest});
}

}  // namespace arris
