// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/motion_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace arris {

namespace {

constexpr double kMostTurn = std::numbers::pi / 2.0;

double distance_of_chord(const Vec3& begin, const Vec3& middle, const Vec3& end)
{
    return (middle - 0.5 * (begin + end)).norm();
}

Box3 box_of(const std::vector<Vec3>& points)
{
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    return box;
}

Box3 grown(const Box3& box, double by)
{
    return Box3(box.min().array() - by, box.max().array() + by);
}

/// Greatest distance (m) of arc and chord during `dt`, of the points of faces, wires and nails that the cloth
/// may meet.
double arc_of_deforming(const MovingObstacle& obstacle, const State& state, double dt)
{
    const ObstaclePose pose = obstacle.at(state.time);
    const std::vector<Vec3>& begin = pose->mesh().points;
    const std::vector<Vec3> middle = obstacle.points_at(state.time + 0.5 * dt),
                            end = obstacle.points_at(state.time + dt);
    double way = longest_way(begin, end);
    for (const Vec3& v : state.velocity) way = std::max(way, dt * v.norm());
    const Box3 near = grown(box_of(state.mesh.world), 2.0 * way);
    if (!near.intersects(pose->bounds())) return 0.0;
    double most = 0.0;
    const auto look_at = [&](int p) {
        most = std::max(most, distance_of_chord(begin[p], middle[p], end[p]));
    };
    std::vector<int> found;
    pose->find_faces(near, found);
    for (const int f : found)
        for (const int p : pose->mesh().faces[f]) look_at(p);
    for (const auto& [p, q] : pose->mesh().segments) {
        look_at(p);
        look_at(q);
    }
    for (const int p : pose->mesh().lone_points) look_at(p);
    return most;
}

/// Greatest distance (m) of arc and chord during `dt`, of the cloth's vertices near the obstacle if they rode
/// on it.
double arc_of_rigid(const MovingObstacle& obstacle, const State& state, double dt)
{
    const ObstaclePose begin = obstacle.at(state.time);
    const Placement middle = obstacle.at(state.time + 0.5 * dt).placement,
                    end = obstacle.at(state.time + dt).placement;
    double most = 0.0;
    for (std::size_t v = 0; v < state.mesh.world.size(); ++v) {
        const Vec3& x = state.mesh.world[v];
        const Vec3 place = begin.placement.inverse(x);
        const double way = (end(place) - x).norm() + dt * state.velocity[v].norm();
        if (begin->bounds().squaredExteriorDistance(place) <= 4.0 * way * way)
            most = std::max(most, distance_of_chord(x, middle(place), end(place)));
    }
    return most;
}

int find_parts(const MovingObstacle& obstacle, double thickness, const State& state, double dt)
{
    int parts = 1;
    const double turn = obstacle.motion().fastest_turn() * dt;
    if (!(turn > 0.0) && !obstacle.is_deforming()) return parts;
    while (parts < kMostMotionParts && turn > parts * kMostTurn) parts *= 2;
    const double part = dt / parts;
    const double arc = obstacle.is_deforming() ? arc_of_deforming(obstacle, state, part)
                                               : arc_of_rigid(obstacle, state, part);
    // In a half of the time the distance is a quarter.
    for (double left = arc; parts < kMostMotionParts && left > kMostChordShare * thickness; left /= 4.0)
        parts *= 2;
    return parts;
}

}  // namespace

int find_motion_parts(const Scene& scene, const State& state, double dt)
{
    int parts = 1;
    for (const MovingObstacle& obstacle : scene.obstacles)
        if (obstacle.is_moving())
            parts = std::max(parts, find_parts(obstacle, scene.materials.thickness(), state, dt));
    return parts;
}

}  // namespace arris
