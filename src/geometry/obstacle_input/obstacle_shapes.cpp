// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr int kMostTeeth = 10000;

void require_length(const char* what, double value)
{
    if (!(value > 0.0 && value <= kLargestCoordinate))
        throw InputError(
            fmt::format("{} {} m must be positive and at most {:g} m", what, value, kLargestCoordinate));
}

void require_places(const std::vector<Vec3>& points)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3& p = points[i];
        if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= kLargestCoordinate))
            throw InputError(
                fmt::format("point {} ({}, {}, {}) must be finite and within {:g} m of the origin", i + 1,
                            p.x(), p.y(), p.z(), kLargestCoordinate));
    }
}

bool comes_before(const Vec3& p, const Vec3& q)
{
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
}

// A point of the profile in the x-z plane, from left to right.
struct ProfilePoint {
    double x;
    double z;
};

// The upper outline of the teeth, from one end of the slab to the other.
std::vector<ProfilePoint> teeth_profile(const TeethShape& shape, double half_base)
{
    const double half_length = 0.5 * shape.count * shape.pitch;
    // A narrower flat valley is rounding of tan(): the valley was meant to have no width.
    const bool has_valleys = 0.5 * shape.pitch - half_base > kComputed * shape.pitch;
    std::vector<ProfilePoint> profile = {{-half_length, 0.0}};
    for (int k = 0; k < shape.count; ++k) {
        const double tip = (k + 0.5) * shape.pitch - half_length;
        if (has_valleys) profile.push_back({tip - half_base, 0.0});
        profile.push_back({tip, shape.height});
        if (has_valleys) profile.push_back({tip + half_base, 0.0});
        if (!has_valleys && k + 1 < shape.count)
            profile.push_back({(k + 1) * shape.pitch - half_length, 0.0});
    }
    profile.push_back({half_length, 0.0});
    return profile;
}

// The solid between the profile and the plane z = -depth. Each profile point has a base point below it. So
// front and back are strips of triangles, and no point lies in the interior of another triangle's edge.
ObstacleMesh extrude(const std::vector<ProfilePoint>& profile, double depth, double width)
{
    ObstacleMesh mesh;
    for (const ProfilePoint& p : profile)
        for (const double y : {-0.5 * width, 0.5 * width}) {
            mesh.points.emplace_back(p.x, y, p.z);
            mesh.points.emplace_back(p.x, y, -depth);
        }
    // Profile point i has points 4 i (front top), + 1 (front base), + 2 (back top), + 3 (back base).
    const auto add_quad = [&](int a, int b, int c, int d) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    };
    const int count = static_cast<int>(profile.size());
    add_quad(0, 2, 3, 1);  // the end at smallest x
    for (int i = 0; i + 1 < count; ++i) {
        const int p = 4 * i;
        const int q = p + 4;
        add_quad(p, q, q + 2, p + 2);          // top
        add_quad(p + 1, p + 3, q + 3, q + 1);  // base
        add_quad(p + 1, q + 1, q, p);          // front, y = -width / 2
        add_quad(p + 3, p + 2, q + 2, q + 3);  // back
    }
    const int last = 4 * (count - 1);
    add_quad(last, last + 1, last + 3, last + 2);  // the end at largest x
    return mesh;
}

}  // namespace

ObstacleMesh make_box(const Vec3& sizes)
{
    for (int axis = 0; axis < 3; ++axis) {
        constexpr const char* kNames[] = {"size along x", "size along y", "size along z"};
        require_length(kNames[axis], sizes[axis]);
    }
    const double x = 0.5 * sizes.x();
    return extrude({{-x, sizes.z() * 0.5}, {x, sizes.z() * 0.5}}, 0.5 * sizes.z(), sizes.y());
}

ObstacleMesh make_points(const std::vector<Vec3>& points)
{
    if (points.empty()) throw InputError("no points; allowed: at least 1");
    require_places(points);
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j) { return comes_before(points[i], points[j]); });
    const auto twin =
        std::adjacent_find(order.begin(), order.end(), [&](int i, int j) { return points[i] == points[j]; });
    if (twin != order.end())
        throw InputError(fmt::format("points {} and {} coincide", *twin + 1, *(twin + 1) + 1));
    ObstacleMesh mesh;
    mesh.points = points;
    mesh.lone_points.resize(points.size());
    std::iota(mesh.lone_points.begin(), mesh.lone_points.end(), 0);
    return mesh;
}

ObstacleMesh make_wire(const std::vector<Vec3>& points, bool is_closed)
{
    const std::size_t least = is_closed ? 3 : 2;
    if (points.size() < least)
        throw InputError(fmt::format("{} points; {} wire has at least {}", points.size(),
                                     is_closed ? "a closed" : "a", least));
    require_places(points);
    ObstacleMesh mesh;
    mesh.points = points;
    const int count = static_cast<int>(points.size());
    for (int i = 0; i < (is_closed ? count : count - 1); ++i) {
        const int next = (i + 1) % count;
        if (points[i] == points[next])
            throw InputError(
                fmt::format("points {} and {}, which a segment joins, coincide{}", i + 1, next + 1,
                            next == 0 ? " (a closed wire joins the last to the first by itself)" : ""));
        mesh.segments.push_back({i, next});
    }
    return mesh;
}

ObstacleMesh make_teeth(const TeethShape& shape)
{
    if (shape.count < 1 || shape.count > kMostTeeth)
        throw InputError(fmt::format("count {} must be from 1 to {}", shape.count, kMostTeeth));
    require_length("pitch", shape.pitch);
    require_length("height", shape.height);
    require_length("width", shape.width);
    require_length("length, count times pitch,", shape.count * shape.pitch);
    if (!(shape.tip_degrees > 0.0 && shape.tip_degrees < 180.0))
        throw InputError(fmt::format("tip_degrees {} must be above 0 and below 180", shape.tip_degrees));

    const double half_base = shape.height * std::tan(0.5 * shape.tip_degrees * std::numbers::pi / 180.0);
    if (0.5 * shape.pitch - half_base < -kComputed * shape.pitch)
        throw InputError(fmt::format(
            "teeth {:.6g} m wide at their base (2 height tan(tip_degrees / 2)) overlap at pitch {} m: "
            "allowed "
            "are a pitch of at least {:.6g} m, a height of at most {:.6g} m, or tip_degrees of at most "
            "{:.6g}",
            2.0 * half_base, shape.pitch, 2.0 * half_base, shape.height * 0.5 * shape.pitch / half_base,
            2.0 * std::atan(0.5 * shape.pitch / shape.height) * 180.0 / std::numbers::pi));
    return extrude(teeth_profile(shape, half_base), shape.height, shape.width);
}

}  // namespace arris
