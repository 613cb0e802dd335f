// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_contact/self_sweep.h"

#include <tuple>

#include "geometry/contact/contact_plane.h"
#include "geometry/contact/continuous_collision.h"
#include "geometry/self_contact/self_contact_search.h"
#include "geometry/sort_unique.h"
#include "geometry/tolerances.h"

namespace arris {

namespace {

/// A pair of elements that met. `first` and `second` are a vertex and a face, or two edges.
struct Meeting {
    int first, second;
    ClothPointPair pair;
    ClothSweepHit hit;
};

struct Sweep {
    const SelfSurface& surface;
    const SelfMotion& motion;
    double distance;
    const MayMeet& may_meet;

    void vertex_face(int v, int face, std::vector<Meeting>& met) const
    {
        if (may_meet && may_meet(SelfContactKind::VertexFace, v, face)) return;
        const std::array<int, 4> vertices = vertex_and_face(surface, v, face);
        if (const auto hit = sweep_cloth_vertex_face(corners(motion.begin, vertices),
                                                     corners(motion.end, vertices), distance))
            met.push_back({v, face, {SelfContactKind::VertexFace, vertices, hit->weights}, *hit});
    }

    void edge_edge(int first, int second, std::vector<Meeting>& met) const
    {
        if (may_meet && may_meet(SelfContactKind::EdgeEdge, first, second)) return;
        const std::array<int, 4> vertices = two_edges(surface, first, second);
        if (const auto hit =
                sweep_cloth_edges(corners(motion.begin, vertices), corners(motion.end, vertices), distance))
            met.push_back({first, second, {SelfContactKind::EdgeEdge, vertices, hit->weights}, *hit});
    }
};

/// The plane that a meeting violates. Where the pair began behind the plane, as cloth that slid past an edge
/// did, it is to keep only the least gap with a direction.
SelfContact make_violation(const Meeting& meeting, const std::vector<Vec3>& begin, double thickness)
{
    SelfContact contact = make_self_contact(meeting.pair, meeting.hit.normal, begin, thickness);
    if (!(contact.least_gap > 0.0)) contact.least_gap = kTinyDistance * thickness;
    return contact;
}

}  // namespace

SelfSweepReport check_self_sweep(const SelfSurface& surface, const SelfMotion& motion, double thickness,
                                 const MayMeet& may_meet)
{
    SelfSweepReport report;
    Box3 bounds;
    for (std::size_t v = 0; v < motion.begin.size(); ++v) bounds.extend(motion.box(static_cast<int>(v)));
    const double distance = kTouching * bounds.diagonal().norm();
    if (!(distance > 0.0)) return report;
    std::vector<Meeting> met = collect_near_pairs<Meeting>(surface, motion, 2.0 * distance,
                                                           Sweep{surface, motion, distance, may_meet});
    // A vertex reports only the first face it meets; the others lie behind that face.
    std::sort(met.begin(), met.end(), [](const Meeting& a, const Meeting& b) {
        return std::tie(a.pair.kind, a.first, a.hit.time, a.second) <
               std::tie(b.pair.kind, b.first, b.hit.time, b.second);
    });
    for (std::size_t m = 0; m < met.size(); ++m) {
        const Meeting& meeting = met[m];
        const bool is_vertex = meeting.pair.kind == SelfContactKind::VertexFace;
        const bool is_first =
            m == 0 || met[m - 1].first != meeting.first || met[m - 1].pair.kind != meeting.pair.kind;
        report.crossings += is_first;
        if (is_vertex) {
            report.faces.push_back(meeting.second);
            const auto around = surface.faces_at[meeting.first];
            report.faces.insert(report.faces.end(), around.begin(), around.end());
        } else {
            for (const int e : {meeting.first, meeting.second})
                for (const int f : {surface.edges[e].face_left, surface.edges[e].face_right})
                    if (f >= 0) report.faces.push_back(f);
        }
        if ((is_first || !is_vertex) && !meeting.hit.normal.isZero(0.0))
            report.violations.push_back(make_violation(
                meeting, motion.begin,
                kept_distance(surface, meeting.pair.vertices, meeting.pair.first_count(), thickness)));
    }
    sort_unique(report.faces);
    return report;
}

}  // namespace arris
