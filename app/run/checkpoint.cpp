// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/checkpoint.h"

#include <array>

#include "app/files/atomic_file.h"
#include "app/files/binary_stream.h"
#include "app/files/keyframe_stream.h"
#include "app/run/checkpoint_defect.h"
#include "app/run/state_stream.h"
#include "app/text/version.h"

namespace arris {

namespace {

constexpr FileKind kKind = {"ARRIS checkpoint\n", kCheckpointVersion,
                            "there is no checkpoint to resume from; arris run starts the run again",
                            "is not a checkpoint of arris; arris run with --overwrite starts the run again"};

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

constexpr std::size_t kPieceBytes = 3 * sizeof(std::uint64_t) + 3 * sizeof(double) + sizeof(std::int32_t) + 1;

void write_piece(BinaryWriter& out, const ClothPiece& piece)
{
    out.text(piece.name);
    out.text(piece.panel);
    out.number(static_cast<std::uint8_t>(piece.is_mirrored));
    for (const double value : {piece.shift, piece.begin, piece.end}) out.number(value);
    out.number(static_cast<std::int32_t>(piece.table));
    out.list(piece.file_vertices, [&](int v) { out.number(static_cast<std::int32_t>(v)); });
}

ClothPiece read_piece(BinaryReader& in)
{
    ClothPiece piece;
    piece.name = in.text();
    piece.panel = in.text();
    piece.is_mirrored = in.number<std::uint8_t>() != 0;
    for (double* value : {&piece.shift, &piece.begin, &piece.end}) *value = in.number<double>();
    piece.table = in.number<std::int32_t>();
    piece.file_vertices = in.list<int>(sizeof(std::int32_t), [&] { return in.number<std::int32_t>(); });
    return piece;
}

constexpr std::size_t kSeamBytes = sizeof(std::uint64_t) + 2 * sizeof(std::int32_t);

void write_seam(BinaryWriter& out, const OpenSeam& seam)
{
    out.text(seam.name);
    out.number(seam.order);
    out.number(static_cast<std::int32_t>(seam.is_tie));
}

OpenSeam read_seam(BinaryReader& in)
{
    OpenSeam seam;
    seam.name = in.text();
    seam.order = in.number<std::int32_t>();
    seam.is_tie = in.number<std::int32_t>() != 0;
    return seam;
}

constexpr std::size_t kLabelBytes = 2 * sizeof(std::uint64_t) + sizeof(std::int32_t);

void write_label(BinaryWriter& out, const SceneLabel& label)
{
    out.text(label.label);
    out.number(static_cast<std::int32_t>(label.table));
    out.list(label.lines, [&](const std::array<Vec2, 2>& line) {
        for (const Vec2& X : line)
            for (const double value : {X.x(), X.y()}) out.number(value);
    });
}

SceneLabel read_label(BinaryReader& in)
{
    SceneLabel label;
    label.label = in.text();
    label.table = in.number<std::int32_t>();
    label.lines = in.list<std::array<Vec2, 2>>(4 * sizeof(double), [&] {
        std::array<Vec2, 2> line;
        for (Vec2& X : line)
            for (double* value : {&X.x(), &X.y()}) *value = in.number<double>();
        return line;
    });
    return label;
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
    checkpoint.seams = in.list<OpenSeam>(kSeamBytes, [&] { return read_seam(in); });
    checkpoint.labels = in.list<SceneLabel>(kLabelBytes, [&] { return read_label(in); });
    checkpoint.assembly_duration = in.number<double>();
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
    body.list(checkpoint.seams, [&](const OpenSeam& seam) { write_seam(body, seam); });
    body.list(checkpoint.labels, [&](const SceneLabel& label) { write_label(body, label); });
    body.number(checkpoint.assembly_duration);
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
