// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/trace_mesh.h"

#include <algorithm>
#include <limits>

#include "geometry/obstacle/feature_path.h"
#include "solver/model/eol_limits.h"
#include "solver/model/target_length.h"

namespace arris {

FeatureTags::FeatureTags(const std::vector<MovingObstacle>& obstacles) : obstacles_(obstacles)
{
    for (const MovingObstacle& obstacle : obstacles) {
        first_.push_back(count_);
        const ObstacleFeatures& features = obstacle.shape().features();
        count_ += static_cast<int>(features.polylines.size() + features.corners.size());
    }
}

int FeatureTags::tag(const FeatureId& on) const
{
    const ObstacleFeatures& features = obstacles_[on.obstacle].shape().features();
    return first_[on.obstacle] + (on.is_corner() ? static_cast<int>(features.polylines.size()) + on.index
                                                 : features.edges[on.index].polyline);
}

TraceMesh::TraceMesh(const Scene& scene, const State& state, const ClothStars& stars,
                     const std::vector<VertexId>& pinned)
    : obstacles_(scene.obstacles),
      target_(surgery_target(scene, state)),
      state_(state),
      tags_(scene.obstacles),
      surgery_(state.mesh.has_seams()
                   ? ClothSurgery(state.mesh, state.ids, state.next_id, pinned, state.seam_ids)
                   : ClothSurgery(state.mesh, state.ids, state.next_id, pinned, stars.topology.edges)),
      eol_(state.eol)
{
    for (const EolVertex& e : eol_) {
        surgery_.set_role(e.vertex_id, e.on.is_fixed() ? TraceRole::Node : TraceRole::OnTrace, tags_.tag(e));
        for (const VertexId point : surgery_.points_at(e.vertex_id))
            flow_[point] = state.material_velocity[state.point_with(point)];
    }
    for (const auto& [a, b] : find_trace_edges(obstacles_, state, stars)) {
        const EolVertex &p = eol_[a], &q = eol_[b];
        if (const auto edge = surgery_.edge_between(p.vertex_id, q.vertex_id))
            surgery_.set_edge_tag((*edge)[0], (*edge)[1], tags_.tag(p.on.is_corner() ? q : p));
    }
    surgery_.take_touched();
}

std::vector<EolVertex>::const_iterator TraceMesh::place_of(VertexId v) const
{
    return std::lower_bound(eol_.begin(), eol_.end(), v,
                            [](const EolVertex& e, VertexId id) { return e.vertex_id < id; });
}

const EolVertex* TraceMesh::find(VertexId v) const
{
    const auto at = place_of(v);
    return at != eol_.end() && at->vertex_id == v ? &*at : nullptr;
}

bool TraceMesh::is_on_trace(VertexId v) const
{
    return surgery_.has_vertex(v) && surgery_.role(v) != TraceRole::Free;
}

void TraceMesh::set_flow(VertexId point, const Vec2& flow)
{
    for (const VertexId other : surgery_.points_at(point))
        flow_[other] = surgery_.turn_over(point, other) * flow;
}

void TraceMesh::add(const EolVertex& made, VertexId point, const Vec2& flow)
{
    eol_.insert(place_of(made.vertex_id), made);
    if (!flow_.contains(point)) set_flow(point, flow);
}

double TraceMesh::distance(const EolVertex& eol, const Vec2& material) const
{
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId point : surgery_.points_at(eol.vertex_id))
        least = std::min(least, (surgery_.material(point) - material).norm());
    return least;
}

EolVertex& TraceMesh::entry_of(VertexId v)
{
    return eol_[static_cast<std::size_t>(place_of(v) - eol_.begin())];
}

void TraceMesh::slide(VertexId v, int feature)
{
    entry_of(v).on.index = feature;
}

void TraceMesh::lock(VertexId v, const FeatureId& bend)
{
    surgery_.set_role(v, TraceRole::Node, surgery_.tag(v));
    EolVertex& locked = entry_of(v);
    locked.on = bend;
    locked.idle = 0;
}

void TraceMesh::forget_released()
{
    std::erase_if(eol_, [this](const EolVertex& e) { return !is_on_trace(e.vertex_id); });
    std::erase_if(flow_, [this](const auto& of) { return !is_on_trace(of.first); });
}

ObstaclePose TraceMesh::pose_of(const EolVertex& eol) const
{
    return obstacles_[eol.on.obstacle].at(state_.time);
}

PlacedEol TraceMesh::placed(const EolVertex& eol) const
{
    return {eol, pose_of(eol).placement.inverse(surgery_.world(eol.vertex_id))};
}

std::vector<PlacedEol> TraceMesh::placed() const
{
    std::vector<PlacedEol> on_trace;
    for (const EolVertex& e : eol_)
        if (is_on_trace(e.vertex_id)) on_trace.push_back(placed(e));
    return on_trace;
}

std::optional<EolVertex> TraceMesh::like_neighbour(VertexId v, int tag) const
{
    for (const VertexId w : surgery_.ring(v).vertices) {
        const EolVertex* known = find(surgery_.vertex_of(w));
        if (!known || known->on.is_corner() || tags_.tag(*known) != tag) continue;
        EolVertex made = *known;
        made.vertex_id = v;
        made.idle = 0;
        const std::int32_t o = known->on.obstacle;
        made.on =
            FeatureId::edge(o, follow_polyline(pose_of(*known), known->on.index, placed(made).place).feature);
        return made;
    }
    return std::nullopt;
}

int TraceMesh::side_beside(int tag, const Vec2& material) const
{
    double least = kLongEdge * target_.length(material);
    int side = 0;
    for (const EolVertex& e : eol_) {
        if (e.side == 0 || !is_on_trace(e.vertex_id) || tags_.tag(e) != tag) continue;
        const double away = distance(e, material);
        if (away < least) side = e.side;
        least = std::min(least, away);
    }
    return side;
}

VertexId TraceMesh::nearest_to(const Vec2& material) const
{
    VertexId nearest = kNoVertex;
    double least = 0.0;
    for (std::size_t v = 0; v < state_.ids.size(); ++v) {
        if (!surgery_.has_vertex(state_.ids[v])) continue;
        const double distance = (state_.mesh.material[v] - material).squaredNorm();
        if (nearest != kNoVertex && distance >= least) continue;
        nearest = state_.ids[v];
        least = distance;
    }
    return nearest;
}

}  // namespace arris
