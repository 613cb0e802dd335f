// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/eol_contacts.h"

#include <algorithm>

#include "geometry/contact/contact_plane.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "solver/contact/fold_plane_contacts.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

/// Whether the vertex is on a wire or at its end.
bool is_on_wire(const Obstacle& obstacle, const EolVertex& eol)
{
    if (!eol.on.is_corner()) return obstacle.features().edges[eol.on.index].kind == FeatureKind::Wire;
    const ObstacleTopology& topology = obstacle.topology();
    const int point = fixed_point(obstacle, eol);
    return topology.edge_count_at(point) > 0 && topology.edges[topology.edge_at(point, 0)].faces[0] < 0;
}

/// Whether a contact between the wire and cloth joined to an EOL vertex on it is close beside that vertex.
bool is_beside(const Obstacle& obstacle, const EolVertex& eol, const EolCoordinates& at, const Vec3& place,
               double thickness, const Contact& contact)
{
    constexpr double kReach = 10.0;  // heights: cloth leaving at 6 degrees is a stand-off away
    const ObstacleFeatures& features = obstacle.features();
    const Vec3 from = place - at.frame.point, along = at.frame.tangent.dot(from) * at.frame.tangent;
    const double height = std::max((from - along).norm(), thickness);
    if ((contact.local_point - at.frame.point).norm() > kReach * height) return false;
    const int corner = fixed_point(obstacle, eol);
    const auto is_of_wire = [&](int edge) {
        const auto& ends = obstacle.topology().edges[edge].points;
        if (eol.on.is_corner()) return ends[0] == corner || ends[1] == corner;
        const int feature = feature_of_edge(features, edge);
        return feature >= 0 && features.edges[feature].polyline == features.edges[eol.on.index].polyline;
    };
    if (contact.kind == ContactKind::Edge) return is_of_wire(contact.element);
    if (eol.on.is_corner()) return contact.element == corner;
    const ObstacleTopology& topology = obstacle.topology();
    // The fold of a vertex past the wire's end passes over that end.
    if (is_corner(features, contact.element) && !is_past_end(obstacle, eol.on.index, place)) return false;
    return topology.edge_count_at(contact.element) > 0 && is_of_wire(topology.edge_at(contact.element, 0));
}

/// Whether a point of the obstacle is within kOnFeature thicknesses of an EOL vertex's feature. Any place
/// along the feature counts, as the vertex may slide there by the step's end.
bool is_near_feature(const Obstacle& obstacle, const EolVertex& eol, const EolCoordinates& at,
                     double thickness, const Vec3& point)
{
    const Vec3 nearest =
        eol.on.is_corner()
            ? at.frame.point
            : place_on_feature(obstacle, follow_polyline(obstacle, eol.on.index, point).feature, point).point;
    return (point - nearest).norm() <= kOnFeature * thickness;
}

/// Whether the bound of an EOL vertex covers a contact that the search found with its feature.
bool is_covered(const Obstacle& obstacle, const EolVertex& eol, const EolCoordinates& at, const Vec3& place,
                double thickness, const Contact& contact)
{
    const ObstacleFeatures& features = obstacle.features();
    const int corner = fixed_point(obstacle, eol);
    if (contact.kind != ContactKind::Vertex && is_on_wire(obstacle, eol))
        return is_beside(obstacle, eol, at, place, thickness, contact);
    if (contact.kind == ContactKind::Triangle) return contact.element == corner;
    if (contact.kind == ContactKind::Vertex)
        return contact.local_normal.dot(at.frame.outward) > 0.0 &&
               is_near_feature(obstacle, eol, at, thickness, contact.local_point);
    const ObstacleEdge& edge = obstacle.topology().edges[contact.element];
    if (!eol.on.is_corner()) return contact.element == features.edges[eol.on.index].edge;
    return edge.points[0] == corner || edge.points[1] == corner;
}

/// Keeps the sides of cloth folded over a wire apart.
void append_fold_planes(const Scene& scene, const State& state, const ClothStars& stars,
                        const Prediction& prediction, const Carriers& carriers,
                        const std::vector<EolCoordinates>& eol, std::vector<Contact>& contacts)
{
    std::vector<const std::vector<Vec3>*> positions;
    for (const Carrier& carrier : carriers.obstacles) positions.push_back(&carrier.motion.begin);
    for (const FoldPlaneContact& fold :
         find_fold_plane_contacts(scene.obstacles, state, stars, eol, positions)) {
        const ObstacleContact contact =
            make_contact(ContactKind::Vertex, {{fold.vertex, -1, -1}, {1.0, 0.0, 0.0}}, kFoldPlaneElement,
                         fold.bound.normal, fold.point, fold.bound.least_gap);
        contacts.push_back(place_contact(contact, fold.obstacle, fold.bound.wanted, carriers, prediction));
    }
}

