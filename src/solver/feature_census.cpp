// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/feature_census.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/closest_point.h"
#include "geometry/cloth/mesh_limits.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/tolerances.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

constexpr double kAtEnd = 1.0 - kSplitFromEnd;  // weight of an edge's end

bool is_plane_of_face(const Obstacle& obstacle, const Contact& contact)
{
    const auto& normals = obstacle.topology().face_normals;
    return contact.element >= 0 && contact.element < static_cast<int>(normals.size()) &&
           std::abs(normals[contact.element].dot(contact.local_normal)) > 1.0 - kAccumulated;
}

class Census {
  public:
    Census(const Scene& scene, const State& state, const Workspace& work)
        : scene_(scene), state_(state), work_(work)
    {
    }

    ConstraintCause find_cause(const Contact& contact) const
    {
        const int entry = contact.is_vertex() ? state_.eol_entry(state_.ids[contact.vertices[0]]) : -1;
        if (entry >= 0) return of_eol_vertex(entry, contact);
        if (!contact.was_active()) return ConstraintCause::New;
        const Beside beside = find_beside(contact);
        if (beside.is_at) return beside.refusal ? *beside.refusal : ConstraintCause::AtEol;
        const auto refused = std::find_if(work_.mesh.refused.begin(), work_.mesh.refused.end(),
                                          [&](const RefusedContact& r) { return is_same(r, contact); });
        if (refused != work_.mesh.refused.end()) return refused->cause;
        return beside.is_any ? ConstraintCause::BesideEol : ConstraintCause::NotCrossing;
    }

  private:
    /// Cause for a contact of an EOL vertex: the vertex has no coordinates in this step, or the contact is
    /// with another feature or obstacle.
    ConstraintCause of_eol_vertex(int entry, const Contact& contact) const
    {
        if (const std::optional<ConstraintCause> refusal = find_refusal(entry)) return *refusal;
        if (!contact.was_active()) return ConstraintCause::New;
        return contact.obstacle == state_.eol[entry].on.obstacle ? ConstraintCause::OtherFeature
                                                                 : ConstraintCause::OtherObstacle;
    }

    /// EOL vertices beside a contact, on the feature that the contact touches.
    struct Beside {
        bool is_any = false;
        bool is_at = false;                      ///< the contact is at one of them, or between two
        std::optional<ConstraintCause> refusal;  ///< why that vertex has no coordinates in this step, if so
    };

    Beside find_beside(const Contact& contact) const
    {
        Beside beside;
        for (int entry = 0; entry < static_cast<int>(state_.eol.size()); ++entry) {
            if (!is_of(contact, state_.eol[entry])) continue;
            beside.is_any = true;
            if (!is_at(contact, state_.index_of(state_.eol[entry].vertex_id))) continue;
            beside.is_at = true;
            beside.refusal = find_refusal(entry);
            if (!beside.refusal) return beside;
        }
        return is_on_trace(contact) ? Beside{true, true, {}} : beside;
    }

    /// Whether an EOL vertex is on the feature that a contact touches. For a cloth edge: the vertex is an end
    /// of that edge, on the feature's polyline or a corner of it. For a cloth face: the vertex is on the
    /// corner touched.
    bool is_of(const Contact& contact, const EolVertex& eol) const
    {
        if (eol.on.obstacle != contact.obstacle) return false;
        const Obstacle& obstacle = scene_.obstacles[contact.obstacle].shape();
        const ObstacleFeatures& features = obstacle.features();
        if (contact.kind == ContactKind::Triangle) return fixed_point(obstacle, eol) == contact.element;
        if (contact.kind != ContactKind::Edge) return false;
        const int v = state_.index_of(eol.vertex_id);
        const int feature = feature_of_edge(features, contact.element);
        if (feature < 0 || (contact.vertices[0] != v && contact.vertices[1] != v)) return false;
        return is_along(eol, feature);
    }

    /// Whether an EOL vertex is on the polyline of a feature edge of its obstacle, or at an end of it.
    bool is_along(const EolVertex& eol, int feature) const
    {
        const ObstaclePose obstacle = scene_.obstacles[eol.on.obstacle].at(state_.time);
        const auto& edges = obstacle->features().edges;
        if (!eol.on.is_corner()) return edges[eol.on.index].polyline == edges[feature].polyline;
        const double anywhere = std::numeric_limits<double>::infinity();
        return distance_to_corner(obstacle, {feature, 0.5}, eol.on.index, anywhere).has_value();
    }

