// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon_touch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "geometry/box_tree.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr double kFarRounding = 2e-7;  // relative to the greatest coordinate
constexpr std::size_t kMostCorners = 10'000;

// A side that is bent to run through a corner may then touch another one.
constexpr int kMostRounds = 3;

Eigen::AlignedBox2d bounds_of(const std::vector<Vec2>& corners)
{
    Eigen::AlignedBox2d bounds;
    for (const Vec2& p : corners) bounds.extend(p);
    return bounds;
}

Vec3 lifted(const Vec2& p)
{
    return {p.x(), p.y(), 0.0};
}

class TouchJoiner {
  public:
    TouchJoiner(const std::vector<Vec2>& corners, const std::vector<int>& order, double tolerance)
        : corners_(corners), order_(order), tolerance_(tolerance)
    {
    }

    PolygonLoop join()
    {
        join_corners();
        bool is_changed = true;
        for (int round = 0; round < kMostRounds && is_changed; ++round) is_changed = bend_sides();
        return std::move(loop_);
    }

  private:
    bool are_near(int a, int b) const { return (corners_[a] - corners_[b]).norm() <= tolerance_; }

    // Corners that stand for themselves are in the cells of a grid. Cells are as wide as the tolerance, so
    // each holds a few of them.
    void join_corners()
    {
        const Vec2 origin = bounds_of(corners_).min();
        std::map<std::array<std::int64_t, 2>, std::vector<std::size_t>> cells;
        for (std::size_t at = 0; at < order_.size(); ++at) {
            const int corner = order_[at];
            const Vec2 scaled = ((corners_[corner] - origin) / tolerance_).array().floor();
            const auto column = static_cast<std::int64_t>(scaled.x());
            const auto row = static_cast<std::int64_t>(scaled.y());
            std::size_t first = at;
            for (std::int64_t i = column - 1; i <= column + 1; ++i)
                for (std::int64_t j = row - 1; j <= row + 1; ++j)
                    if (const auto cell = cells.find({i, j}); cell != cells.end())
                        for (const std::size_t other : cell->second)
                            if (other < first && may_join(other, at)) first = other;
            if (first == at)
                cells[{column, row}].push_back(at);
            else
                loop_.joined.push_back({corner, order_[first]});
            if (first == at) standing_.push_back(corner);
            loop_.corners.push_back(order_[first]);
        }
    }

    // A side between near corners is a short side, not a touch.
    bool may_join(std::size_t a, std::size_t b) const
    {
        if (!are_near(order_[a], order_[b])) return false;
        const bool has_side = b == a + 1 || (a == 0 && b + 1 == order_.size());
        return !has_side || corners_[order_[a]] == corners_[order_[b]];
    }

    bool bend_sides()
    {
        const std::vector<int> before = std::exchange(loop_.corners, {});
        std::vector<BoxTree::Box> boxes;
        for (std::size_t k = 0; k < before.size(); ++k) {
            BoxTree::Box box(lifted(corners_[before[k]]));
            box.extend(lifted(corners_[before[(k + 1) % before.size()]]));
            boxes.push_back(box);
        }
        const BoxTree sides(boxes);
        std::vector<std::vector<std::pair<double, int>>> met(before.size());  // by each side, and where
        for (const int corner : standing_) {
            const Vec3 p = lifted(corners_[corner]), reach = Vec3::Constant(tolerance_);
            sides.visit(BoxTree::Box(p - reach, p + reach), [&](int k) {
                const int a = before[k], b = before[(k + 1) % before.size()];
                const double where = meet(a, b, corner);
                if (where > 0.0) met[k].emplace_back(where, corner);
            });
        }
        for (std::size_t k = 0; k < before.size(); ++k) {
            loop_.corners.push_back(before[k]);
            std::sort(met[k].begin(), met[k].end());
            for (const auto& [where, corner] : met[k]) loop_.corners.push_back(corner);
        }
        return loop_.corners.size() > before.size();
    }

    // Where along the side from `a` to `b`, as a share of it, a corner is near it; 0 if nowhere but near its
    // ends.
    double meet(int a, int b, int corner) const
    {
        if (are_near(a, corner) || are_near(b, corner)) return 0.0;
        const Vec2 side = corners_[b] - corners_[a], p = corners_[corner] - corners_[a];
        const double length = side.norm();
        const double along = p.dot(side) / length;
        const double across = std::abs(side.x() * p.y() - side.y() * p.x()) / length;
        if (!(along > 0.0 && along < length && across <= tolerance_)) return 0.0;
        return along / length;
    }

    const std::vector<Vec2>& corners_;
    const std::vector<int>& order_;
    double tolerance_;
    std::vector<int> standing_;  // corners that stand for themselves
    PolygonLoop loop_;
};

}  // namespace

double rounding_of(const std::vector<Vec2>& corners)
{
    const Eigen::AlignedBox2d bounds = bounds_of(corners);
    const double size = bounds.diagonal().norm();
    const double farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
    return std::min(std::max(kSinglePrecision * size, kFarRounding * farthest), kThreeDigits * size);
}

PolygonLoop join_touches(const std::vector<Vec2>& corners, const std::vector<int>& order, double tolerance)
{
    if (order.size() > kMostCorners || !(tolerance > 0.0)) return {order, {}};
    return TouchJoiner(corners, order, tolerance).join();
}

}  // namespace arris
