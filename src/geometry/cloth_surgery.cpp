// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every change has the same three parts: the faces it replaces and those in their place are written down
// (propose), each new face's orientation is checked by exact predicate, and only then the half-edges change
// (commit). A patch whose outline stays and whose new faces all turn counter-clockwise is again a
// triangulation of the same part of the plane, so nothing else needs checking there.
#include "geometry/cloth_surgery.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "geometry/cgal.h"
#include "geometry/material_location.h"
#include "geometry/surgery_mesh.h"

namespace arris {
namespace {

// A point computed on a line between two others is off it by rounding: a few units in the last place of the
// greatest coordinate.
constexpr double kOnLineUlps = 16.0;

bool is_on_line(const Vec2& a, const Vec2& b, const Vec2& p)
{
    const double scale =
        std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), p.cwiseAbs().maxCoeff()});
    const double slack = kOnLineUlps * std::numeric_limits<double>::epsilon() * scale;
    return std::abs(twice_area(a, b, p)) <= slack * (b - a).norm();
}

bool is_between(const Vec2& a, const Vec2& b, const Vec2& p)
{
    return is_on_line(a, b, p) && (p - a).dot(b - a) > 0.0 && (p - b).dot(a - b) > 0.0;
}

bool is_counter_clockwise(const PatchFace& face)
{
    const auto& X = face.material;
    return X[0].allFinite() && X[1].allFinite() && X[2].allFinite() &&
           exact_orientation(X[0], X[1], X[2]) > 0;
}

bool has(const IdFace& face, VertexId v)
{
    return std::find(face.begin(), face.end(), v) != face.end();
}

IdFace replaced(IdFace face, VertexId v, VertexId by)
{
    std::replace(face.begin(), face.end(), v, by);
    return face;
}

}  // namespace

class ClothSurgery::Implementation {
  public:
    Implementation(const ClothMesh& cloth, const std::vector<VertexId>& ids, VertexId first_free_id)
        : mesh(cloth, ids), next_id(first_free_id)
    {
    }

    // --- parts of proposals

    PatchFace patch_face(const IdFace& face) const
    {
        PatchFace patch{face, {}, {}};
        for (int k = 0; k < 3; ++k) {
            patch.material[k] = mesh.material(face[k]);
            patch.world[k] = mesh.world(face[k]);
        }
        return patch;
    }

    // As `patch_face`, with the event's new and moved vertices at their new places.
    PatchFace changed_face(const SurgeryEvent& event, const IdFace& face) const
    {
        PatchFace patch{face, {}, {}};
        for (int k = 0; k < 3; ++k) {
            const auto change = std::find_if(event.changes.begin(), event.changes.end(),
                                             [&](const VertexChange& c) { return c.vertex == face[k]; });
            const bool is_changed = change != event.changes.end();
            patch.material[k] = is_changed ? change->new_material : mesh.material(face[k]);
            patch.world[k] = is_changed ? change->new_world : mesh.world(face[k]);
        }
        return patch;
    }

    void add_after(SurgeryEvent& event, const IdFace& face) const
    {
        event.after.push_back(changed_face(event, face));
    }

    static void check_orientation(SurgeryProposal& proposal)
    {
        if (!std::all_of(proposal.event.after.begin(), proposal.event.after.end(), is_counter_clockwise))
            proposal.verdict = Verdict::Orientation;
    }

    VertexChange change_at(const IdFace& parents, const Vec3& weights) const
    {
        // From the first parent: a point between two of equal coordinate has it exactly.
        VertexChange change{
            next_id, mesh.material(parents[0]), Vec2::Zero(), mesh.world(parents[0]), Vec3::Zero(), parents,
            weights};
        change.new_material = change.old_material;
        change.new_world = change.old_world;
        for (int k = 1; k < 3; ++k) {
            change.new_material += weights[k] * (mesh.material(parents[k]) - mesh.material(parents[0]));
            change.new_world += weights[k] * (mesh.world(parents[k]) - mesh.world(parents[0]));
        }
        change.old_material = change.new_material;
        change.old_world = change.new_world;
        return change;
    }

    std::vector<IdFace> faces_at(VertexId v) const
    {
        const VertexRing ring = mesh.ring(v);
        const std::size_t n = ring.vertices.size();
        std::vector<IdFace> faces;
        for (std::size_t k = 0; k + (ring.is_closed ? 0 : 1) < n; ++k)
            faces.push_back({v, ring.vertices[k], ring.vertices[(k + 1) % n]});
        return faces;
    }

