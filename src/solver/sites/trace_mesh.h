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

/// Tags of the surgery: one a polyline and one a corner of each obstacle.
class FeatureTags {
  public:
    explicit FeatureTags(const std::vector<Obstacle>& obstacles);

    int tag(const FeatureId& on) const;
    int tag(const EolVertex& vertex) const { return tag(vertex.on); }

  private:
    const std::vector<Obstacle>& obstacles_;
    std::vector<int> first_;
    int count_ = 0;
};

/// A state's cloth under surgery, which of its vertices are EOL, and how material flows over them. Of what
/// surgery takes off its trace the entry stays until `forget_released`.
class TraceMesh {
  public:
    /// With the state's own EOL vertices, and edges between them, on the trace. `pinned` are no free ones.
    TraceMesh(const Scene& scene, const State& state, const ClothStars& stars,
              const std::vector<VertexId>& pinned);

    ClothSurgery& surgery() { return surgery_; }
    const ClothSurgery& surgery() const { return surgery_; }
    const FeatureTags& tags() const { return tags_; }

    const std::vector<EolVertex>& eol() const { return eol_; }  ///< ascending by vertex_id
    const EolVertex* find(VertexId v) const;                    ///< nullptr where it has no entry
    bool is_on_trace(VertexId v) const;
    const Vec2& flow(VertexId v) const { return flow_.at(v); }  ///< m/s; of one with an entry
    void set_flow(VertexId v, const Vec2& flow) { flow_[v] = flow; }

    /// A new entry; a flow that is known stays.
    void add(const EolVertex& made, const Vec2& flow);
    void forget_released();
    /// Fixes a vertex that slides along its wire at this bend of the wire.
    void lock(VertexId v, const FeatureId& bend);

    /// One that slides along its polyline is on that edge of it now.
    void slide(VertexId v, int feature);

    /// In the obstacle's frame, where the surgery has it.
    PlacedEol placed(const EolVertex& eol) const;
    /// Of those on the trace.
    std::vector<PlacedEol> placed() const;
    /// A vertex on the trace with that tag but without an entry, which clean-up or a join has put there, is
    /// like its neighbour along it. Nothing where there is none.
    std::optional<EolVertex> like_neighbour(VertexId v, int tag) const;
    /// On which side of the cloth (EolVertex::side) a wire is beside X: that of the nearest vertex of its
    /// trace which knows it, as none gets through the cloth; 0 where there is none near.
    int side_beside(int tag, const Vec2& material) const;
    /// The state's vertex nearest to X among those that are left.
    VertexId nearest_to(const Vec2& material) const;

  private:
    std::vector<EolVertex>::const_iterator place_of(VertexId v) const;
    EolVertex& entry_of(VertexId v);

    const std::vector<Obstacle>& obstacles_;
    const MeshTarget& target_;
    const State& state_;
    FeatureTags tags_;
    ClothSurgery surgery_;
    std::vector<EolVertex> eol_;
    std::map<VertexId, Vec2> flow_;  ///< of those in `eol_`
};

}  // namespace arris
