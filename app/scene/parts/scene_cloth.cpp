// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_cloth.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/cloth_pieces.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/piece_layout.h"
#include "geometry/cloth/sewing.h"
#include "geometry/cloth_input/cloth_file.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/cloth_input/cloth_outline.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

/// A piece of cloth as the scene has it.
struct PieceSource {
    const SceneDocument& document;
    const Json& json;
    std::string key;  ///< "cloth", or "cloth.1"

    std::string at(const std::string& leaf) const { return key + "." + leaf; }
};

void check_size(const PieceSource& piece, const RunConfig& config, SceneEstimate estimate)
{
    const SceneDocument& document = piece.document;
    const std::string key = cloth_fineness_key(document, piece.key);
    for (const ClothPiece& made : config.pieces) {
        estimate.vertices += made.vertices;
        estimate.faces += made.faces;
    }
    if (estimate.vertices > kMaxVertices)
        refuse_estimate(document, key, estimate.vertices, "vertices", kMaxVertices);
    estimate_bytes(config.output.formats, estimate);
    if (const std::optional<Excess> excess = find_memory_excess(estimate, machine_memory_bytes()))
        document.fail(key, excess->wrong, excess->allowed);
}

/// Runs `build` and reports an InputError of it as an error of the piece's `leaf`.
template <typename Build>
auto blame(const PieceSource& piece, const std::string& leaf, const Build& build)
{
    try {
        return build();
    } catch (const InputError& error) {
        const std::string key = piece.at(leaf);
        piece.document.fail(piece.document.find(key) ? key : piece.key, error.what());
    }
}

std::vector<FoldLine> to_folds(const Json& cloth)
{
    std::vector<FoldLine> folds;
    for (const Json& fold : cloth.value("folds", Json::array()))
        folds.push_back({{to_vec2(fold["line"][0]), to_vec2(fold["line"][1])}, to_double(fold["degrees"])});
    return folds;
}

// ---- a rectangle

ClothGrid to_grid(const Json& cloth)
{
    ClothGrid grid;
    grid.size = to_vec2(cloth["size"]);
    grid.resolution = {cloth["resolution"][0].get<int>(), cloth["resolution"][1].get<int>()};
    const std::string pattern = cloth["pattern"].get<std::string>();
    grid.pattern = pattern == "diagonal"      ? GridPattern::Diagonal
                   : pattern == "alternating" ? GridPattern::Alternating
                   : pattern == "cross"       ? GridPattern::Cross
                                              : GridPattern::Unstructured;
    grid.pattern_angle = to_double(cloth["pattern_angle"]);
    grid.folds = to_folds(cloth);
    return grid;
}

SceneEstimate estimate_grid(const PieceSource& piece, const ClothGrid& grid)
{
    return to_estimate(blame(piece, "folds", [&] { return estimate_cloth_grid(grid); }));
}

ClothMesh make_rectangle(const PieceSource& piece, const RunConfig& config)
{
    const ClothGrid grid = to_grid(piece.json);
    check_size(piece, config, estimate_grid(piece, grid));
    return blame(piece, "folds", [&] {
        ClothMesh mesh = make_cloth_grid(grid);
        fold_cloth(grid.folds, mesh);
        return mesh;
    });
}

// ---- an outline

std::vector<Vec2> to_polygon(const Json& json)
{
    std::vector<Vec2> polygon;
    for (const Json& corner : json) polygon.push_back(to_vec2(corner));
    return polygon;
}

BorderLoops read_border(const PieceSource& piece)
{
    const Json& cloth = piece.json;
    std::vector<std::vector<Vec2>> holes;
    for (const Json& hole : cloth.value("holes", Json::array())) holes.push_back(to_polygon(hole));
    BorderLoops border = to_border_loops(to_polygon(cloth["outline"]), holes);
    if (const std::optional<BorderDefect> defect = find_border_defect(border))
        piece.document.fail(
            piece.at(defect->loop == 0 ? "outline" : fmt::format("holes.{}", defect->loop - 1)),
            defect->wrong, defect->allowed);
    return border;
}

std::size_t count_corners(const BorderLoops& border)
{
    std::size_t count = 0;
    for (const std::vector<Vec2>& loop : border) count += loop.size();
    return count;
}

Vec2 extent_of(const std::vector<Vec2>& loop)
{
    Eigen::AlignedBox2d box;
    for (const Vec2& corner : loop) box.extend(corner);
    return box.sizes();
}

