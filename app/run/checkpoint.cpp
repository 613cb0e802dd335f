// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/checkpoint.h"

#include <array>

#include "app/files/atomic_file.h"
#include "app/files/binary_stream.h"
#include "app/files/keyframe_stream.h"
#include "app/run/checkpoint_defect.h"
#include "app/text/version.h"

namespace arris {

namespace {

constexpr FileKind kKind = {"ARRIS checkpoint\n", kCheckpointVersion,
                            "there is no checkpoint to resume from; arris run starts the run again",
                            "is not a checkpoint of arris; arris run with --overwrite starts the run again"};

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

/// The peaks in the order of the file.
template <class Peaks>
auto peaks_of(Peaks& peaks)
{
    return std::array{&peaks.stretch, &peaks.compression, &peaks.in_plane, &peaks.last_stretch,
                      &peaks.last_compression};
}

void write_peak(BinaryWriter& out, const StrainPeak& peak)
{
    out.number(peak.strain);
    out.number(peak.time);
    out.vector(peak.world);
    for (const double c : peak.material) out.number(c);
}

StrainPeak read_peak(BinaryReader& in)
{
    StrainPeak peak;
    peak.strain = in.number<double>();
    peak.time = in.number<double>();
    peak.world = in.vector();
    for (double& c : peak.material) c = in.number<double>();
    return peak;
}

void write_peak(BinaryWriter& out, const FrictionPeak& peak)
{
    out.number(peak.residual);
    out.number(peak.time);
    out.vector(peak.world);
    out.number(peak.rows);
}

FrictionPeak read_friction_peak(BinaryReader& in)
{
    FrictionPeak peak;
    peak.residual = in.number<double>();
    peak.time = in.number<double>();
    peak.world = in.vector();
    peak.rows = in.number<std::int64_t>();
    return peak;
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

constexpr std::size_t kPieceBytes = 2 * sizeof(std::uint64_t) + 3 * sizeof(double) + 2 * sizeof(std::int32_t);

void write_piece(BinaryWriter& out, const ClothPiece& piece)
{
    out.text(piece.name);
    for (const double value : {piece.shift, piece.begin, piece.end}) out.number(value);
    for (const int count : {piece.vertices, piece.faces}) out.number(static_cast<std::int32_t>(count));
    out.list(piece.file_vertices, [&](int v) { out.number(static_cast<std::int32_t>(v)); });
}

ClothPiece read_piece(BinaryReader& in)
{
    ClothPiece piece;
    piece.name = in.text();
    for (double* value : {&piece.shift, &piece.begin, &piece.end}) *value = in.number<double>();
    for (int* count : {&piece.vertices, &piece.faces}) *count = in.number<std::int32_t>();
    piece.file_vertices = in.list<int>(sizeof(std::int32_t), [&] { return in.number<std::int32_t>(); });
    return piece;
}

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
    state.crossings = in.number<std::int64_t>();
    return state;
}

constexpr std::size_t kGivenBytes = 4 * sizeof(std::int32_t) + sizeof(std::uint64_t) + 16 * sizeof(double);

/// Its vectors in the order of the file.
template <class Given>
auto vectors_of(Given& given)
{
    return std::array{&given.velocity, &given.angular_velocity, &given.pivot, &given.last_velocity,
                      &given.last_turn};
}

void write_given(BinaryWriter& out, const GivenMotion& given)
{
    out.number(static_cast<std::int32_t>(given.mover.is_pin));
    out.number(given.mover.index);
    write_keyframes(out, given.keyframes);
    for (const bool is : {given.is_driven, given.is_jump}) out.number(static_cast<std::int32_t>(is));
    for (const Vec3* v : vectors_of(given)) out.vector(*v);
    out.number(given.pivot_time);
}

GivenMotion read_given(BinaryReader& in)
{
    GivenMotion given;
    given.mover.is_pin = in.number<std::int32_t>() != 0;
    given.mover.index = in.number<std::int32_t>();
    given.keyframes = read_keyframes(in);
    for (bool* is : {&given.is_driven, &given.is_jump}) *is = in.number<std::int32_t>() != 0;
    for (Vec3* v : vectors_of(given)) *v = in.vector();
    given.pivot_time = in.number<double>();
    return given;
}

Checkpoint parse_body(std::string_view body, const std::string& name)
{
    BinaryReader in(body, name);
    Checkpoint checkpoint;
    checkpoint.source.path = in.text();
    checkpoint.source.text = in.text();
    checkpoint.source.overrides = in.list<std::string>(sizeof(std::uint64_t), [&] { return in.text(); });
    checkpoint.warnings = in.list<std::string>(sizeof(std::uint64_t), [&] { return in.text(); });
    checkpoint.kernel = in.text();
    checkpoint.pieces = in.list<ClothPiece>(kPieceBytes, [&] { return read_piece(in); });
    checkpoint.state = read_state(in);
    checkpoint.position.begin = in.number<double>();
    checkpoint.position.done = in.number<std::int64_t>();
    checkpoint.frames = in.number<std::int64_t>();
    checkpoint.rows = in.number<std::int64_t>();
    for (StrainPeak* peak : peaks_of(checkpoint.strain)) *peak = read_peak(in);
    checkpoint.strain.plane_rows = in.number<std::int64_t>();
    checkpoint.friction = read_friction_peak(in);
    checkpoint.touching_rows = in.number<std::int64_t>();
    checkpoint.gamma = in.number<double>();
    checkpoint.given = in.list<GivenMotion>(kGivenBytes, [&] { return read_given(in); });
    if (!in.is_at_end()) in.fail("is damaged: it is longer than its counts say");
    if (const std::string defect = find_defect(checkpoint); !defect.empty()) in.fail("is damaged: " + defect);
    return checkpoint;
}

}  // namespace

std::string to_bytes(const Checkpoint& checkpoint)
{
    BinaryWriter body;
    body.text(checkpoint.source.path);
    body.text(checkpoint.source.text);
    body.list(checkpoint.source.overrides, [&](const std::string& item) { body.text(item); });
    body.list(checkpoint.warnings, [&](const std::string& item) { body.text(item); });
    body.text(checkpoint.kernel);
    body.list(checkpoint.pieces, [&](const ClothPiece& piece) { write_piece(body, piece); });
    write_state(body, checkpoint.state);
    body.number(checkpoint.position.begin);
    body.number(checkpoint.position.done);
    body.number(checkpoint.frames);
    body.number(checkpoint.rows);
    for (const StrainPeak* peak : peaks_of(checkpoint.strain)) write_peak(body, *peak);
    body.number(checkpoint.strain.plane_rows);
    write_peak(body, checkpoint.friction);
    body.number(checkpoint.touching_rows);
    body.number(checkpoint.gamma);
    body.list(checkpoint.given, [&](const GivenMotion& given) { write_given(body, given); });
    return seal(kKind, body.bytes());
}

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint)
{
    write_atomically(path, to_bytes(checkpoint));
}

Checkpoint read_checkpoint(const std::string& path)
{
    return parse_body(read_sealed(path, kKind).body, path);
}

Checkpoint parse_checkpoint(std::string_view bytes, const std::string& name)
{
    FileKind kind = kKind;
    kind.other = "is not a state of a simulation";
    return parse_body(unseal(bytes, name, kind).body, name);
}

}  // namespace arris