    VertexId apex(VertexId a, VertexId b) const
    {
        const auto h = mesh.halfedge(a, b);
        if (h == SurgeryMesh::Mesh::null_halfedge() || !mesh.has_face(h)) return kNoVertex;
        return mesh.apex(h);
    }

    bool has_edge(VertexId a, VertexId b) const
    {
        return mesh.halfedge(a, b) != SurgeryMesh::Mesh::null_halfedge();
    }

    bool is_border_edge(VertexId a, VertexId b) const { return mesh.is_border_edge(mesh.halfedge(a, b)); }

    bool is_corner(VertexId v) const
    {
        const VertexRing ring = mesh.ring(v);
        return !ring.is_closed && !is_between(mesh.material(ring.vertices.front()),
                                              mesh.material(ring.vertices.back()), mesh.material(v));
    }

    // --- whether a collapse is allowed, but for orientation

    Verdict check_trace_collapse(VertexId v, VertexId w) const
    {
        if (mesh.role(v) == TraceRole::Node) return Verdict::Fixed;
        if (mesh.role(v) == TraceRole::Free) return Verdict::Done;
        const std::vector<VertexId> along = mesh.trace_neighbours(v);
        if (along.size() != 2 || (along[0] != w && along[1] != w)) return Verdict::Trace;
        const VertexId other = along[0] == w ? along[1] : along[0];
        if (mesh.edge_tag(mesh.halfedge(v, w)) != mesh.edge_tag(mesh.halfedge(v, other)))
            return Verdict::Trace;
        // The two edges become one, which must not be on a trace yet.
        const bool is_loop = has_edge(w, other) && mesh.edge_tag(mesh.halfedge(w, other)) != kNoTag;
        return is_loop ? Verdict::Trace : Verdict::Done;
    }

    Verdict check_border_collapse(VertexId v, VertexId w, const VertexRing& ring) const
    {
        if (ring.is_closed) return Verdict::Done;
        const VertexId first = ring.vertices.front();
        const VertexId last = ring.vertices.back();
        if (w != first && w != last) return Verdict::Border;
        return is_between(mesh.material(first), mesh.material(last), mesh.material(v)) ? Verdict::Done
                                                                                       : Verdict::Border;
    }

    // Common neighbours other than the apexes of v-w would be joined to w twice.
    Verdict check_link(VertexId v, VertexId w, const VertexRing& ring) const
    {
        const VertexId left = apex(v, w);
        const VertexId right = apex(w, v);
        for (const VertexId n : ring.vertices)
            if (n != left && n != right && n != w && has_edge(n, w)) return Verdict::Topology;
        return Verdict::Done;
    }

    // --- moves

    // Where the surface, as it is, has a material point; the nearest place in the vertex's faces where none
    // does (by rounding on a slanted border).
    VertexChange interpolated(const ClothSurgery& surgery, VertexId v, const Vec2& material) const
    {
        MaterialLocation best;
        if (const auto found = locate(surgery, material, v)) {
            best = *found;
        } else {
            double least_error = std::numeric_limits<double>::infinity();
            for (const IdFace& face : faces_at(v)) {
                const auto X = patch_face(face).material;
                const Vec3 weights = clamped_weights(X, material);
                const double error =
                    (weights[0] * X[0] + weights[1] * X[1] + weights[2] * X[2] - material).norm();
                if (!(error < least_error)) continue;
                least_error = error;
                best = {face, weights};
            }
        }
        VertexChange change = change_at(best.face, best.weights);
        change.vertex = v;
        change.old_material = mesh.material(v);
        change.old_world = mesh.world(v);
        change.new_material = material;
        return change;
    }

    // Border vertices must come to lie between their border neighbours, where these come to lie: from corner
    // to corner that leaves only the line they are on.
    bool keeps_border(const SurgeryEvent& event, VertexId v) const
    {
        const VertexRing ring = mesh.ring(v);
        if (ring.is_closed) return true;
        const PatchFace places = changed_face(event, {ring.vertices.front(), v, ring.vertices.back()});
        return is_between(places.material[0], places.material[2], places.material[1]);
    }