/// Whether an EOL vertex is past the end of its wire, with another one between them. The end supports the
/// cloth at the first vertex past it; farther out nothing does.
bool is_unsupported(const Carriers& carriers, const State& state, const ClothStars& stars,
                    const EolCoordinates& at)
{
    const EolVertex& eol = state.eol[at.entry];
    const Obstacle& obstacle = *carriers[eol.on.obstacle].obstacle;
    const std::vector<Vec3>& positions = carriers[eol.on.obstacle].motion.begin;
    const auto length_of = [&](const EolVertex& e, int v) {
        return e.on.is_corner() ? 0.0 : length_past_end(obstacle, e.on.index, positions[v]);
    };
    const double length = length_of(eol, at.vertex);
    if (!(length > 0.0)) return false;
    bool has_nearer = false;
    for (const int f : stars.faces[at.vertex])
        for (const int w : state.mesh.faces[f]) {
            const int entry = state.eol_entry(state.ids[w]);
            if (w == at.vertex || entry < 0 ||
                !is_trace_edge(obstacle, {eol, positions[at.vertex]}, {state.eol[entry], positions[w]}))
                continue;
            const double other = length_of(state.eol[entry], w);
            if (!(other > 0.0) && !state.eol[entry].on.is_corner()) return false;
            has_nearer = has_nearer || other < length;
        }
    return has_nearer;
}

Contact make_eol_contact(const Carriers& carriers, const Prediction& prediction, double thickness,
                         int obstacle, const EolCoordinates& at)
{
    const ClothPoint point = {{at.vertex, -1, -1}, {1.0, 0.0, 0.0}};
    // Never more than the current gap. With a larger one a vertex on its way out would be held to its speed,
    // and, with its history flattened, pushed out faster in each step.
    const double now = at.frame.outward.dot(carriers[obstacle].motion.begin[at.vertex] - at.frame.point);
    const double stand_off = at.frame.mitre * thickness;
    const ObstacleContact contact = make_contact(ContactKind::Vertex, point, -1, at.frame.outward,
                                                 at.frame.point, std::min(stand_off, now));
    return place_contact(contact, obstacle, stand_off, carriers, prediction);
}

}  // namespace

std::vector<EolCoordinates> add_eol_contacts(const Scene& scene, const State& state, const ClothStars& stars,
                                             const Prediction& prediction, double turning,
                                             const Carriers& carriers, std::vector<Contact>& contacts)
{
    const double thickness = scene.materials.thickness();
    std::vector<EolCoordinates> eol;
    std::vector<int> slot(state.mesh.world.size(), -1);
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry) {
        const int o = state.eol[entry].on.obstacle;
        const EolPlacing placing = place_eol_vertex(*carriers[o].obstacle, thickness, state, entry, stars,
                                                    carriers[o].motion.begin, carriers[o].end, turning);
        if (!placing.coordinates) continue;
        slot[placing.coordinates->vertex] = static_cast<int>(eol.size());
        eol.push_back(*placing.coordinates);
    }
    // A cloth edge between two EOL vertices on one wire is the trace itself: a constraint there would be
    // almost singular.
    const auto is_trace = [&](const Contact& contact) {
        const int a = contact.vertices[0], b = contact.vertices[1];
        if (contact.kind != ContactKind::Edge || slot[a] < 0 || slot[b] < 0) return false;
        const int o = contact.obstacle;
        const EolVertex &p = state.eol[eol[slot[a]].entry], &q = state.eol[eol[slot[b]].entry];
        return p.on.obstacle == o && !p.on.is_corner() && !q.on.is_corner() &&
               is_on_wire(*carriers[o].obstacle, p) &&
               feature_of_edge(carriers[o].obstacle->features(), contact.element) >= 0 &&
               is_trace_edge(*carriers[o].obstacle, {p, carriers[o].motion.begin[a]},
                             {q, carriers[o].motion.begin[b]});
    };
    std::erase_if(contacts, [&](const Contact& contact) {
        if (is_trace(contact)) return true;
        const int o = contact.obstacle;
        for (const int v : contact.vertices) {
            if (v < 0 || slot[v] < 0) continue;
            const EolVertex& vertex = state.eol[eol[slot[v]].entry];
            if (vertex.on.obstacle == o && is_covered(*carriers[o].obstacle, vertex, eol[slot[v]],
                                                      carriers[o].motion.begin[v], thickness, contact))
                return true;
        }
        return false;
    });
    const std::size_t found = contacts.size();
    for (std::size_t e = 0; e < eol.size(); ++e) {
        const int o = state.eol[eol[e].entry].on.obstacle;
        if (is_unsupported(carriers, state, stars, eol[e])) continue;
        contacts.push_back(make_eol_contact(carriers, prediction, thickness, o, eol[e]));
        contacts.back().eol = static_cast<int>(e);
        contacts.back().may_grow = false;  // a push-out would stretch the cloth on both sides
    }
    // With self-contact the sides of a fold stop each other.
    if (!scene.self_contact) append_fold_planes(scene, state, stars, prediction, carriers, eol, contacts);
    for (std::size_t c = found; c < contacts.size(); ++c) recall(state, carriers, contacts[c]);
    return eol;
}

}  // namespace arris
