// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

struct MaterialLocation {
    IdFace face;
    Vec3 weights;  ///< of its corners; not negative, sum 1
};

/// The face that holds a material point (exact; one of them where several do), looked for face by face
/// outwards from the vertex `near`, over at most 4096 faces: nothing if none of these holds it. No line of
/// sight is needed, so holes and bays do no harm.
std::optional<MaterialLocation> locate(const ClothSurgery& surgery, const Vec2& material, VertexId near);

/// Barycentric, of a point in a face; clamped to the face where it is outside.
Vec3 clamped_weights(const std::array<Vec2, 3>& corners, const Vec2& point);

}  // namespace arris
