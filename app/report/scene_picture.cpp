// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/scene_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "app/report/raster.h"

namespace arris {
namespace {

constexpr int kWidth = 1440, kHeight = 900;  // pixels, before halving
constexpr int kPreview = 8;                  // how much smaller the views are that are compared
constexpr double kAzimuths[] = {-60.0, 30.0, 120.0, 210.0};  // degrees, of the viewer seen from the cloth
constexpr double kElevation = 28.0;                          // degrees
constexpr double kMargin = 0.04;                             // of the image's size, on each side
constexpr double kAround = 0.5;  // of the cloth's size, how far the view may reach beyond the cloth
constexpr double kLift = 8.0;    // pixels that lines are nearer than the faces they lie in
constexpr Colour kFront = {86, 140, 214}, kBack = {222, 160, 92}, kObstacle = {176, 178, 182},
                 kWire = {110, 114, 120}, kEolEdge = {226, 40, 130};

/// The viewer's axes in the world, in rows: right, up, and towards the viewer.
Mat3 view_axes(double degrees)
{
    const double azimuth = degrees * std::numbers::pi / 180.0;
    const double elevation = kElevation * std::numbers::pi / 180.0;
    const Vec3 towards(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation));
    const Vec3 right(-std::sin(azimuth), std::cos(azimuth), 0.0);
    Mat3 axes;
    axes.row(0) = right.transpose();
    axes.row(1) = towards.cross(right).transpose();
    axes.row(2) = towards.transpose();
    return axes;
}

struct Rectangle {
    Vec2 min = Vec2::Constant(std::numeric_limits<double>::infinity());
    Vec2 max = -min;

    void add(const Vec3& point)
    {
        min = min.cwiseMin(point.head<2>());
        max = max.cwiseMax(point.head<2>());
    }
};

/// The cloth's points and those of each obstacle, in pixels.
struct Projection {
    std::vector<Vec3> cloth;
    std::vector<std::vector<Vec3>> obstacles;
};

/// Scales and moves points in the viewer's axes so that `shown` fits the image.
void fit(const Rectangle& shown, std::vector<Vec3>& points)
{
    const Vec2 image(kWidth, kHeight), size = (shown.max - shown.min).cwiseMax(1e-300);
    const double scale = (1.0 - 2.0 * kMargin) * image.cwiseQuotient(size).minCoeff();
    const Vec2 middle = 0.5 * (shown.min + shown.max);
    for (Vec3& p : points) {
        p *= scale;
        p.head<2>() += 0.5 * image - scale * middle;
    }
}

Projection project(const Frame& cloth, const std::vector<ObstacleRecord>& obstacles, double time,
                   double azimuth)
{
    const Mat3 axes = view_axes(azimuth);
    Projection seen;
    Rectangle shown, all;
    for (const Vec3& x : cloth.world) shown.add(seen.cloth.emplace_back(axes * x));
    all = shown;
    for (const ObstacleRecord& obstacle : obstacles) {
        std::vector<Vec3>& here = seen.obstacles.emplace_back(obstacle.world_points(time));
        for (Vec3& p : here) {
            p = axes * p;
            all.add(p);
        }
    }
    const Vec2 around = Vec2::Constant(kAround * (shown.max - shown.min).maxCoeff());
    shown.min = all.min.cwiseMax(shown.min - around);
    shown.max = all.max.cwiseMin(shown.max + around);
    fit(shown, seen.cloth);
    for (std::vector<Vec3>& points : seen.obstacles) fit(shown, points);
    return seen;
}

/// Number of pixels of a small image in which the cloth is in front.
std::size_t count_cloth_pixels(const Frame& cloth, const std::vector<ObstacleRecord>& obstacles,
                               const Projection& seen)
{
    Raster raster(kWidth / kPreview, kHeight / kPreview);
    const auto draw = [&](const std::vector<Vec3>& points, const std::vector<Face>& faces,
                          const Colour& colour) {
        for (const auto& [a, b, c] : faces)
            raster.draw_triangle(points[a] / kPreview, points[b] / kPreview, points[c] / kPreview, colour);
    };
    for (std::size_t i = 0; i < obstacles.size(); ++i)
        draw(seen.obstacles[i], obstacles[i].mesh.faces, kObstacle);
    draw(seen.cloth, cloth.faces, kFront);
    return raster.count(kFront);
}

/// The colour of a face under light from the upper left; `normal` is in the viewer's axes.
Colour shade(const Colour& colour, const Vec3& normal)
{
    const Vec3 light = Vec3(-0.45, 0.65, 0.6).normalized();
    const Vec3 facing = normal[2] < 0.0 ? Vec3(-normal) : normal;
    const double share = 0.58 + 0.42 * std::max(0.0, light.dot(facing));
    Colour out;
    for (int d = 0; d < 3; ++d) out[d] = static_cast<std::uint8_t>(share * colour[d]);
    return out;
}

void draw_faces(const std::vector<Vec3>& points, const std::vector<Face>& faces, const Colour& front,
                const Colour& back, Raster& raster)
{
    for (const auto& [i, j, k] : faces) {
        const Vec3 &a = points[i], &b = points[j], &c = points[k];
        const Vec3 normal = (b - a).cross(c - a).normalized();
        raster.draw_triangle(a, b, c, shade(normal[2] < 0.0 ? back : front, normal));
    }
}

void draw_obstacle(const ObstacleMesh& mesh, const std::vector<Vec3>& points, Raster& raster)
{
    draw_faces(points, mesh.faces, kObstacle, kObstacle, raster);
    for (const auto& [a, b] : mesh.segments) raster.draw_line(points[a], points[b], 4.0, kLift, kWire);
    for (const int p : mesh.lone_points) raster.draw_line(points[p], points[p], 9.0, kLift, kWire);
}

}  // namespace

std::string draw_scene(const Frame& cloth, const std::vector<ObstacleRecord>& obstacles, double time)
{
    Projection best;
    std::size_t most = 0;
    for (const double azimuth : kAzimuths) {
        Projection seen = project(cloth, obstacles, time, azimuth);
        const std::size_t pixels = count_cloth_pixels(cloth, obstacles, seen);
        if (best.cloth.empty() || pixels > most) best = std::move(seen), most = pixels;
    }
    Raster raster(kWidth, kHeight);
    for (std::size_t i = 0; i < obstacles.size(); ++i)
        draw_obstacle(obstacles[i].mesh, best.obstacles[i], raster);
    draw_faces(best.cloth, cloth.faces, kFront, kBack, raster);
    for (const auto& [a, b] : cloth.eol_edges)
        raster.draw_line(best.cloth[a], best.cloth[b], 2.5, kLift, kEolEdge);
    return raster.to_png();
}

}  // namespace arris