/// Refuses an edge length whose mesh is not of the outline's shape, mostly because its unit is wrong; tells
/// of a mesh that leaves out corners, as a warning where that changes the area by more than rounding off
/// does.
void check_coarsening(const PieceSource& piece, const BorderLoops& border, const ClothOutline& outline,
                      RunConfig& config)
{
    constexpr double kWorthWarning = 0.01;  // of the area; a disc divided into 25 sides loses as much
    const Vec2 extent = extent_of(border[0]);
    const auto refuse = [&](const std::string& wrong) {
        piece.document.fail(
            piece.at("edge_length"), wrong,
            fmt::format("lengths (m) below the outline's extent of {:.4g} x {:.4g} m, with which its "
                        "area changes by at most {:g} %",
                        extent.x(), extent.y(), 100.0 * kOtherShape));
    };
    if (outline.edge_length > extent.norm())
        refuse(fmt::format("exceeds the outline's diagonal of {:.4g} m", extent.norm()));
    const std::size_t before = count_corners(border), after = count_corners(outline.border);
    if (after == before) return;
    const double change = area_of(outline.border) / area_of(border) - 1.0;
    const std::string left_out = fmt::format("{} of {} corners", before - after, before);
    if (std::abs(change) > kOtherShape)
        refuse(fmt::format("would leave out {} of the outline and its holes, and change the area by {:.2g} %",
                           left_out, 100.0 * change));
    auto& lines = std::abs(change) > kWorthWarning ? config.warnings : config.notes;
    lines.push_back(fmt::format(
        "{}: {} are left out, as they are finer than {}; this changes the area by {:.2g} %",
        piece.document.describe(piece.at("outline")), left_out, piece.at("edge_length"), 100.0 * change));
}

ClothOutline to_outline(const BorderLoops& border, const Json& cloth)
{
    ClothOutline outline;
    outline.edge_length = to_double(cloth["edge_length"]);
    outline.folds = to_folds(cloth);
    outline.border = coarsen_border(border, outline.edge_length);
    return outline;
}

ClothMesh make_outlined(const PieceSource& piece, RunConfig& config)
{
    const BorderLoops border = read_border(piece);
    const ClothOutline outline = to_outline(border, piece.json);
    check_size(piece, config, to_estimate(estimate_cloth_outline(outline)));
    check_coarsening(piece, border, outline, config);
    return blame(piece, outline.folds.empty() ? "outline" : "folds", [&] {
        ClothMesh mesh = make_cloth_outline(outline);
        fold_cloth(outline.folds, mesh);
        return mesh;
    });
}

// ---- a file

ClothMesh read_cloth(const PieceSource& piece, RunConfig& config, std::vector<int>& file_vertices)
{
    const SceneDocument& document = piece.document;
    const Json& cloth = piece.json;
    const std::filesystem::path name(cloth["file"].get<std::string>());
    const std::string path = (std::filesystem::path(document.path()).parent_path() / name).string();
    const std::string unit = cloth["units"].get<std::string>();
    std::string extension = name.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (extension != ".obj")
        document.fail(piece.at("file"), "a cloth of this format is not built yet in this version",
                      "an .obj file");
    ClothFile file = blame(piece, "file", [&] {
        return read_cloth_file(path, metres_of(unit), cloth["up"].get<std::string>()[0],
                               cloth["uv_scale"].get<double>());
    });
    if (document.find(piece.at("uv_scale")) && !file.has_uv)
        config.warnings.push_back(document.describe(piece.at("uv_scale")) +
                                  ": has no effect: the file has no UVs");
    for (const std::string& warning : file.warnings)
        config.warnings.push_back(fmt::format("{}: {}", document.describe(piece.at("file")), warning));
    SceneEstimate estimate;
    estimate.vertices = file.mesh.vertex_count();
    check_size(piece, config, estimate);
    file_vertices = std::move(file.vertices);
    return std::move(file.mesh);
}

ClothMesh make_flat_or_folded(const PieceSource& piece, RunConfig& config, std::vector<int>& file_vertices)
{
    if (piece.json.contains("file")) return read_cloth(piece, config, file_vertices);
    if (piece.json.contains("outline")) return make_outlined(piece, config);
    return make_rectangle(piece, config);
}

/// Makes or reads a piece, folds it and places it in the world. `file_vertices`: as ClothPiece's.
ClothMesh make_piece(const PieceSource& source, RunConfig& config, std::vector<int>& file_vertices)
{
    ClothMesh mesh = make_flat_or_folded(source, config, file_vertices);
    const double scale = to_double(source.json["scale"]);
    const Placement placement = {to_rotation(source.json["rotate"]), to_vec3(source.json["translate"])};
    for (Vec3& x : mesh.world) x = placement(scale * x);
    return mesh;
}

