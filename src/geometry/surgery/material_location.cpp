// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/material_location.h"

#include <algorithm>
#include <set>

#include "geometry/cgal.h"
#include "geometry/from_least.h"

namespace arris {
namespace {

constexpr std::size_t kMostFaces = 4096;

bool contains(const std::array<Vec2, 3>& X, const Vec2& point)
{
    for (int k = 0; k < 3; ++k)
        if (exact_orientation(X[k], X[(k + 1) % 3], point) < 0) return false;
    return true;
}

}  // namespace

Vec3 clamped_weights(const std::array<Vec2, 3>& corners, const Vec2& point)
{
    Vec3 weights;
    for (int k = 0; k < 3; ++k)
        weights[k] = std::max(0.0, twice_area(corners[(k + 1) % 3], corners[(k + 2) % 3], point));
    return weights / weights.sum();
}

std::optional<FaceLocation> locate(const ClothSurgery& surgery, const Vec2& material, VertexId near)
{
    if (!material.allFinite() || !surgery.has_vertex(near)) return {};
    std::vector<IdFace> faces;
    std::set<IdFace> seen;
    const auto add = [&](const IdFace& face) {
        if (seen.insert(from_least(face)).second) faces.push_back(face);
    };
    for (const VertexId point : surgery.points_at(near))
        for (const IdFace& face : surgery.faces_at(point)) add(face);
    for (std::size_t next = 0; next < faces.size() && next < kMostFaces; ++next) {
        const IdFace face = faces[next];
        const PatchFace patch = surgery.patch_face(face);
        if (contains(patch.material, material))
            return FaceLocation{face, clamped_weights(patch.material, material)};
        for (int k = 0; k < 3; ++k) {
            std::array<VertexId, 2> beyond = {face[(k + 1) % 3], face[k]};
            if (const auto other_side = surgery.partner(beyond[0], beyond[1])) beyond = *other_side;
            const VertexId apex = surgery.apex(beyond[0], beyond[1]);
            if (apex != kNoVertex) add({beyond[0], beyond[1], apex});
        }
    }
    return {};
}

}  // namespace arris