    void apply(const SurgeryEvent& event)
    {
        const auto [a, b] = event.edge;
        switch (event.operation) {
            case SurgeryOperation::SplitEdge:
                mesh.split_edge(a, b, event.changes[0]);
                break;
            case SurgeryOperation::SplitFace:
                mesh.split_face(event.before[0].vertices, event.changes[0]);
                break;
            case SurgeryOperation::Move:
                for (const VertexChange& c : event.changes) mesh.move(c.vertex, c.new_material, c.new_world);
                break;
            case SurgeryOperation::Collapse:
                mesh.collapse(a, b);
                break;
            case SurgeryOperation::Flip:
                mesh.flip(a, b);
                break;
        }
        const bool is_split =
            event.operation == SurgeryOperation::SplitEdge || event.operation == SurgeryOperation::SplitFace;
        if (!is_split) return;
        assert(event.changes[0].vertex == next_id && "the mesh changed since the proposal was made");
        ++next_id;
        mesh.set_role(event.changes[0].vertex, event.role, event.tag);
    }

    SurgeryMesh mesh;
    VertexId next_id;
    SurgeryGuard guard;
    std::vector<SurgeryEvent> events;
    std::set<VertexId> touched;
};

ClothSurgery::ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                           const std::vector<VertexId>& fixed)
    : implementation_(std::make_unique<Implementation>(mesh, ids, next_id))
{
    assert(ids.size() == mesh.world.size() && "one id a vertex");
    assert(std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end());
    assert((ids.empty() || ids.back() < next_id) && "ids must be below the next");
    SurgeryMesh& inner = implementation_->mesh;
    for (const VertexId v : ids)
        if (implementation_->is_corner(v)) inner.fix(v);
    for (const VertexId v : fixed) inner.fix(v);
}

ClothSurgery::~ClothSurgery() = default;
ClothSurgery::ClothSurgery(ClothSurgery&& other) noexcept = default;
ClothSurgery& ClothSurgery::operator=(ClothSurgery&& other) noexcept = default;

void ClothSurgery::set_guard(SurgeryGuard guard)
{
    implementation_->guard = std::move(guard);
}

// --- queries

int ClothSurgery::vertex_count() const
{
    return implementation_->mesh.vertex_count();
}

bool ClothSurgery::has_vertex(VertexId v) const
{
    return implementation_->mesh.has(v);
}

bool ClothSurgery::has_edge(VertexId a, VertexId b) const
{
    return implementation_->has_edge(a, b);
}

VertexId ClothSurgery::apex(VertexId a, VertexId b) const
{
    return implementation_->apex(a, b);
}

bool ClothSurgery::is_border(VertexId v) const
{
    return !implementation_->mesh.ring(v).is_closed;
}

bool ClothSurgery::is_border_edge(VertexId a, VertexId b) const
{
    return has_edge(a, b) && implementation_->is_border_edge(a, b);
}

bool ClothSurgery::is_fixed(VertexId v) const
{
    return implementation_->mesh.is_fixed(v);
}

Vec2 ClothSurgery::material(VertexId v) const
{
    return implementation_->mesh.material(v);
}

Vec3 ClothSurgery::world(VertexId v) const
{
    return implementation_->mesh.world(v);
}

TraceRole ClothSurgery::role(VertexId v) const
{
    return implementation_->mesh.role(v);
}

int ClothSurgery::tag(VertexId v) const
{
    return implementation_->mesh.tag(v);
}

int ClothSurgery::edge_tag(VertexId a, VertexId b) const
{
    const SurgeryMesh& mesh = implementation_->mesh;
    return has_edge(a, b) ? mesh.edge_tag(mesh.halfedge(a, b)) : kNoTag;
}

VertexRing ClothSurgery::ring(VertexId v) const
{
    return implementation_->mesh.ring(v);
}

std::vector<IdFace> ClothSurgery::faces_at(VertexId v) const
{
    return implementation_->faces_at(v);
}

PatchFace ClothSurgery::patch_face(const IdFace& face) const
{
    return implementation_->patch_face(face);
}

// --- what is not geometry

void ClothSurgery::set_world(VertexId v, const Vec3& position)
{
    implementation_->mesh.world(v) = position;
}

void ClothSurgery::set_role(VertexId v, TraceRole role, int tag)
{
    implementation_->mesh.set_role(v, role, tag);
}

void ClothSurgery::set_edge_tag(VertexId a, VertexId b, int tag)
{
    SurgeryMesh& mesh = implementation_->mesh;
    assert((tag == kNoTag || (role(a) != TraceRole::Free && role(b) != TraceRole::Free)) &&
           "a trace's vertices have a role");
    mesh.set_edge_tag(mesh.halfedge(a, b), tag);
}

