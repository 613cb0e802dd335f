// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/point_cache.h"

#include <algorithm>
#include <utility>

namespace arris {
namespace {

// A step that ends in the next interval needs the four samples around each of the two.
constexpr std::size_t kMostKept = 5;

/// The velocity at sample k of three, of the parabola through them:
///     (h1 (p1 - p0)/h0 + h0 (p2 - p1)/h1) / (h0 + h1),   h0, h1 the times between them
Vec3 middle_velocity(const Vec3& p0, const Vec3& p1, const Vec3& p2, double h0, double h1)
{
    return (h1 / h0 * (p1 - p0) + h0 / h1 * (p2 - p1)) / (h0 + h1);
}

}  // namespace

PointCache::PointCache(std::shared_ptr<const PoseSource> source, PoseInterpolation interpolation)
    : source_(std::move(source)), interpolation_(interpolation)
{
}

std::vector<double> PointCache::jumps() const
{
    const std::vector<double>& times = source_->times();
    if (interpolation_ == PoseInterpolation::Cubic || times.size() == 1) return {};
    return {std::upper_bound(times.begin(), times.end(), 0.0), times.end()};
}

PointCache::Sample PointCache::sample(std::size_t index) const
{
    const std::scoped_lock lock(mutex_);
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.index == index; });
    if (found != kept_.end()) {
        std::rotate(found, found + 1, kept_.end());
        return kept_.back().points;
    }
    auto points = std::make_shared<std::vector<Vec3>>();
    source_->read(index, *points);
    if (kept_.size() == kMostKept) kept_.pop_front();
    kept_.push_back({index, std::move(points)});
    return kept_.back().points;
}

void PointCache::find(double time, std::vector<Vec3>& points, std::vector<Vec3>& velocities) const
{
    const std::vector<double>& times = source_->times();
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin() || next == times.end()) {
        points = *sample(next == times.begin() ? 0 : times.size() - 1);
        velocities.assign(points.size(), Vec3::Zero());
        return;
    }
    const auto end = static_cast<std::size_t>(next - times.begin());
    const std::size_t begin = end - 1;
    const double h = times[end] - times[begin];
    const double s = (time - times[begin]) / h;
    const Sample a = sample(begin), b = sample(end);
    points.resize(a->size());
    velocities.resize(a->size());
    if (interpolation_ == PoseInterpolation::Linear) {
        for (std::size_t p = 0; p < points.size(); ++p) {
            const Vec3 way = (*b)[p] - (*a)[p];
            points[p] = (*a)[p] + s * way;
            velocities[p] = way / h;
        }
        return;
    }
    const bool is_first = begin == 0, is_last = end + 1 == times.size();
    const Sample before = is_first ? a : sample(begin - 1);
    const Sample after = is_last ? b : sample(end + 1);
    const double h_before = is_first ? h : times[begin] - times[begin - 1];
    const double h_after = is_last ? h : times[end + 1] - times[end];
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3 &pa = (*a)[p], &pb = (*b)[p];
        const Vec3 way = pb - pa;
        // Velocities at the two samples, times h
        const Vec3 va =
            is_first ? Vec3(Vec3::Zero()) : Vec3(h * middle_velocity((*before)[p], pa, pb, h_before, h));
        const Vec3 vb =
            is_last ? Vec3(Vec3::Zero()) : Vec3(h * middle_velocity(pa, pb, (*after)[p], h, h_after));
        // p(s) = pa + s va + s^2 (3 way - 2 va - vb) + s^3 (va + vb - 2 way)
        const Vec3 square = 3.0 * way - 2.0 * va - vb;
        const Vec3 cube = va + vb - 2.0 * way;
        points[p] = pa + s * (va + s * (square + s * cube));
        velocities[p] = (va + s * (2.0 * square + 3.0 * s * cube)) / h;
    }
}

}  // namespace arris
