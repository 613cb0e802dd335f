// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/untangle/tangled_cloth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/closest_point.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris::samples {

namespace {

constexpr double kCell = 0.02;  // m

StartObstacle to_untangle(ObstacleMesh mesh)
{
    return {{std::make_shared<Obstacle>(std::move(mesh), 30.0), Placement{}}, StartRule::Untangle};
}

std::function<Vec3(const Vec2&)> level(double x, double y, double z)
{
    return [=](const Vec2& X) { return Vec3(X.x() + x, X.y() + y, z); };
}

Vec3 on_tube(const Vec2& X, double radius)
{
    const double angle = X.x() / radius;
    return {radius * std::cos(angle), radius * std::sin(angle), X.y()};
}

}  // namespace

void TangledCloth::add(const Vec2& size, const std::function<Vec3(const Vec2&)>& place, GridPattern pattern)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = {static_cast<int>(std::lround(size.x() / kCell)),
                       static_cast<int>(std::lround(size.y() / kCell))};
    grid.pattern = pattern;
    const ClothMesh sheet = make_cloth_grid(grid);
    const int first = mesh.vertex_count();
    first_face.push_back(mesh.face_count());
    for (const Vec2& X : sheet.material) {
        mesh.material.push_back(X + Vec2(static_cast<double>(first_face.size()), 0.0));
        mesh.world.push_back(place(X));
    }
    for (const auto& [a, b, c] : sheet.faces) mesh.faces.push_back({a + first, b + first, c + first});
}

std::vector<Face> TangledCloth::piece(int index) const
{
    const auto at = static_cast<std::size_t>(index);
    const int end = at + 1 < first_face.size() ? first_face[at + 1] : mesh.face_count();
    return {mesh.faces.begin() + first_face[at], mesh.faces.begin() + end};
}

TangledCloth corner_through_sheet()
{
    TangledCloth cloth;
    cloth.add({0.3, 0.3},
              [](const Vec2& X) { return Vec3(X.x(), X.y(), 0.4 * std::max(0.0, X.x() + X.y() - 0.5)); });
    cloth.add({0.4, 0.4}, level(-0.013, -0.017, 0.0305));
    return cloth;
}

TangledCloth fold_through_sheet()
{
    TangledCloth cloth;
    cloth.add({0.2, 0.4}, [](const Vec2& X) {
        constexpr double kSlope = 75.0 * std::numbers::pi / 180.0;
        const double from_crest = X.y() - 0.2;
        return Vec3(X.x(), from_crest * std::cos(kSlope), -std::abs(from_crest) * std::sin(kSlope));
    });
    cloth.add({0.4, 0.4}, level(-0.113, -0.207, -0.0103));
    return cloth;
}

TangledCloth tube_into_tube()
{
    TangledCloth cloth;
    cloth.add({0.6, 0.4}, [](const Vec2& X) { return on_tube(X, 0.1); });
    cloth.add({0.3, 0.2}, [](const Vec2& X) {
        const Vec3 p = on_tube(X, 0.05);
        return Vec3(-0.09 - p.z(), p.x(), p.y() + 0.2);
    });
    return cloth;
}

TangledCloth crossed_borders()
{
    TangledCloth cloth;
    const auto tilted = [](double degrees, double shift) {
        const double angle = degrees * std::numbers::pi / 180.0;
        return [=](const Vec2& X) {
            const double across = X.y() - 0.103;
            return Vec3(X.x() + shift, std::cos(angle) * across, std::sin(angle) * across);
        };
    };
    cloth.add({0.2, 0.2}, tilted(30.0, -0.173));
    cloth.add({0.2, 0.2}, tilted(-30.0, -0.031));
    return cloth;
}

TangledCloth strip_through_sheet()
{
    TangledCloth cloth;
    cloth.add({0.04, 0.2}, [](const Vec2& X) { return Vec3(0.001, X.x() - 0.017, X.y() - 0.17); });
    cloth.add({0.4, 0.4}, level(-0.209, -0.203, 0.0005));
    return cloth;
}

TangledCloth coplanar_sliver()
{
    TangledCloth cloth;
    cloth.add({0.3, 0.3}, level(0.0, 0.0, 0.0));
    cloth.add({0.3, 0.3}, level(0.294, 0.05, 0.0));
    return cloth;
}

TangledCloth dipped_sheet(double top, double depth)
{
    TangledCloth cloth;
    cloth.add({0.4, 0.4}, level(-0.203, -0.197, top - depth));
    return cloth;
}

StartObstacle ball_of_15_cm()
{
    return to_untangle(moved(sphere(24, 36), [](const Vec3& p) { return Vec3(0.15 * p); }));
}

StartObstacle cube_of_20_cm()
{
    return to_untangle(box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}));
}

UntangleRequest self_request(std::vector<int> held)
{
    return {StartRule::Untangle, {}, std::move(held), kTangleThickness};
}

namespace {

double vertex_gap(const std::vector<Vec3>& x, const Face& vertices, const Face& face)
{
    const Vec3 &a = x[face[0]], &b = x[face[1]], &c = x[face[2]];
    const Vec3 normal = (b - a).cross(c - a).stableNormalized();
    double least = std::numeric_limits<double>::infinity();
    for (const int v : vertices)
        least = std::min(least, (x[v] - closest_on_triangle(x[v], {a, b, c}, normal).point).norm());
    return least;
}

double edge_gap(const std::vector<Vec3>& x, const Face& first, const Face& second)
{
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const SegmentPair pair = closest_between_segments({x[first[i]], x[first[(i + 1) % 3]]},
                                                              {x[second[j]], x[second[(j + 1) % 3]]});
            least = std::min(least, (pair.first - pair.second).norm());
        }
    return least;
}

}  // namespace

double least_gap(const std::vector<Vec3>& positions, const std::vector<Face>& first,
                 const std::vector<Face>& second)
{
    const auto box_of = [&](const Face& face) {
        Eigen::AlignedBox3d box;
        for (const int v : face) box.extend(positions[v]);
        return box;
    };
    double least = std::numeric_limits<double>::infinity();
    for (const Face& f : first)
        for (const Face& g : second)
            if (box_of(f).exteriorDistance(box_of(g)) < least)
                least = std::min({least, vertex_gap(positions, f, g), vertex_gap(positions, g, f),
                                  edge_gap(positions, f, g)});
    return least;
}

}  // namespace arris::samples
