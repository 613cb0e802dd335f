// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth/material_box.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/input_error.h"
#include "geometry/rigid_motion.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

std::string describe(const FoldLine& fold)
{
    const auto& [p, q] = fold.line;
    return fmt::format("fold [[{}, {}], [{}, {}]] by {} degrees", p.x(), p.y(), q.x(), q.y(), fold.degrees);
}

// The side of a fold's line on which each vertex is (1 left, 0 on the line, -1 right), and the vertices on
// the line, in order.
struct Sides {
    std::vector<int> side;
    std::vector<int> on_line;
};

Sides sort_by_side(const FoldLine& fold, const ClothMesh& mesh)
{
    const Vec2 along = (fold.line[1] - fold.line[0]).stableNormalized();
    const double tolerance = kComputed * material_size(mesh.material);
    Sides sides;
    sides.side.reserve(mesh.material.size());
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2 from = mesh.material[v] - fold.line[0];
        const double left = along.x() * from.y() - along.y() * from.x();
        sides.side.push_back(left > tolerance ? 1 : left < -tolerance ? -1 : 0);
        if (sides.side.back() == 0) sides.on_line.push_back(v);
    }
    const auto place = [&](int v) { return (mesh.material[v] - fold.line[0]).dot(along); };
    std::sort(sides.on_line.begin(), sides.on_line.end(), [&](int v, int w) { return place(v) < place(w); });
    return sides;
}

void require_line_in_mesh(const FoldLine& fold, const ClothMesh& mesh, const Sides& sides)
{
    if (sides.on_line.size() < 2)
        throw InputError(fmt::format("{}: its line does not run through the cloth", describe(fold)));
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto [least, most] = std::minmax(
            {sides.side[mesh.faces[f][0]], sides.side[mesh.faces[f][1]], sides.side[mesh.faces[f][2]]});
        if (least < 0 && most > 0)
            throw InputError(fmt::format("{}: face {} lies on both sides of its line", describe(fold), f));
    }
}

// The fold line's present place in the world: through `origin`, in the direction in which the line leaves its
// first vertex. The line may run back over itself (folded by 180 degrees), so its farthest vertex gives the
// direction, not its end.
struct Axis {
    Vec3 origin;
    Vec3 direction;
};

Axis axis_of(const ClothMesh& mesh, const Sides& sides)
{
    const Vec3 origin = mesh.world[sides.on_line[0]];
    Vec3 direction = Vec3::Zero();
    for (const int v : sides.on_line)
        if ((mesh.world[v] - origin).norm() > direction.norm()) direction = mesh.world[v] - origin;
    if (direction.dot(mesh.world[sides.on_line[1]] - origin) < 0.0) direction = -direction;
    return {origin, direction.stableNormalized()};
}

// Each face turns or stays as a whole, so the fold is isometric exactly if its line is still straight.
void require_straight(const FoldLine& fold, const ClothMesh& mesh, const Sides& sides, const Axis& axis)
{
    const double tolerance = kTouching * material_size(mesh.material);
    for (const int v : sides.on_line) {
        const double distance = (mesh.world[v] - axis.origin).cross(axis.direction).norm();
        if (!(distance <= tolerance))
            throw InputError(
                fmt::format("{}: an earlier fold bent its line (by {:.3g} m at ({}, {})), so the cloth "
                            "would have to stretch; only folds whose lines are straight are allowed",
                            describe(fold), distance, mesh.material[v].x(), mesh.material[v].y()));
    }
}

void turn_right_side(const FoldLine& fold, const Sides& sides, const Axis& axis, ClothMesh& mesh)
{
    const Mat3 rotation = rotation_about(axis.direction, fold.degrees);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (sides.side[v] < 0) mesh.world[v] = axis.origin + rotation * (mesh.world[v] - axis.origin);
}

}  // namespace

void fold_cloth(const std::vector<FoldLine>& folds, ClothMesh& mesh)
{
    for (const FoldLine& fold : folds) {
        const bool is_finite =
            fold.line[0].allFinite() && fold.line[1].allFinite() && std::isfinite(fold.degrees);
        if (!is_finite || fold.line[0] == fold.line[1])
            throw InputError(
                fmt::format("{}: needs two different, finite points and a finite angle", describe(fold)));
        const Sides sides = sort_by_side(fold, mesh);
        require_line_in_mesh(fold, mesh, sides);
        const Axis axis = axis_of(mesh, sides);
        require_straight(fold, mesh, sides, axis);
        turn_right_side(fold, sides, axis, mesh);
    }
}

}  // namespace arris
