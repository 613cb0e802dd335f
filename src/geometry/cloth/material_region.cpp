// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/closest_point.h"
#include "geometry/cloth/mesh_pieces.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

Vec3 in_plane(const Vec2& X)
{
    return {X.x(), X.y(), 0.0};
}

double distance_to(const std::array<Vec2, 3>& simplex, const Vec2& X)
{
    const auto& [a, b, c] = simplex;
    const bool has_area = twice_area(simplex) > 0.0;
    return (closest_on_triangle(in_plane(X), {in_plane(a), in_plane(b), in_plane(c)},
                                has_area ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::Zero()))
                .point -
            in_plane(X))
        .norm();
}

double distance_to(const MaterialBox& box, const Vec2& X)
{
    return (X - X.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

double least_u(const std::array<Vec2, 3>& simplex)
{
    return std::min({simplex[0].x(), simplex[1].x(), simplex[2].x()});
}

double greatest_u(const std::array<Vec2, 3>& simplex)
{
    return std::max({simplex[0].x(), simplex[1].x(), simplex[2].x()});
}

/// Collects points and simplices by the material points of their corners.
struct Picked {
    std::vector<std::array<int, 3>> corners;  ///< points; an edge or a vertex has its last one several times
    std::vector<char> is_used;                ///< of each point: whether a simplex has it

    void add(const std::array<int, 3>& points)
    {
        corners.push_back(points);
        for (const int p : points) is_used[static_cast<std::size_t>(p)] = 1;
    }
};

Picked pick(const ClothMesh& mesh, const std::vector<int>& vertices)
{
    std::vector<char> is_picked(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const int v : vertices) is_picked[static_cast<std::size_t>(v)] = 1;
    const auto has = [&](int point) {
        return is_picked[static_cast<std::size_t>(mesh.vertex_of(point))] != 0;
    };
    Picked picked{{}, std::vector<char>(mesh.material.size(), 0)};
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto& [a, b, c] = mesh.points_of(f);
        if (has(a) && has(b) && has(c)) {
            picked.add({a, b, c});
            continue;
        }
        for (const auto& [from, to] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
            if (has(from) && has(to)) picked.add({from, to, to});
    }
    for (int p = 0; p < static_cast<int>(mesh.material.size()); ++p)
        if (has(p) && !picked.is_used[static_cast<std::size_t>(p)]) picked.add({p, p, p});
    return picked;
}

/// Boxes around the simplices that share points.
std::vector<MaterialBox> connected_boxes(const ClothMesh& mesh, const Picked& picked)
{
    const std::vector<int> label = label_pieces(static_cast<int>(mesh.material.size()), picked.corners);
    std::map<int, MaterialBox> boxes;
    for (const std::array<int, 3>& corners : picked.corners)
        for (const int p : corners) {
            const Vec2& X = mesh.material[static_cast<std::size_t>(p)];
            MaterialBox& box =
                boxes.try_emplace(label[static_cast<std::size_t>(p)], MaterialBox{X, X}).first->second;
            box.min = box.min.cwiseMin(X);
            box.max = box.max.cwiseMax(X);
        }
    std::vector<MaterialBox> result;
    for (const auto& [piece, box] : boxes) result.push_back(box);
    return result;
}

}  // namespace

MaterialRegion MaterialRegion::between(const ClothMesh& mesh, const std::vector<int>& vertices)
{
    const Picked picked = pick(mesh, vertices);
    MaterialRegion region;
    region.parts_ = connected_boxes(mesh, picked);
    for (const auto& [a, b, c] : picked.corners)
        region.simplices_.push_back({mesh.material[a], mesh.material[b], mesh.material[c]});
    region.sort_simplices();
    return region;
}

MaterialRegion MaterialRegion::along(const std::vector<std::array<Vec2, 2>>& lines)
{
    MaterialRegion region;
    region.parts_.clear();
    for (const auto& [a, b] : lines) {
        region.parts_.push_back({a.cwiseMin(b), a.cwiseMax(b)});
        region.simplices_.push_back({a, b, b});
    }
    region.sort_simplices();
    return region;
}

void MaterialRegion::sort_simplices()
{
    std::sort(simplices_.begin(), simplices_.end(),
              [](const Simplex& s, const Simplex& t) { return least_u(s) < least_u(t); });
    for (const Simplex& simplex : simplices_)
        widest_ = std::max(widest_, greatest_u(simplex) - least_u(simplex));
}

bool MaterialRegion::contains(const Vec2& X, double tolerance) const
{
    if (simplices_.empty())
        return std::any_of(parts_.begin(), parts_.end(),
                           [&](const MaterialBox& part) { return part.contains(X, tolerance); });
    const auto first =
        std::lower_bound(simplices_.begin(), simplices_.end(), X.x() - widest_ - tolerance,
                         [](const Simplex& simplex, double u) { return least_u(simplex) < u; });
    for (auto simplex = first; simplex != simplices_.end(); ++simplex) {
        if (least_u(*simplex) > X.x() + tolerance) return false;
        if (distance_to(*simplex, X) <= tolerance) return true;
    }
    return false;
}

double MaterialRegion::distance(const Vec2& X) const
{
    double least = std::numeric_limits<double>::infinity();
    if (simplices_.empty())
        for (const MaterialBox& part : parts_) least = std::min(least, distance_to(part, X));
    for (const Simplex& simplex : simplices_) least = std::min(least, distance_to(simplex, X));
    return least;
}

std::vector<int> vertices_inside(const ClothMesh& mesh, const MaterialRegion& region)
{
    const double tolerance = kMaterialTolerance * material_size(mesh.material);
    std::vector<int> vertices;
    for (int p = 0; p < static_cast<int>(mesh.material.size()); ++p)
        if (region.contains(mesh.material[static_cast<std::size_t>(p)], tolerance))
            vertices.push_back(mesh.vertex_of(p));
    sort_unique(vertices);
    return vertices;
}

}  // namespace arris
