// SPDX-License-Identifier: GPL-3.0-or-later
//
// USD stores all samples of one attribute together, while frames come one by one. A run of a million frames
// does not fit into memory, so the frame files are read once per attribute and samples are written at once.
//
// USD interpolates arrays of floats linearly between the samples on either side, and holds arrays of ints. So
// faces need a sample only where they change, but float attributes that change at all are sampled at every
// frame.
//
// Where the mesh changes, vertex i before and vertex i after are different points of the cloth, and a mean of
// both is no cloth. Readers hold the earlier array if the lengths differ, but interpolate by index if they
// agree. So a held sample, a copy of the frame before, stands just before each change:
//
//     points   0: A,  1: A',  1.999999: A',  2: B       held from 1 to 2 as the faces are
#include "app/export/export_usd.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string_view>

#include "app/export/usd_obstacle.h"
#include "app/export/usd_text.h"
#include "app/files/atomic_file.h"

namespace arris {
namespace {

/// Frames that need a sample of each attribute, found in a first pass.
struct Changes {
    std::vector<std::size_t>
        face_counts;  ///< frames whose face count differs from the frame before; 0 is always there
    std::vector<std::size_t> faces;    ///< frames whose faces differ from the frame before; 0 is always there
    std::vector<std::size_t> creases;  ///< frames whose EOL edges differ from the frame before; 0 is there
    std::vector<std::size_t> meshes;   ///< frames whose vertices or faces are others than in the frame before
    bool has_eol_edges = false;        ///< whether any frame has them
    bool is_material_moving = false;   ///< whether material coordinates ever change
    bool has_seams = false;            ///< whether any vertex has several material points
};

Changes find_changes(const FrameSource& frames)
{
    Changes changes;
    Frame previous;
    for (std::size_t i = 0; i < frames.count; ++i) {
        Frame frame = frames.read(i);
        if (i == 0 || frame.faces.size() != previous.faces.size()) changes.face_counts.push_back(i);
        if (i == 0 || frame.faces != previous.faces) changes.faces.push_back(i);
        if (i == 0 || frame.eol_edges != previous.eol_edges) changes.creases.push_back(i);
        if (i > 0 && (frame.faces != previous.faces || frame.ids != previous.ids))
            changes.meshes.push_back(i);
        if (i > 0 && frame.material != previous.material) changes.is_material_moving = true;
        changes.has_seams = changes.has_seams || !frame.seam_vertices.empty();
        changes.has_eol_edges = changes.has_eol_edges || !frame.eol_edges.empty();
        previous = std::move(frame);
    }
    return changes;
}

std::string quote(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') quoted += '\\';
        if (c == '\n')
            quoted += "\\n";
        else if (byte < 0x20 || byte == 0x7f)
            quoted += fmt::format("\\x{:02x}", byte);
        else
            quoted += c;
    }
    return quoted + "\"";
}

void put_face_counts(fmt::memory_buffer& out, const Frame& frame)
{
    put_array(out, std::vector<int>(frame.faces.size(), 3));
}

void put_corners(fmt::memory_buffer& out, const std::vector<Face>& faces)
{
    std::vector<int> indices;
    for (const Face& face : faces) indices.insert(indices.end(), face.begin(), face.end());
    put_array(out, indices);
}

void put_faces(fmt::memory_buffer& out, const Frame& frame)
{
    put_corners(out, frame.faces);
}

void put_extent(fmt::memory_buffer& out, const Frame& frame)
{
    put_bounds(out, frame.world);
}

// Each EOL edge is a crease of its own. Sharpness 10 is infinite in USD.
constexpr int kInfiniteSharpness = 10;

void put_creases(fmt::memory_buffer& out, const Frame& frame)
{
    std::vector<int> indices;
    for (const auto& edge : frame.eol_edges) indices.insert(indices.end(), edge.begin(), edge.end());
    put_array(out, indices);
}

void put_crease_lengths(fmt::memory_buffer& out, const Frame& frame)
{
    put_array(out, std::vector<int>(frame.eol_edges.size(), 2));
}

void put_crease_sharpnesses(fmt::memory_buffer& out, const Frame& frame)
{
    put_array(out, std::vector<int>(frame.eol_edges.size(), kInfiniteSharpness));
}

/// A time code and the frame that is written there.
struct Sample {
    std::size_t frame;
    bool is_held = false;  ///< just before frame + 1
};

using PutSample = std::function<void(fmt::memory_buffer&, const Frame&)>;

/// One attribute of the mesh: `declaration` is its type and name, `samples` where it is written.
struct Attribute {
    std::string declaration;
    std::vector<Sample> samples;
    PutSample put;
    std::string metadata = "";
};

// A value that is constant in time is written as the default, not as a sample. Metadata need a declaration of
// their own.
void write_attribute(AtomicFile& file, const FrameSource& frames, const Attribute& attribute)
{
    const bool is_constant = attribute.samples.size() == 1;
    const std::string declaration = "    " + attribute.declaration;
    if (!attribute.metadata.empty())
        file.write(declaration + " (\n        " + attribute.metadata + "\n    )\n");
    file.write(declaration + (is_constant ? " = " : ".timeSamples = {\n"));
    for (const Sample& sample : attribute.samples) {
        fmt::memory_buffer text;
        // A millionth of a frame survives when an application shifts or scales the time codes.
        if (!is_constant)
            fmt::format_to(std::back_inserter(text), "        {}{}: ", sample.frame,
                           sample.is_held ? ".999999" : "");
        attribute.put(text, frames.read(sample.frame));
        file.write({text.data(), text.size()});
        file.write(is_constant ? "\n" : ",\n");
    }
    if (!is_constant) file.write("    }\n");
}

/// Every frame, with a held sample before each frame whose mesh is another one.
std::vector<Sample> all_frames(std::size_t count, const std::vector<std::size_t>& mesh_changes)
{
    std::vector<Sample> samples;
    auto change = mesh_changes.begin();
    for (std::size_t i = 0; i < count; ++i) {
        if (change != mesh_changes.end() && *change == i) {
            samples.push_back({i - 1, true});
            ++change;
        }
        samples.push_back({i});
    }
    return samples;
}

std::vector<Sample> samples_at(const std::vector<std::size_t>& frames)
{
    std::vector<Sample> samples;
    for (const std::size_t i : frames) samples.push_back({i});
    return samples;
}

std::vector<Attribute> attributes(std::size_t frame_count, const Changes& changes)
{
    const std::vector<Sample> every = all_frames(frame_count, changes.meshes);
    const std::vector<Sample> first(every.begin(),
                                    every.begin() + std::min<std::ptrdiff_t>(1, std::ssize(every)));
    std::vector<Attribute> list = {
        {"int[] faceVertexCounts", samples_at(changes.face_counts), put_face_counts},
        {"int[] faceVertexIndices", samples_at(changes.faces), put_faces},
        {"point3f[] points", every, [](auto& out, const Frame& frame) { put_array(out, frame.world); }},
        {"vector3f[] velocities", every,
         [](auto& out, const Frame& frame) { put_array(out, frame.vertex_velocity); }},
        {"float3[] extent", every, put_extent},
        {"texCoord2f[] primvars:st", changes.is_material_moving ? every : first,
         [](auto& out, const Frame& frame) { put_array(out, frame.own_material()); },
         fmt::format("interpolation = \"{}\"", changes.has_seams ? "faceVarying" : "vertex")},
    };
    if (changes.has_seams)
        list.push_back({"int[] primvars:st:indices", samples_at(changes.faces),
                        [](auto& out, const Frame& frame) { put_corners(out, frame.corners()); }});
    if (!changes.has_eol_edges) return list;
    list.push_back({"int[] creaseIndices", samples_at(changes.creases), put_creases});
    list.push_back({"int[] creaseLengths", samples_at(changes.creases), put_crease_lengths});
    list.push_back({"float[] creaseSharpnesses", samples_at(changes.creases), put_crease_sharpnesses});
    return list;
}

std::string stage_header(std::size_t frame_count, const UsdOptions& options)
{
    return fmt::format(
        "#usda 1.0\n"
        "(\n"
        "    doc = {}\n"
        "    defaultPrim = \"arris\"\n"
        "    startTimeCode = 0\n"
        "    endTimeCode = {}\n"
        "    timeCodesPerSecond = {}\n"
        "    framesPerSecond = {}\n"
        "    metersPerUnit = 1\n"
        "    upAxis = \"Z\"\n"
        ")\n\n"
        "def Xform \"arris\"\n"
        "{{\n"
        "def Mesh \"cloth\"\n"
        "{{\n"
        "    uniform token subdivisionScheme = \"none\"\n"
        "    uniform token orientation = \"rightHanded\"\n"
        "    uniform bool doubleSided = 1\n",
        quote(options.title), frame_count == 0 ? 0 : frame_count - 1, options.frames_per_second,
        options.frames_per_second);
}

/// A GeomSubset of faces for each of several pieces.
void write_pieces(AtomicFile& file, const FrameSource& frames, const Changes& changes)
{
    if (frames.count == 0) return;
    const std::vector<PiecePlace> pieces = frames.read(0).pieces;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        file.write(
            fmt::format("def GeomSubset \"{}\"\n{{\n"
                        "    uniform token elementType = \"face\"\n"
                        "    uniform token familyName = \"piece\"\n",
                        pieces[p].name));
        write_attribute(file, frames,
                        {"int[] indices", samples_at(changes.faces), [&](auto& out, const Frame& frame) {
                             put_array(out, frame.faces_of(static_cast<int>(p)));
                         }});
        file.write("}\n");
    }
}

}  // namespace

void write_usd(const std::string& path, const FrameSource& frames, const UsdOptions& options,
               const std::vector<ObstacleRecord>& obstacles)
{
    const Changes changes = find_changes(frames);
    AtomicFile file(path);
    file.write(stage_header(frames.count, options));
    for (const Attribute& attribute : attributes(frames.count, changes))
        write_attribute(file, frames, attribute);
    write_pieces(file, frames, changes);
    file.write("}\n");
    if (!obstacles.empty()) file.write("\ndef Scope \"obstacles\"\n{\n");
    for (const ObstacleRecord& obstacle : obstacles)
        write_usd_obstacle(file, obstacle, frames.count, options.frames_per_second);
    file.write(obstacles.empty() ? "}\n" : "}\n}\n");
    file.commit();
}

}  // namespace arris
