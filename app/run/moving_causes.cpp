// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/moving_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/cloth/material_region.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/obstacle/obstacle_distance.h"

namespace arris {
namespace {

constexpr double kNear = 2.0;  // edges of the mesh

/// How far and how fast points of a body have moved from time 0 up to a time.
struct Way {
    double length = 0.0;  ///< m, greatest distance from the start
    double speed = 0.0;   ///< m/s, greatest
};

/// Times from 0 to `end` (s) with all jumps of the motion between.
std::vector<double> sample_times(const std::vector<double>& jumps, double end)
{
    constexpr int kSamples = 64;
    std::vector<double> times;
    for (int k = 0; k <= kSamples; ++k) times.push_back(end * k / kSamples);
    for (const double jump : jumps)
        if (jump < end) times.push_back(jump);
    std::sort(times.begin(), times.end());
    return times;
}

/// `place(point, time)` is where a point of the body is, and `velocity(time, place)` how it then moves.
template <class Place, class Velocity>
Way measure_way(const std::vector<double>& times, const std::vector<Vec3>& points, Place place,
                Velocity velocity)
{
    Way way;
    std::vector<Vec3> start;
    for (const Vec3& point : points) start.push_back(place(point, times.front()));
    for (const double time : times)
        for (std::size_t p = 0; p < points.size(); ++p) {
            const Vec3 at = place(points[p], time);
            way.length = std::max(way.length, (at - start[p]).norm());
            if (time < times.back()) way.speed = std::max(way.speed, velocity(time, at).norm());
        }
    return way;
}

/// Place at time `to` of something that rides on an obstacle and is at `place` (world) at time `from`.
Vec3 ridden(const MovingObstacle& obstacle, double from, const Vec3& place, double to)
{
    const ObstaclePose pose = obstacle.at(from);
    if (!obstacle.is_deforming()) return obstacle.at(to).placement(pose.placement.inverse(place));
    const auto on = find_nearest(pose, place);
    return on ? obstacle.way(from, to, *on)(place) : place;
}

std::vector<Vec3> corners_of(const Box3& box)
{
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k) corners.push_back(box.corner(static_cast<Box3::CornerType>(k)));
    return corners;
}

/// Strain (size) of a long strip of cloth that is hit at `speed`.
double strain_of_impact(const Material& material, double speed)
{
    const double ratio = speed / std::sqrt(material.youngs_modulus / material.density);
    double least = 0.0, most = 1.0;
    const auto ratio_of = [](double e) { return std::sqrt(2.0 * e * std::sqrt(e * (1.0 + e)) - e * e); };
    if (ratio >= ratio_of(most)) return most;
    for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (least + most);
        (ratio_of(middle) < ratio ? least : most) = middle;
    }
    return least;
}

/// Strain of cloth that is held at `distance` and pushed aside by `way`.
double strain_of_way(double way, double distance)
{
    return std::hypot(1.0, way / distance) - 1.0;
}

class Motions {
  public:
    Motions(const RunConfig& config, const StrainPeak& peak, double edge)
        : config_(config), scene_(config.scene), peak_(peak), edge_(edge)
    {
        const int piece = config.scene.materials.piece_at(peak.material);
        const ClothMesh mesh = extract_piece(config, static_cast<std::size_t>(piece));
        half_ = 0.5 * material_extents(mesh).minCoeff();
    }

    MovingCause find()
    {
        for (std::size_t i = 0; i < scene_.obstacles.size(); ++i) add_obstacle(i);
        for (std::size_t i = 0; i < scene_.pins.size(); ++i) add_pin(i);
        double speed = 0.0;
        for (const Vec3& velocity : config_.cloth_velocity) speed = std::max(speed, velocity.norm());
        if (speed > 0.0 && !(scene_.obstacles.empty() && scene_.pins.empty()))
            add({0.0, speed}, half_, false, "the cloth (cloth.velocity)", false);
        return greatest_;
    }