    /// Whether a contact belongs to an edge of the trace. Either the contact's cloth edge is a trace edge. Or
    /// its cloth face has a trace edge and touches a vertex of the obstacle's mesh there, within a convex
    /// edge. On a rim that bends, a chord of the cloth passes by such vertices.
    bool is_on_trace(const Contact& contact) const
    {
        const auto has_eol = [&](int v, int feature) {
            const int entry = state_.eol_entry(state_.ids[v]);
            return entry >= 0 && state_.eol[entry].on.obstacle == contact.obstacle &&
                   is_along(state_.eol[entry], feature) && !find_refusal(entry);
        };
        const auto is_trace = [&](int feature, int a, int b) {
            return feature >= 0 && has_eol(contact.vertices[a], feature) &&
                   has_eol(contact.vertices[b], feature);
        };
        const ObstaclePose obstacle = scene_.obstacles[contact.obstacle].at(state_.time);
        const ObstacleFeatures& features = obstacle->features();
        if (contact.kind == ContactKind::Edge)
            return is_trace(feature_of_edge(features, contact.element), 0, 1);
        if (contact.kind != ContactKind::Triangle || is_corner(features, contact.element)) return false;
        const ObstacleTopology& topology = obstacle->topology();
        for (int k = 0; k < topology.edge_count_at(contact.element); ++k) {
            const int feature = feature_of_edge(features, topology.edge_at(contact.element, k));
            if (feature < 0 || features.edges[feature].kind != FeatureKind::Convex) continue;
            for (int i = 0; i < 3; ++i)
                if ((contact.weights[i] < 1.0 - kAtEnd || is_near(contact, (i + 1) % 3, (i + 2) % 3)) &&
                    is_trace(feature, (i + 1) % 3, (i + 2) % 3))
                    return true;
        }
        return false;
    }

    /// Whether the touched point is within kOnFeature thicknesses of the edge between corners i and j of the
    /// face.
    bool is_near(const Contact& contact, int i, int j) const
    {
        const std::vector<Vec3>& begin = work_.carriers[contact.obstacle].motion.begin;
        const Vec3 &a = begin[contact.vertices[i]], &b = begin[contact.vertices[j]];
        const double s = closest_on_segment(contact.local_point, a, b);
        return (contact.local_point - a - s * (b - a)).norm() <= kOnFeature * scene_.materials.thickness();
    }

    /// Whether a contact lies at that vertex of the cloth, by the rule in constraint_cause.h.
    bool is_at(const Contact& contact, int vertex) const
    {
        for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i)
            if (contact.kind == ContactKind::Edge && contact.vertices[i] == vertex &&
                contact.weights[i] > kAtEnd)
                return true;
        const Vec2 material =
            blend_material(state_.mesh, work_.mesh.stars, contact.vertices, contact.weights);
        const int point = find_point_beside(state_.mesh, work_.mesh.stars, vertex, material);
        return (material - state_.mesh.material[point]).norm() <= kOnFeature * scene_.materials.thickness();
    }

    std::optional<ConstraintCause> find_refusal(int entry) const
    {
        const EolVertex& eol = state_.eol[entry];
        const Carrier& way = work_.carriers[eol.on.obstacle];
        const EolPlacing placing = place_eol_vertex(*way.obstacle, scene_.materials.thickness(), state_,
                                                    entry, work_.mesh.stars, way.motion.begin, way.end);
        return placing.coordinates ? std::nullopt : std::optional(placing.refusal);
    }

    bool is_same(const RefusedContact& refused, const Contact& contact) const
    {
        if (refused.kind != contact.kind || refused.obstacle != contact.obstacle) return false;
        if (contact.kind != ContactKind::Vertex && refused.element != contact.element) return false;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t id =
                contact.vertices[i] < 0 ? ContactVertexIds::kNoVertex : state_.ids[contact.vertices[i]];
            if (id != refused.vertex_ids[i]) return false;
        }
        return true;
    }

    const Scene& scene_;
    const State& state_;
    const Workspace& work_;
};

}  // namespace

bool touches_feature(const Obstacle& obstacle, const Contact& contact, double thickness)
{
    if (contact.kind == ContactKind::Vertex && is_plane_of_face(obstacle, contact)) return false;
    if (contact.kind == ContactKind::Edge && feature_of_edge(obstacle.features(), contact.element) >= 0)
        return true;
    const double reach = kOnSurface * thickness;
    const Box3 box(contact.local_point.array() - reach, contact.local_point.array() + reach);
    std::vector<int> found;
    obstacle.find_corners(box, found);
    if (!found.empty()) return true;
    obstacle.find_feature_edges(box, found);
    return std::any_of(found.begin(), found.end(), [&](int feature) {
        const auto [a, b] = feature_segment(obstacle, feature);
        const double s = closest_on_segment(contact.local_point, a, b);
        return (contact.local_point - a - s * (b - a)).norm() <= reach;
    });
}

FeatureCensus take_census(const Scene& scene, const State& state, const Workspace& work,
                          const std::vector<double>& multiplier)
{
    FeatureCensus census;
    const Census causes(scene, state, work);
    for (std::size_t c = 0; c < work.contacts.size(); ++c) {
        const Contact& contact = work.contacts[c];
        if (!(multiplier[c] > 0.0)) continue;
        if (contact.eol >= 0) {
            ++census.eol;
            continue;
        }
        if (contact.is_with_itself() || contact.is_fold_plane() ||
            !touches_feature(*work.carriers[contact.obstacle].obstacle, contact, scene.materials.thickness()))
            continue;
        ++census.rows;
        if (scene.eol) ++census.by_cause[static_cast<std::size_t>(causes.find_cause(contact))];
    }
    return census;
}

}  // namespace arris
