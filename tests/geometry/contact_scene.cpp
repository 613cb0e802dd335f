// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/contact_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris::samples {
namespace {

using Triangle = std::array<Vec3, 3>;

Triangle triangle_of(const ObstacleMesh& mesh, const Face& f)
{
    return {mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]};
}

Vec3 on_segment(const Vec3& y, const Vec3& a, const Vec3& b)
{
    const double t = std::clamp((b - a).dot(y - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return a + t * (b - a);
}

// Uses the regions of Ericson 2004, "Real-Time Collision Detection", 5.1.5, which differs from the code's
// algorithm.
Vec3 on_triangle(const Vec3& y, const Triangle& t)
{
    std::vector<Vec3> candidates = {on_segment(y, t[0], t[1]), on_segment(y, t[1], t[2]),
                                    on_segment(y, t[2], t[0])};
    const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = y - t[0];
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
    const double den = uu * vv - uv * uv;
    const double b = (vv * uw - uv * vw) / den, c = (uu * vw - uv * uw) / den;
    if (b >= 0.0 && c >= 0.0 && b + c <= 1.0) candidates.push_back(t[0] + b * u + c * v);
    return *std::min_element(candidates.begin(), candidates.end(), [&](const Vec3& p, const Vec3& q) {
        return (p - y).squaredNorm() < (q - y).squaredNorm();
    });
}

}  // namespace

ClothWay::ClothWay(std::vector<Vec3> begin, std::vector<Vec3> end, std::vector<Face> triangles)
    : faces(std::move(triangles))
{
    edges = make_topology(static_cast<int>(begin.size()), faces).edges;
    motion = {&faces, &edges, std::move(begin), std::move(end)};
}

ClothMotion points_way(std::vector<Vec3> begin, std::vector<Vec3> end)
{
    static const std::vector<Face> no_faces;
    static const std::vector<MeshEdge> no_edges;
    return {&no_faces, &no_edges, std::move(begin), std::move(end)};
}

std::vector<Face> grid_faces(int nx, int ny)
{
    std::vector<Face> faces;
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const int a = i + j * (nx + 1), b = a + 1, c = b + nx + 1, d = a + nx + 1;
            faces.push_back({a, b, c});
            faces.push_back({a, c, d});
        }
    }
    return faces;
}

std::vector<Vec3> grid_points(int nx, int ny, const Vec3& origin, const Vec3& u, const Vec3& v)
{
    std::vector<Vec3> points;
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) points.push_back(origin + i * u + j * v);
    return points;
}

std::vector<Vec3> shifted(std::vector<Vec3> points, const Vec3& by)
{
    for (Vec3& p : points) p += by;
    return points;
}

Obstacle make_obstacle(ObstacleMesh mesh, double feature_angle)
{
    return Obstacle(std::move(mesh), feature_angle);
}

Vec3 nearest_point(const ObstacleMesh& mesh, const Vec3& place)
{
    Vec3 nearest = Vec3::Constant(std::numeric_limits<double>::infinity());
    const auto offer = [&](const Vec3& p) {
        if ((p - place).squaredNorm() < (nearest - place).squaredNorm()) nearest = p;
    };
    for (const Face& f : mesh.faces) offer(on_triangle(place, triangle_of(mesh, f)));
    for (const auto& [a, b] : mesh.segments) offer(on_segment(place, mesh.points[a], mesh.points[b]));
    for (const int p : mesh.lone_points) offer(mesh.points[p]);
    return nearest;
}

bool is_local_minimum(const ObstacleMesh& mesh, const Vec3& point, const Vec3& place, double tolerance)
{
    const Vec3 direction = (place - point).normalized();
    const double near = 1e-9 * (mesh.points[0] - point).norm() + 1e-13 * point.norm();
    // The nearest point q of a convex set to y satisfies (y - q) . (p - q) <= 0 for all points p of the set.
    const auto leads_nearer = [&](const Vec3& p) {
        const Vec3 away = p - point;
        return away.norm() > near && direction.dot(away.normalized()) > tolerance;
    };
    for (const Face& f : mesh.faces) {
        const Triangle t = triangle_of(mesh, f);
        if ((on_triangle(point, t) - point).norm() <= near && std::any_of(t.begin(), t.end(), leads_nearer))
            return false;
    }
    for (const auto& [a, b] : mesh.segments)
        if ((on_segment(point, mesh.points[a], mesh.points[b]) - point).norm() <= near &&
            (leads_nearer(mesh.points[a]) || leads_nearer(mesh.points[b])))
            return false;
    return true;
}

bool is_inside(const ObstacleMesh& mesh, const Vec3& place)
{
    const Vec3 ray = Vec3(0.5438121, 0.3219871, 0.7750013).normalized();
    int crossings = 0;
    for (const Face& f : mesh.faces) {
        const Triangle t = triangle_of(mesh, f);
        const Vec3 u = t[1] - t[0], v = t[2] - t[0], h = ray.cross(v);
        const double det = u.dot(h);
        const Vec3 w = place - t[0];
        const double b = w.dot(h) / det, c = ray.dot(w.cross(u)) / det, s = v.dot(w.cross(u)) / det;
        if (b >= 0.0 && c >= 0.0 && b + c <= 1.0 && s > 0.0) ++crossings;
    }
    return crossings % 2 == 1;
}

double gap_of(const ObstacleContact& contact, const std::vector<Vec3>& positions)
{
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        if (contact.vertices[i] >= 0) sum += contact.weights[i] * positions[contact.vertices[i]];
    return contact.normal.dot(sum - contact.point);
}

}  // namespace arris::samples
