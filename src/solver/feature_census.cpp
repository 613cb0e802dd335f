// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/feature_census.h"

#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "geometry/feature_path.h"
#include "solver/feature_sites.h"

namespace arris {

namespace {

constexpr double kTouching = 1e-6;  // thicknesses: the contact's point is the closest of the obstacle

bool is_plane_of_face(const Obstacle& obstacle, const ObstacleContact& contact)
{
    constexpr double kSame = 1e-9;  // 1 - cosine: rounding
    const auto& normals = obstacle.topology().face_normals;
    return contact.element >= 0 && contact.element < static_cast<int>(normals.size()) &&
           std::abs(normals[contact.element].dot(contact.normal)) > 1.0 - kSame;
}

class Census {
  public:
    Census(const Scene& scene, const State& state, const Workspace& work)
        : scene_(scene), state_(state), work_(work)
    {
    }

    RowCause find_cause(const Contact& contact) const
    {
        const int entry =
            contact.is_vertex() ? state_.eol_entry(state_.ids[contact.in_frame.vertices[0]]) : -1;
        if (entry >= 0) return of_eol_vertex(entry, contact);
        if (!contact.was_active) return RowCause::New;
        const auto refused = std::find_if(work_.refused.begin(), work_.refused.end(),
                                          [&](const RefusedContact& r) { return is_same(r, contact); });
        if (refused != work_.refused.end()) return refused->cause;
        if (is_loose(contact)) return RowCause::Released;
        return has_eol_end(contact) ? RowCause::BesideEol : RowCause::NotCrossing;
    }

  private:
    /// One that has no coordinates in this step, or that touches something else besides.
    RowCause of_eol_vertex(int entry, const Contact& contact) const
    {
        const ObstacleStep& way = work_.obstacles[state_.eol[entry].obstacle];
        const EolPlacing placing = place_eol_vertex(scene_.obstacles[state_.eol[entry].obstacle], state_,
                                                    entry, work_.stars, way.motion.begin, way.end);
        if (!placing.coordinates) return cause_of(placing.refusal);
        return contact.was_active ? RowCause::OtherFeature : RowCause::New;
    }

    bool is_loose(const Contact& contact) const
    {
        return contact.is_vertex() &&
               std::any_of(state_.loose.begin(), state_.loose.end(), [&](const EolVertex& loose) {
                   return loose.obstacle == contact.obstacle &&
                          loose.vertex_id == state_.ids[contact.in_frame.vertices[0]];
               });
    }

    /// Whether an edge of the cloth ends on the polyline that it touches, or at a corner.
    bool has_eol_end(const Contact& contact) const
    {
        if (contact.in_frame.kind != ContactKind::Edge) return false;
        const ObstacleFeatures& features = scene_.obstacles[contact.obstacle].features();
        const int feature = feature_of_edge(features, contact.in_frame.element);
        if (feature < 0) return false;
        const auto is_on_it = [&](int v) {
            const int entry = v < 0 ? -1 : state_.eol_entry(state_.ids[v]);
            if (entry < 0 || state_.eol[entry].obstacle != contact.obstacle) return false;
            const EolVertex& eol = state_.eol[entry];
            return eol.is_corner || features.edges[eol.feature].polyline == features.edges[feature].polyline;
        };
        const auto& ends = contact.in_frame.vertices;
        return std::any_of(ends.begin(), ends.end(), is_on_it);
    }

    bool is_same(const RefusedContact& refused, const Contact& contact) const
    {
        const ObstacleContact& local = contact.in_frame;
        if (refused.kind != local.kind || refused.obstacle != contact.obstacle) return false;
        if (local.kind != ContactKind::Vertex && refused.element != local.element) return false;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t id =
                local.vertices[i] < 0 ? ActiveContact::kNoVertex : state_.ids[local.vertices[i]];
            if (id != refused.vertex_ids[i]) return false;
        }
        return true;
    }

    const Scene& scene_;
    const State& state_;
    const Workspace& work_;
};

}  // namespace

bool touches_feature(const Obstacle& obstacle, const ObstacleContact& contact, double thickness)
{
    if (contact.kind != ContactKind::Vertex) return true;
    if (is_plane_of_face(obstacle, contact)) return false;
    const double reach = kTouching * thickness;
    const Box3 box(contact.point.array() - reach, contact.point.array() + reach);
    std::vector<int> found;
    obstacle.find_corners(box, found);
    if (!found.empty()) return true;
    obstacle.find_feature_edges(box, found);
    return std::any_of(found.begin(), found.end(), [&](int feature) {
        const auto [a, b] = feature_segment(obstacle, feature);
        const double s = closest_on_segment(contact.point, a, b);
        return (contact.point - a - s * (b - a)).norm() <= reach;
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
        if (!touches_feature(scene.obstacles[contact.obstacle], contact.in_frame, scene.material.thickness))
            continue;
        ++census.rows;
        if (scene.eol) ++census.by_cause[static_cast<std::size_t>(causes.find_cause(contact))];
    }
    return census;
}

}  // namespace arris
