// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/scene.h"

#include <algorithm>
#include <cmath>

#include "geometry/sort_unique.h"

namespace arris {

double Friction::with_obstacle(int obstacle, int piece) const
{
    const auto o = static_cast<std::size_t>(obstacle);
    if (o < of_obstacles.size() && of_obstacles[o]) return *of_obstacles[o];
    return of_pieces[static_cast<std::size_t>(piece)];
}

double Friction::between(int piece, int other) const
{
    return between_layers.value_or(
        0.5 * (of_pieces[static_cast<std::size_t>(piece)] + of_pieces[static_cast<std::size_t>(other)]));
}

int piece_of(const Scene& scene, const ClothMesh& mesh, int vertex)
{
    return scene.materials.piece_at(mesh.material[vertex]);
}

bool has_features(const Scene& scene)
{
    return std::any_of(scene.obstacles.begin(), scene.obstacles.end(), [](const MovingObstacle& obstacle) {
        const ObstacleFeatures& features = obstacle.shape().features();
        return !features.edges.empty() || !features.corners.empty();
    });
}

SurfacePlace pin_surface(const Scene& scene, const Pin& pin, double time, const Vec3& place)
{
    if (!pin.follows || !scene.obstacles[*pin.follows].is_deforming()) return {};
    const ObstaclePose pose = scene.obstacles[*pin.follows].at(time);
    const auto on = find_nearest(pose, place);
    return on ? *on : SurfacePlace();
}

Placement pin_placement(const Scene& scene, const Pin& pin, const SurfacePlace& on, double time)
{
    if (!pin.follows) return pin.motion.at(time);
    const MovingObstacle& obstacle = scene.obstacles[*pin.follows];
    if (on.element >= 0) return obstacle.way(0.0, time, on);
    return obstacle.at(time).placement * obstacle.at(0.0).placement.inverse();
}

Vec3 pin_velocity(const Scene& scene, const Pin& pin, const SurfacePlace& on, double time, const Vec3& place)
{
    if (!pin.follows) return pin.motion.velocity_after(time, place);
    const MovingObstacle& obstacle = scene.obstacles[*pin.follows];
    return on.element >= 0 ? obstacle.velocity_after(time, place, on) : obstacle.velocity_after(time, place);
}

std::vector<double> input_jumps(const Scene& scene)
{
    std::vector<double> times;
    const auto add = [&](const std::vector<double>& jumps) {
        times.insert(times.end(), jumps.begin(), jumps.end());
    };
    for (const Pin& pin : scene.pins) {
        if (!pin.follows) add(pin.motion.jumps());
        times.insert(times.end(), {pin.start, pin.release});
    }
    for (const MovingObstacle& obstacle : scene.obstacles) add(obstacle.jumps());
    for (const Pull& pull : scene.pulls) times.insert(times.end(), {pull.start, pull.stop});

    std::erase_if(times, [](double t) { return !(t > 0.0) || !std::isfinite(t); });
    sort_unique(times);
    return times;
}

}  // namespace arris
