// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/eol/eol_features.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Tags of the surgery: one for each polyline and corner of each obstacle.
class FeatureTags {
  public:
    explicit FeatureTags(const std::vector<MovingObstacle>& obstacles);

    int tag(const FeatureId& on) const;
    int tag(const EolVertex& vertex) const { return tag(vertex.on); }

  private:
    const std::vector<MovingObstacle>& obstacles_;
    std::vector<int> first_;
    int count_ = 0;
};

/// A state's cloth under surgery, its EOL vertices and the flow of material through them. The entry of a
/// vertex that surgery takes off its trace stays until `forget_released`.
class TraceMesh {
  public:
    /// Starts with the state's EOL vertices, and the edges between them, on the trace. `pinned` vertices are
    /// not free.
    TraceMesh(const Scene& scene, const State& state, const ClothStars& stars,
              const std::vector<VertexId>& pinned);

    ClothSurgery& surgery() { return surgery_; }
    const ClothSurgery& surgery() const { return surgery_; }
    const FeatureTags& tags() const { return tags_; }
    const MeshTarget& target() const { return target_; }

    const std::vector<EolVertex>& eol() const { return eol_; }  ///< ascending by vertex_id
    const EolVertex* find(VertexId v) const;                    ///< nullptr without an entry
    bool is_on_trace(VertexId v) const;
    const Vec2& flow(VertexId point) const
    {
        return flow_.at(point);
    }  ///< m/s; its vertex must have an entry
    /// Sets the flow through a vertex from that at one of its points.
    void set_flow(VertexId point, const Vec2& flow);

    /// Adds an entry, with the flow at one of its points; a known flow stays.
    void add(const EolVertex& made, VertexId point, const Vec2& flow);
    /// Distance of X from a vertex in the material, m, on the vertex's side of a seam.
    double distance(const EolVertex& eol, const Vec2& material) const;
    void forget_released();
    /// Fixes a vertex that slides along its wire at this bend of the wire.
    void lock(VertexId v, const FeatureId& bend);

    /// Reassigns a sliding vertex to edge `feature` of its polyline.
    void slide(VertexId v, int feature);

    double time() const { return state_.time; }        ///< s
    ObstaclePose pose_of(const EolVertex& eol) const;  ///< its obstacle at the state's time
    /// The vertex's current place in the obstacle's frame.
    PlacedEol placed(const EolVertex& eol) const;
    /// All vertices on the trace.
    std::vector<PlacedEol> placed() const;
    /// Entry for a vertex on the trace with that tag that clean-up or a join has made: a copy of its
    /// neighbour's entry along the trace. Nothing without such a neighbour.
    std::optional<EolVertex> like_neighbour(VertexId v, int tag) const;
    /// Side of the cloth (EolVertex::side) of a wire beside X: that of the nearest vertex of its trace with a
    /// known side, as the wire cannot pass through the cloth. 0 without such a vertex nearby.
    int side_beside(int tag, const Vec2& material) const;
    /// The nearest to X of the state's vertices that still exist.
    VertexId nearest_to(const Vec2& material) const;

  private:
    std::vector<EolVertex>::const_iterator place_of(VertexId v) const;
    EolVertex& entry_of(VertexId v);

    const std::vector<MovingObstacle>& obstacles_;
    MeshTarget target_;
    const State& state_;
    FeatureTags tags_;
    ClothSurgery surgery_;
    std::vector<EolVertex> eol_;
    std::map<VertexId, Vec2> flow_;  ///< by point of the vertices in `eol_`
};

}  // namespace arris
