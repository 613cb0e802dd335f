// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/sample_obstacles.h"

#include <cmath>
#include <numbers>

namespace arris::samples {

ObstacleMesh prism(const std::vector<Vec2>& polygon, const std::vector<double>& levels,
                   const std::vector<Face>& cap)
{
    const int n = static_cast<int>(polygon.size());
    const int top = n * (static_cast<int>(levels.size()) - 1);
    ObstacleMesh mesh;
    for (const double z : levels)
        for (const Vec2& p : polygon) mesh.points.emplace_back(p.x(), p.y(), z);
    for (int low = 0; low < top; low += n)
        for (int i = 0; i < n; ++i) {
            const int j = (i + 1) % n;
            mesh.faces.push_back({low + i, low + j, low + n + j});
            mesh.faces.push_back({low + i, low + n + j, low + n + i});
        }
    std::vector<Face> triangles = cap;
    if (triangles.empty())
        for (int i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
    for (const auto& [a, b, c] : triangles) {
        mesh.faces.push_back({a, c, b});
        mesh.faces.push_back({top + a, top + b, top + c});
    }
    return mesh;
}

ObstacleMesh box(const Vec3& low, const Vec3& high)
{
    return prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}},
                 {low.z(), high.z()});
}

namespace {

std::vector<Vec2> circle(int n)
{
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        points.emplace_back(std::cos(angle), std::sin(angle));
    }
    return points;
}

}  // namespace

ObstacleMesh cylinder(int sides)
{
    return prism(circle(sides), {0.0, 1.0});
}

ObstacleMesh l_prism()
{
    return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {0, 1, 2, 3},
                 {{3, 4, 5}, {3, 5, 0}, {3, 0, 1}, {3, 1, 2}});
}

ObstacleMesh cone(int sides, double radius)
{
    ObstacleMesh mesh;
    for (const Vec2& p : circle(sides)) mesh.points.emplace_back(radius * p.x(), radius * p.y(), 0.0);
    mesh.points.emplace_back(0, 0, 1);
    for (int i = 0; i < sides; ++i) mesh.faces.push_back({i, (i + 1) % sides, sides});
    for (int i = 1; i + 1 < sides; ++i) mesh.faces.push_back({0, i + 1, i});
    return mesh;
}

ObstacleMesh teeth(int count)
{
    // The profile along x starts at z = 0 with valley, tip, valley, ...; it returns along the slab's under
    // side.
    std::vector<Vec2> polygon;
    for (int i = 0; i <= count; ++i) polygon.emplace_back(2.0 * i, -1.0);
    for (int i = count; i >= 0; --i) {
        polygon.emplace_back(2.0 * i, 0.0);
        if (i > 0) polygon.emplace_back(2.0 * i - 1.0, 1.0);
    }
    std::vector<Face> cap;
    const auto valley = [count](int i) { return count + 1 + 2 * (count - i); };
    for (int i = 0; i < count; ++i) {
        cap.push_back({i, i + 1, valley(i + 1)});
        cap.push_back({i, valley(i + 1), valley(i)});
        cap.push_back({valley(i), valley(i + 1), valley(i + 1) + 1});
    }
    // The prism's z becomes -y, so that ridges point up.
    return moved(prism(polygon, {0.0, 3.0}, cap), [](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); });
}

ObstacleMesh sphere(int rings, int meridians)
{
    ObstacleMesh mesh;
    mesh.points.emplace_back(0, 0, -1);
    for (int i = 1; i < rings; ++i) {
        const double latitude = std::numbers::pi * (static_cast<double>(i) / rings - 0.5);
        for (const Vec2& p : circle(meridians))
            mesh.points.emplace_back(std::cos(latitude) * p.x(), std::cos(latitude) * p.y(),
                                     std::sin(latitude));
    }
    mesh.points.emplace_back(0, 0, 1);
    const int north = static_cast<int>(mesh.points.size()) - 1;
    for (int j = 0; j < meridians; ++j) {
        const int k = (j + 1) % meridians;
        mesh.faces.push_back({0, 1 + k, 1 + j});
        mesh.faces.push_back({north, north - meridians + j, north - meridians + k});
        for (int low = 1; low + 2 * meridians <= north; low += meridians) {
            mesh.faces.push_back({low + j, low + k, low + meridians + k});
            mesh.faces.push_back({low + j, low + meridians + k, low + meridians + j});
        }
    }
    return mesh;
}

ObstacleMesh sheet(int nx, int ny, const std::function<double(int, int)>& height)
{
    ObstacleMesh mesh;
    for (int i = 0; i <= nx; ++i)
        for (int j = 0; j <= ny; ++j) mesh.points.emplace_back(i, j, height(i, j));
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) {
            const int a = i * (ny + 1) + j, b = a + ny + 1;
            mesh.faces.push_back({a, b, b + 1});
            mesh.faces.push_back({a, b + 1, a + 1});
        }
    return mesh;
}

ObstacleMesh wire(const std::vector<Vec3>& points, bool is_closed)
{
    ObstacleMesh mesh;
    mesh.points = points;
    const int n = static_cast<int>(points.size());
    for (int i = 0; i + 1 < n; ++i) mesh.segments.push_back({i, i + 1});
    if (is_closed) mesh.segments.push_back({n - 1, 0});
    return mesh;
}

ObstacleMesh nails(const std::vector<Vec3>& points)
{
    ObstacleMesh mesh;
    mesh.points = points;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) mesh.lone_points.push_back(i);
    return mesh;
}

ObstacleMesh together(const ObstacleMesh& first, const ObstacleMesh& second)
{
    ObstacleMesh mesh = first;
    const int n = static_cast<int>(first.points.size());
    mesh.points.insert(mesh.points.end(), second.points.begin(), second.points.end());
    for (const auto& [a, b, c] : second.faces) mesh.faces.push_back({a + n, b + n, c + n});
    for (const auto& [a, b] : second.segments) mesh.segments.push_back({a + n, b + n});
    for (const int p : second.lone_points) mesh.lone_points.push_back(p + n);
    return mesh;
}

ObstacleMesh inside_out(ObstacleMesh mesh)
{
    for (Face& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

ObstacleMesh moved(ObstacleMesh mesh, const std::function<Vec3(const Vec3&)>& map)
{
    for (Vec3& p : mesh.points) p = map(p);
    return mesh;
}

}  // namespace arris::samples
