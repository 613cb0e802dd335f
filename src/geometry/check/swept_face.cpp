// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/swept_face.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>

#include "geometry/tolerances.h"

namespace arris {
namespace {

std::array<Vec3, 3> corners(const std::vector<Vec3>& positions, const Face& face)
{
    return {positions[face[0]], positions[face[1]], positions[face[2]]};
}

Vec3 normal_of(const std::array<Vec3, 3>& t)
{
    return (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized();
}

}  // namespace

SweptFace::SweptFace(const std::vector<Vec3>& begin, const std::vector<Vec3>& end, const Face& face)
    : begin_(corners(begin, face)), end_(corners(end, face))
{
    for (int k = 0; k < 3; ++k) {
        offsets_[k] = begin_[k] - begin_[0];
        offsets_[3 + k] = end_[k] - begin_[0];
    }
    size_ = 0.0;
    for (const Vec3& offset : offsets_) size_ = std::max(size_, offset.lpNorm<1>());
    own_ = {make_slab(normal_of(begin_)), make_slab(normal_of(end_))};
}

SweptFace::Slab SweptFace::make_slab(const Vec3& normal) const
{
    Slab slab{normal, 0.0, 0.0};
    for (const Vec3& offset : offsets_) {
        const double height = normal.dot(offset);
        slab.low = std::min(slab.low, height);
        slab.high = std::max(slab.high, height);
    }
    return slab;
}

bool SweptFace::is_apart(std::span<const Vec3> points, const Vec3* normal) const
{
    assert(points.size() <= 6);
    std::array<Vec3, 6> offsets;
    double size = size_;
    for (std::size_t k = 0; k < points.size(); ++k) {
        offsets[k] = points[k] - begin_[0];
        size = std::max(size, offsets[k].lpNorm<1>());
    }
    const double margin = 2.0 * kProductRounding * size;
    const auto is_apart_across = [&](const Slab& slab) {
        bool is_above = true, is_below = true;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double height = slab.normal.dot(offsets[k]);
            is_above = is_above && height > slab.high + margin;
            is_below = is_below && height < slab.low - margin;
        }
        return is_above || is_below;
    };
    if (is_apart_across(own_[0]) || is_apart_across(own_[1])) return true;
    return normal && is_apart_across(make_slab(*normal));
}

}  // namespace arris
