// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// A material point in a face of a mesh under surgery.
struct FaceLocation {
    IdFace face;
    Vec3 weights;  ///< barycentric; not negative, sum 1
};

/// Finds a face that holds a material point (exact). The search goes from face to face, and over seams,
/// outwards from the vertex `near`, over at most 4096 faces. Returns nothing if none of these holds the
/// point. The search does not follow a straight line, so holes and concave borders do no harm.
std::optional<FaceLocation> locate(const ClothSurgery& surgery, const Vec2& material, VertexId near);

/// Barycentric coordinates of a point in a face; negative ones become 0, and the sum is scaled to 1.
Vec3 clamped_weights(const std::array<Vec2, 3>& corners, const Vec2& point);

}  // namespace arris
