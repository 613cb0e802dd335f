// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cloth that hangs over a wire passes on both its sides through the wire's line:
//
//            v            A vertex of it that is on the wire is one thickness away from it, and both faces
//           /|\           beside hang straight down: they touch the wire beside v. On which side of the wire
//          / o \          the cloth is there, the vertex remembers, and the bound on its way out keeps.
//
// So what is joined to v is not checked against that wire beside v, as far as it is straight. Everywhere else
// it is: a wire that got into a face there would have to leave it through an edge farther from v, or through
// a face that v is not a corner of, and these are.
#pragma once

#include <array>
#include <vector>

#include "geometry/feature_path.h"
#include "geometry/obstacle_contact.h"
#include "geometry/obstacle_touch.h"

namespace arris {

/// What of the obstacle's wires the cloth around held vertices may touch.
class HeldFeatures {
  public:
    HeldFeatures(const Obstacle& obstacle, const ClothMotion& motion, double thickness);

    bool is_any() const { return !held_.empty(); }

    /// Parts of wires that the cloth's edge a-b, or its face, is not checked against.
    std::vector<FeatureStretch> beside_edge(int a, int b) const;
    std::vector<FeatureStretch> beside_face(const Face& face) const;

    /// Whether a node of a wire is in such a part.
    bool is_beside_point(const std::vector<FeatureStretch>& beside, int point) const;

    /// Drops from what a face of the cloth touches at its end what it may: what is beside its held vertices,
    /// and what of their wire it touched at begin. That got there beside them, and goes as it came.
    void let_touch(const Face& face, const std::array<Vec3, 3>& begin, const std::array<Vec3, 3>& end,
                   ObstacleTouch& touch) const;

  private:
    /// A vertex of the cloth, and where on the feature it is.
    struct Held {
        int vertex;
        FeaturePlace place, end;  ///< at begin and end
        double reach, end_reach;  ///< on the way, and at its end
        bool is_far;  ///< begins or ends farther from it than a stand-off: mesh surgery brings it there
    };
    const Held* find(int vertex) const;
    double way_between(const Held& a, const Held& b) const;
    /// By at least `least` (m) more than the reach.
    std::vector<FeatureStretch> beside(const Face& face, double least, bool is_end) const;
    void append(const Held& held, double further, bool is_end, std::vector<FeatureStretch>& stretches) const;

    const Obstacle& obstacle_;
    double thickness_;
    std::vector<Held> held_;  ///< ascending by vertex
};

/// Whether cloth faces keep more than `distance` (m) from the wire that a vertex of them is on;
/// true too where it is on something else. `hold.vertex` is not used.
bool is_clear(const Obstacle& obstacle, const FeatureHold& hold, const Vec3& place,
              const std::vector<std::array<Vec3, 3>>& faces, double distance);

/// Whether stretches cover a point on edge `edge` of the topology.
bool is_covered(const Obstacle& obstacle, const std::vector<FeatureStretch>& stretches, int edge,
                const Vec3& point);

}  // namespace arris
