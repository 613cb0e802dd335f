// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/state_stream.h"

#include <array>

namespace arris {
namespace {

void write_vectors(BinaryWriter& out, const std::vector<Vec2>& vectors)
{
    out.list(vectors, [&](const Vec2& X) {
        for (const double c : X) out.number(c);
    });
}

void write_surface_place(BinaryWriter& out, const SurfacePlace& on)
{
    out.number(static_cast<std::int32_t>(on.kind));
    out.number(static_cast<std::int32_t>(on.element));
    for (const int point : on.points) out.number(static_cast<std::int32_t>(point));
    for (const double weight : on.weights) out.number(weight);
}

SurfacePlace read_surface_place(BinaryReader& in)
{
    SurfacePlace on;
    on.kind = static_cast<SurfaceKind>(in.number<std::int32_t>());
    on.element = in.number<std::int32_t>();
    for (int& point : on.points) point = in.number<std::int32_t>();
    for (double& weight : on.weights) weight = in.number<double>();
    return on;
}

std::vector<Vec2> read_vectors(BinaryReader& in)
{
    return in.list<Vec2>(2 * sizeof(double), [&] {
        const double u = in.number<double>();
        return Vec2(u, in.number<double>());
    });
}

void write_faces(BinaryWriter& out, const std::vector<Face>& faces)
{
    out.list(faces, [&](const Face& face) {
        for (const int v : face) out.number(static_cast<std::int32_t>(v));
    });
}

std::vector<Face> read_faces(BinaryReader& in)
{
    return in.list<Face>(3 * sizeof(std::int32_t), [&] {
        Face face;
        for (int& v : face) v = in.number<std::int32_t>();
        return face;
    });
}

void write_friction(BinaryWriter& out, const ContactFriction& friction)
{
    out.vector(friction.force);
    out.vector(friction.slip);
    out.number(friction.budget);
}

ContactFriction read_friction(BinaryReader& in)
{
    ContactFriction friction;
    friction.force = in.vector();
    friction.slip = in.vector();
    friction.budget = in.number<double>();
    return friction;
}

}  // namespace

void write_state(BinaryWriter& out, const State& state)
{
    out.number(state.time);
    out.number(state.step);
    write_vectors(out, state.mesh.material);
    out.vectors(state.mesh.world);
    write_faces(out, state.mesh.faces);
    write_faces(out, state.mesh.face_points);
    out.list(state.mesh.seam_vertices, [&](int v) { out.number(static_cast<std::int32_t>(v)); });
    out.list(state.ids, [&](std::uint32_t id) { out.number(id); });
    out.list(state.seam_ids, [&](std::uint32_t id) { out.number(id); });
    out.number(state.next_id);
    out.vectors(state.velocity);
    write_vectors(out, state.material_velocity);
    out.number(state.previous_dt);
    out.vectors(state.previous_world);
    out.vectors(state.previous_velocity);
    write_vectors(out, state.previous_material);
    write_vectors(out, state.previous_material_velocity);
    out.list(state.eol, [&](const EolVertex& vertex) {
        out.number(vertex.vertex_id);
        out.number(vertex.on.obstacle);
        out.number(static_cast<std::int32_t>(vertex.on.kind));
        out.number(vertex.on.index);
        out.vector(vertex.outward);
        out.number(vertex.idle);
        out.number(vertex.side);
        out.number(vertex.on.end);
        out.number(vertex.gathering);
        out.vector(vertex.force);
    });
    out.list(state.anchors, [&](const PinAnchor& anchor) {
        out.number(anchor.pin);
        out.number(anchor.vertex_id);
        out.vector(anchor.origin);
        write_surface_place(out, anchor.on);
    });
    out.list(state.active, [&](const ActiveContact& contact) {
        for (const std::uint32_t id : contact.vertex_ids) out.number(id);
        out.number(static_cast<std::int32_t>(contact.kind));
        out.number(contact.obstacle);
        out.number(contact.element);
        out.vector(contact.normal);
        out.number(contact.multiplier);
        write_friction(out, contact.friction);
        out.number(static_cast<std::int32_t>(contact.is_squeezed));
    });
    out.list(state.coupled, [&](const std::array<int, 2>& pair) {
        for (const int v : pair) out.number(static_cast<std::int32_t>(v));
    });
    out.list(state.sizing_field, [&](float length) { out.number(length); });
    out.list(state.refused_edges, [&](const RefusedEdge& edge) {
        for (const std::uint32_t id : edge.vertex_ids) out.number(id);
        out.number(edge.refusals);
        out.number(edge.until);
    });
    out.list(state.seam_pairs, [&](const SeamPair& pair) {
        for (const std::uint32_t id : pair.vertex_ids) out.number(id);
        out.number(pair.seam);
        out.number(pair.gap);
    });
    out.number(state.closing.order);
    for (const double value : {state.closing.begin, state.closing.end, state.sewn_at, state.sewn_energy})
        out.number(value);
    out.number(state.crossings);
}

State read_state(BinaryReader& in)
{
    State state;
    state.time = in.number<double>();
    state.step = in.number<std::int64_t>();
    state.mesh.material = read_vectors(in);
    state.mesh.world = in.vectors();
    state.mesh.faces = read_faces(in);
    state.mesh.face_points = read_faces(in);
    state.mesh.seam_vertices = in.list<int>(sizeof(std::int32_t), [&] { return in.number<std::int32_t>(); });
    for (std::vector<std::uint32_t>* ids : {&state.ids, &state.seam_ids})
        *ids = in.list<std::uint32_t>(sizeof(std::uint32_t), [&] { return in.number<std::uint32_t>(); });
    state.next_id = in.number<std::uint32_t>();
    state.velocity = in.vectors();
    state.material_velocity = read_vectors(in);
    state.previous_dt = in.number<double>();
    state.previous_world = in.vectors();
    state.previous_velocity = in.vectors();
    state.previous_material = read_vectors(in);
    state.previous_material_velocity = read_vectors(in);
    constexpr std::size_t kEolBytes = 7 * sizeof(std::int32_t) + 7 * sizeof(double);
    state.eol = in.list<EolVertex>(kEolBytes, [&] {
        EolVertex vertex;
        vertex.vertex_id = in.number<std::uint32_t>();
        vertex.on.obstacle = in.number<std::int32_t>();
        vertex.on.kind = static_cast<FeatureId::Kind>(in.number<std::int32_t>());
        vertex.on.index = in.number<std::int32_t>();
        vertex.outward = in.vector();
        vertex.idle = in.number<std::int32_t>();
        vertex.side = in.number<std::int32_t>();
        vertex.on.end = in.number<std::int32_t>();
        vertex.gathering = in.number<double>();
        vertex.force = in.vector();
        return vertex;
    });
    constexpr std::size_t kAnchorBytes = 7 * sizeof(std::uint32_t) + 6 * sizeof(double);
    state.anchors = in.list<PinAnchor>(kAnchorBytes, [&] {
        PinAnchor anchor;
        anchor.pin = in.number<std::uint32_t>();
        anchor.vertex_id = in.number<std::uint32_t>();
        anchor.origin = in.vector();
        anchor.on = read_surface_place(in);
        return anchor;
    });
    constexpr std::size_t kContactBytes =
        4 * sizeof(std::uint32_t) + 4 * sizeof(std::int32_t) + 11 * sizeof(double);
    state.active = in.list<ActiveContact>(kContactBytes, [&] {
        ActiveContact contact;
        for (std::uint32_t& id : contact.vertex_ids) id = in.number<std::uint32_t>();
        contact.kind = static_cast<ContactKind>(in.number<std::int32_t>());
        contact.obstacle = in.number<std::int32_t>();
        contact.element = in.number<std::int32_t>();
        contact.normal = in.vector();
        contact.multiplier = in.number<double>();
        contact.friction = read_friction(in);
        contact.is_squeezed = in.number<std::int32_t>() != 0;
        return contact;
    });
    state.coupled = in.list<std::array<int, 2>>(2 * sizeof(std::int32_t), [&] {
        std::array<int, 2> pair;
        for (int& v : pair) v = in.number<std::int32_t>();
        return pair;
    });
    state.sizing_field = in.list<float>(sizeof(float), [&] { return in.number<float>(); });
    constexpr std::size_t kRefusedBytes = 3 * sizeof(std::int32_t) + sizeof(std::int64_t);
    state.refused_edges = in.list<RefusedEdge>(kRefusedBytes, [&] {
        RefusedEdge edge;
        for (std::uint32_t& id : edge.vertex_ids) id = in.number<std::uint32_t>();
        edge.refusals = in.number<std::int32_t>();
        edge.until = in.number<std::int64_t>();
        return edge;
    });
    state.seam_pairs = in.list<SeamPair>(3 * sizeof(std::int32_t) + sizeof(double), [&] {
        SeamPair pair;
        for (std::uint32_t& id : pair.vertex_ids) id = in.number<std::uint32_t>();
        pair.seam = in.number<std::int32_t>();
        pair.gap = in.number<double>();
        return pair;
    });
    state.closing.order = in.number<std::int32_t>();
    for (double* value : {&state.closing.begin, &state.closing.end, &state.sewn_at, &state.sewn_energy})
        *value = in.number<double>();
    state.crossings = in.number<std::int64_t>();
    return state;
}

}  // namespace arris