void ClothSurgery::release_edge(VertexId a, VertexId b)
{
    SurgeryMesh& mesh = implementation_->mesh;
    mesh.set_edge_tag(mesh.halfedge(a, b), kNoTag);
    for (const VertexId v : {a, b}) {
        touch(v);
        if (role(v) == TraceRole::OnTrace && mesh.trace_neighbours(v).empty())
            mesh.set_role(v, TraceRole::Free, kNoTag);
    }
}

void ClothSurgery::release_vertex(VertexId v)
{
    for (const VertexId n : implementation_->mesh.trace_neighbours(v)) release_edge(v, n);
    set_role(v, TraceRole::Free, kNoTag);
    touch(v);
}

// --- proposals

SurgeryProposal ClothSurgery::propose_edge_split(VertexId a, VertexId b, double s, TraceRole role,
                                                 int tag) const
{
    if (!has_edge(a, b)) return {Verdict::Missing, {}};
    if (!(s > 0.0 && s < 1.0)) return {Verdict::Argument, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    const bool is_on_trace = role == TraceRole::Free && edge_tag(a, b) != kNoTag;
    event.operation = SurgeryOperation::SplitEdge;
    event.edge = {a, b};
    event.role = is_on_trace ? TraceRole::OnTrace : role;
    event.tag = is_on_trace ? edge_tag(a, b) : tag;
    event.changes = {implementation_->change_at({a, b, b}, {1.0 - s, s, 0.0})};
    const VertexId m = event.changes[0].vertex;
    const std::array<std::array<VertexId, 2>, 2> sides = {{{a, b}, {b, a}}};
    for (const auto& [from, to] : sides) {
        const VertexId c = apex(from, to);
        if (c == kNoVertex) continue;
        event.before.push_back(patch_face({from, to, c}));
        implementation_->add_after(event, {from, m, c});
        implementation_->add_after(event, {m, to, c});
    }
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_face_split(const IdFace& face, const Vec3& weights, TraceRole role,
                                                 int tag) const
{
    if (apex(face[0], face[1]) != face[2]) return {Verdict::Missing, {}};
    const double sum = weights.sum();
    if (!(weights.minCoeff() > 0.0) || !std::isfinite(sum)) return {Verdict::Argument, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::SplitFace;
    event.role = role;
    event.tag = tag;
    event.changes = {implementation_->change_at(face, weights / sum)};
    event.before = {patch_face(face)};
    for (int k = 0; k < 3; ++k)
        implementation_->add_after(event, {face[k], face[(k + 1) % 3], event.changes[0].vertex});
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_moves(const std::vector<VertexMove>& moves) const
{
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Move;
    std::set<VertexId> moved;
    for (const VertexMove& move : moves) {
        if (!has_vertex(move.vertex)) return {Verdict::Missing, {}};
        if (!move.material.allFinite() || !moved.insert(move.vertex).second) return {Verdict::Argument, {}};
        if (is_fixed(move.vertex)) return {Verdict::Fixed, {}};
    }
    // Orientation first: it is cheap, and then the new places are inside the old faces.
    for (const VertexMove& move : moves)
        event.changes.push_back({move.vertex, material(move.vertex), move.material, world(move.vertex),
                                 world(move.vertex), IdFace{move.vertex, move.vertex, move.vertex},
                                 Vec3::UnitX()});
    std::set<IdFace> faces;
    for (const VertexMove& move : moves) {
        if (!implementation_->keeps_border(event, move.vertex)) return {Verdict::Border, {}};
        for (IdFace face : faces_at(move.vertex)) {
            std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
            faces.insert(face);
        }
    }
    for (const IdFace& face : faces) implementation_->add_after(event, face);
    Implementation::check_orientation(proposal);
    if (!proposal.is_legal()) return proposal;
    event.after.clear();
    for (std::size_t k = 0; k < moves.size(); ++k)
        if (!moves[k].keeps_world)
            event.changes[k] = implementation_->interpolated(*this, moves[k].vertex, moves[k].material);
    for (const IdFace& face : faces) {
        event.before.push_back(patch_face(face));
        implementation_->add_after(event, face);
    }
    return proposal;
}

SurgeryProposal ClothSurgery::propose_collapse(VertexId v, VertexId w) const
{
    const Implementation& inner = *implementation_;
    if (!has_edge(v, w)) return {Verdict::Missing, {}};
    if (is_fixed(v)) return {Verdict::Fixed, {}};
    const VertexRing ring = this->ring(v);
    for (const Verdict verdict : {inner.check_trace_collapse(v, w), inner.check_border_collapse(v, w, ring),
                                  inner.check_link(v, w, ring)})
        if (verdict != Verdict::Done) return {verdict, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Collapse;
    event.edge = {v, w};
    for (const IdFace& face : faces_at(v)) {
        event.before.push_back(patch_face(face));
        if (!has(face, w)) event.after.push_back(patch_face(replaced(face, v, w)));
    }
    event.changes = {{v, material(v), material(w), world(v), world(w), IdFace{w, w, w}, Vec3::UnitX()}};
    if (event.after.empty()) return {Verdict::Topology, {}};
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_flip(VertexId a, VertexId b) const
{
    if (!has_edge(a, b)) return {Verdict::Missing, {}};
    if (edge_tag(a, b) != kNoTag) return {Verdict::Trace, {}};
    const VertexId c = apex(a, b);
    const VertexId d = apex(b, a);
    if (c == kNoVertex || d == kNoVertex) return {Verdict::Border, {}};
    if (has_edge(c, d)) return {Verdict::Topology, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Flip;
    event.edge = {a, b};
    event.before = {patch_face({a, b, c}), patch_face({b, a, d})};
    event.after = {patch_face({a, d, c}), patch_face({b, c, d})};
    Implementation::check_orientation(proposal);
    return proposal;
}

Verdict ClothSurgery::commit(const SurgeryProposal& proposal)
{
    if (!proposal.is_legal()) return proposal.verdict;
    if (implementation_->guard && !implementation_->guard(proposal.event)) return Verdict::Guard;
    implementation_->apply(proposal.event);
    if (proposal.event.operation == SurgeryOperation::Collapse)
        implementation_->touched.erase(proposal.event.edge[0]);
    for (const PatchFace& face : proposal.event.after)
        implementation_->touched.insert(face.vertices.begin(), face.vertices.end());
    implementation_->events.push_back(proposal.event);
    return Verdict::Done;
}

// --- what happened

const std::vector<SurgeryEvent>& ClothSurgery::events() const
{
    return implementation_->events;
}

void ClothSurgery::clear_events()
{
    implementation_->events.clear();
}

std::vector<VertexId> ClothSurgery::take_touched()
{
    std::vector<VertexId> taken(implementation_->touched.begin(), implementation_->touched.end());
    implementation_->touched.clear();
    return taken;
}

void ClothSurgery::touch(VertexId v)
{
    implementation_->touched.insert(v);
}

SurgeryResult ClothSurgery::result() const
{
    const SurgeryMesh& mesh = implementation_->mesh;
    SurgeryResult result;
    result.ids = mesh.ids();
    result.next_id = implementation_->next_id;
    std::unordered_map<VertexId, int> index;
    for (const VertexId v : result.ids) {
        index.emplace(v, static_cast<int>(index.size()));
        result.mesh.material.push_back(mesh.material(v));
        result.mesh.world.push_back(mesh.world(v));
        result.roles.push_back(mesh.role(v));
        result.tags.push_back(mesh.tag(v));
    }
    for (const IdFace& face : mesh.faces())
        result.mesh.faces.push_back({index.at(face[0]), index.at(face[1]), index.at(face[2])});
    for (const VertexId v : result.ids) {
        if (mesh.role(v) == TraceRole::Free) continue;
        for (const VertexId n : mesh.trace_neighbours(v))
            if (v < n) result.tagged_edges.push_back({index.at(v), index.at(n), edge_tag(v, n)});
    }
    std::sort(result.tagged_edges.begin(), result.tagged_edges.end(),
              [](const auto& e, const auto& f) { return std::pair(e.a, e.b) < std::pair(f.a, f.b); });
    return result;
}

const char* to_string(Verdict verdict)
{
    switch (verdict) {
        case Verdict::Done:
            return "done";
        case Verdict::Missing:
            return "missing";
        case Verdict::Argument:
            return "argument";
        case Verdict::Fixed:
            return "fixed";
        case Verdict::Border:
            return "border";
        case Verdict::Trace:
            return "trace";
        case Verdict::Topology:
            return "topology";
        case Verdict::Orientation:
            return "orientation";
        case Verdict::Quality:
            return "quality";
        case Verdict::Guard:
            return "guard";
        case Verdict::Budget:
            return "budget";
    }
    return "";
}

}  // namespace arris