// ---- several pieces

/// Room between neighbouring pieces in the plane of all material: what is near a piece there is its own. It
/// does not depend on the meshes, so that a material point is at one place for every resolution.
double room_between(const std::vector<ClothMesh>& meshes)
{
    double room = 0.0;
    for (const ClothMesh& mesh : meshes) room = std::max(room, material_bounds(mesh).sizes().maxCoeff());
    return room;
}

/// Lays the pieces side by side.
void place_pieces(const std::vector<ClothMesh>& meshes, std::vector<ClothPiece>& pieces)
{
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const ClothMesh& mesh : meshes) boxes.push_back(material_bounds(mesh));
    const std::vector<PiecePlace> places = lay_out(boxes, room_between(meshes));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        pieces[i].shift = places[i].shift;
        pieces[i].begin = places[i].begin;
        if (i > 0) pieces[i - 1].end = places[i].begin;
    }
}

}  // namespace

std::string cloth_shape_key(const SceneDocument& document, const std::string& piece)
{
    for (const char* leaf : {".file", ".outline"})
        if (document.find(piece + leaf)) return piece + leaf;
    return piece + ".size";
}

std::string cloth_fineness_key(const SceneDocument& document, const std::string& piece)
{
    const std::string shape = cloth_shape_key(document, piece);
    if (shape.ends_with(".file")) return shape;
    return piece + (shape.ends_with(".outline") ? ".edge_length" : ".resolution");
}

std::optional<SceneEstimate> estimate_piece(const SceneDocument& document, const Json& as_run, std::size_t i)
{
    const PieceSource piece = {document, *piece_tables(as_run)[i], piece_key(as_run, i)};
    if (piece.json.contains("file")) return std::nullopt;
    if (!piece.json.contains("outline")) return estimate_grid(piece, to_grid(piece.json));
    return to_estimate(estimate_cloth_outline(to_outline(read_border(piece), piece.json)));
}

void make_scene_cloth(const SceneDocument& document, RunConfig& config)
{
    const auto tables = piece_tables(std::as_const(config.as_run));
    std::vector<ClothMesh> meshes;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        meshes.push_back(
            make_piece({document, *tables[i], config.pieces[i].key}, config, config.pieces[i].file_vertices));
        config.pieces[i].vertices = meshes[i].vertex_count();
        config.pieces[i].faces = meshes[i].face_count();
    }
    place_pieces(meshes, config.pieces);
    for (std::size_t i = 1; i < meshes.size(); ++i)
        for (Vec2& X : meshes[i].material) X = config.pieces[i].to_plane(X);
    config.cloth = join(meshes);
}

void take_scene_cloth(const LoadOptions& options, RunConfig& config)
{
    config.cloth = *options.cloth;
    if (!options.pieces) {
        config.pieces.front().vertices = config.cloth.vertex_count();
        config.pieces.front().faces = config.cloth.face_count();
        return;
    }
    const auto damaged = [&](const std::string& why) {
        throw InputError(fmt::format("{}: is damaged: {}", options.pieces_file, why));
    };
    if (options.pieces->size() != config.pieces.size())
        damaged(fmt::format("it has {} pieces of cloth, and its scene has {}", options.pieces->size(),
                            config.pieces.size()));
    std::vector<int> faces(config.pieces.size(), 0);
    for (int f = 0; f < config.cloth.face_count(); ++f) {
        const auto [a, b, c] = config.cloth.corners(f);
        const int piece = piece_at(*options.pieces, a);
        if (piece_at(*options.pieces, b) != piece || piece_at(*options.pieces, c) != piece)
            damaged(fmt::format("face {} is in two pieces of cloth", f));
        ++faces[piece];
    }
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (faces[i] == 0) damaged(fmt::format("piece {} has no cloth", i));
    for (std::size_t i = 0; i < config.pieces.size(); ++i) {
        const ClothPiece& stored = (*options.pieces)[i];
        ClothPiece& piece = config.pieces[i];
        piece.shift = stored.shift;
        piece.begin = stored.begin;
        piece.end = stored.end;
        piece.vertices = stored.vertices;
        piece.faces = stored.faces;
        piece.file_vertices = stored.file_vertices;
    }
}

std::vector<double> mean_edges(const RunConfig& config)
{
    std::vector<double> lengths;
    for (std::size_t i = 0; i < config.pieces.size(); ++i) {
        const ClothMesh mesh = extract_piece(config, i);
        lengths.push_back(measure_edges(mesh, make_topology(mesh.vertex_count(), mesh.faces)).mean);
    }
    return lengths;
}

}  // namespace arris