  private:
    void add_obstacle(std::size_t i)
    {
        const MovingObstacle& obstacle = scene_.obstacles[i];
        if (!obstacle.is_moving()) return;
        const ObstaclePose pose = obstacle.at(peak_.time);
        const Vec3 at_peak = pose.placement.inverse(peak_.world);
        const double reach = scene_.materials.thickness() + kNear * edge_;
        const bool is_near = distance_to(pose, at_peak, 2.0 * reach) <= reach;
        std::vector<Vec3> points = is_near ? std::vector<Vec3>{at_peak} : corners_of(pose->bounds());
        for (Vec3& point : points) point = pose.placement(point);
        const Way way = measure_way(
            sample_times(obstacle.jumps(), peak_.time), points,
            [&](const Vec3& point, double time) { return ridden(obstacle, peak_.time, point, time); },
            [&](double time, const Vec3& place) { return obstacle.velocity_after(time, place); });
        const bool is_held = !scene_.pins.empty() || scene_.obstacles.size() > 1;
        add(way, is_near ? distance_to_pins() : half_, is_held, obstacle.name(), is_near);
    }

    void add_pin(std::size_t i)
    {
        const Pin& pin = scene_.pins[i];
        const MovingObstacle* followed =
            pin.follows ? &scene_.obstacles[static_cast<std::size_t>(*pin.follows)] : nullptr;
        const double end = std::min(peak_.time, pin.release);
        const bool is_moving = followed ? followed->is_moving() : pin.motion.is_moving();
        if (!is_moving || !(end > pin.start)) return;
        std::vector<Vec3> points;
        for (const int v : vertices_inside(config_.cloth, pin.material))
            points.push_back(config_.cloth.world[static_cast<std::size_t>(v)]);
        const Way way = measure_way(
            sample_times(followed ? followed->jumps() : pin.motion.jumps(), end), points,
            [&](const Vec3& point, double time) {
                const SurfacePlace on = pin_surface(scene_, pin, 0.0, point);
                return pin_placement(scene_, pin, on, std::max(time, pin.start))(point);
            },
            [&](double time, const Vec3& place) -> Vec3 {
                if (time < pin.start) return Vec3::Zero();
                return pin_velocity(scene_, pin, pin_surface(scene_, pin, time, place), time, place);
            });
        const bool is_near = pin.material.distance(peak_.material) <= kNear * edge_;
        // Where two pins hold the cloth, their distance tells more (strain_causes).
        add(way, half_, !scene_.obstacles.empty(), fmt::format("pin.{}", i), is_near);
    }

    /// Distance (m) in the material from the peak to the nearest pin: at least an edge of the mesh, at most
    /// half of the cloth's shorter side.
    double distance_to_pins() const
    {
        double least = half_;
        for (const Pin& pin : scene_.pins) least = std::min(least, pin.material.distance(peak_.material));
        return std::max(least, edge_);
    }

    /// Keeps the motion if it strains the cloth more than the one so far. `is_held`: something else holds the
    /// cloth, at `distance`.
    void add(const Way& way, double distance, bool is_held, const std::string& name, bool is_near)
    {
        constexpr double kCounts = 0.05;  // strain for which a remedy is told
        const double by_speed = strain_of_impact(scene_.materials.at(peak_.material), way.speed);
        const double by_way = is_held ? strain_of_way(way.length, distance) : 0.0;
        const double strain = std::max(by_speed, by_way);
        if (is_near < greatest_.is_near || (is_near == greatest_.is_near && !(strain > greatest_.strain)))
            return;
        greatest_ = {strain, is_near, name, "move it "};
        greatest_.what += way.length > 0.0
                              ? fmt::format(" moves {:.3g} m, at up to {:.3g} m/s", way.length, way.speed)
                              : fmt::format(" starts at {:.3g} m/s", way.speed);
        greatest_.remedy += by_speed > kCounts && by_way > kCounts ? "more slowly or less far"
                            : by_speed > by_way                    ? "more slowly"
                                                                   : "less far";
    }

    const RunConfig& config_;
    const Scene& scene_;
    const StrainPeak& peak_;
    double edge_;        // m, mean
    double half_ = 0.0;  // m, half of the cloth's shorter side
    MovingCause greatest_;
};

}  // namespace

MovingCause find_moving_cause(const RunConfig& config, const StrainPeak& peak, double edge)
{
    return Motions(config, peak, edge).find();
}

}  // namespace arris
