// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <string>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// A cloth for tests of mesh surgery.
struct SurgeryCloth {
    std::string name;
    ClothMesh mesh;
    double cell = 0.0;  ///< m

    ClothSurgery surgery() const;
    std::vector<VertexId> ids() const;
};

/// A unit square of n x n cells, bent into a wave in the world. Inner vertices are moved by up to `jitter`
/// cells.
SurgeryCloth square_cloth(int n, double jitter = 0.0, unsigned seed = 1);
/// A square cloth without the cells [u0, u1) x [v0, v1) in `cut`.
SurgeryCloth square_without(int n, std::array<int, 4> cut, const std::string& name);
SurgeryCloth bay_cloth(int n);     ///< U-shaped
SurgeryCloth holed_cloth(int n);   ///< with a square hole
SurgeryCloth turned_cloth(int n);  ///< turned by 0.3: no border edge is axis-parallel
/// Material X -> scale X + offset.
SurgeryCloth placed(SurgeryCloth cloth, double scale, const Vec2& offset);
/// A square cloth with some inner vertices moved to within 1e-17 to 1e-9 of the opposite edge of a face.
SurgeryCloth sabotaged_cloth(int n, unsigned seed);

/// Properties that surgery must never change, recorded at the start.
class SurgeryCheck {
  public:
    explicit SurgeryCheck(const ClothSurgery& surgery);

    /// Describes the first violation; empty if there is none. The mesh must be valid with positive faces.
    /// Area and border length are kept to 1e-12, corners exactly. Tagged edges join vertices with a role.
    std::string find_wrong(const ClothSurgery& surgery) const;

  private:
    double area_, border_length_;
    std::vector<std::pair<VertexId, Vec2>> fixed_;
};

/// Bitwise equality.
bool is_same(const SurgeryResult& a, const SurgeryResult& b);

/// The vertex nearest to a material point.
VertexId nearest_vertex(const ClothSurgery& surgery, const Vec2& material);

}  // namespace arris
