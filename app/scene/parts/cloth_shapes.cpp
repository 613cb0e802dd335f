// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/cloth_shapes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/scene_pattern.h"
#include "geometry/cloth_input/cloth_file.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/cloth_input/cloth_outline.h"
#include "geometry/cloth_input/pattern/pattern_mesh.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

std::string cloth_shape_key(const SceneDocument& document, const std::string& piece)
{
    for (const char* leaf : {".file", ".outline", ".pattern_file", ".panel"})
        if (document.find(piece + leaf)) return piece + leaf;
    return piece + ".size";
}

std::string cloth_fineness_key(const SceneDocument& document, const std::string& piece)
{
    const std::string shape = cloth_shape_key(document, piece);
    if (shape.ends_with(".file")) return shape;
    return piece + (shape.ends_with(".size") ? ".resolution" : ".edge_length");
}

std::optional<SceneEstimate> estimate_piece(const SceneDocument& document, const Json& as_run, std::size_t i)
{
    const PieceSource piece = {document, *cloth_tables(as_run)[i], cloth_key(as_run, i)};
    if (piece.json.contains("file")) return std::nullopt;
    if (has_panels(piece.json)) {
        std::vector<std::string> notes;
        return to_estimate(
            estimate_pattern(read_pattern(piece, notes, notes), to_double(piece.json["edge_length"])));
    }
    if (!piece.json.contains("outline")) return estimate_grid(piece, to_grid(piece.json));
    return to_estimate(estimate_cloth_outline(to_outline(read_border(piece), piece.json)));
}

void check_size(const PieceSource& piece, const RunConfig& config, SceneEstimate estimate)
{
    const SceneDocument& document = piece.document;
    const std::string key = cloth_fineness_key(document, piece.key);
    estimate.vertices += piece.vertices_before;
    estimate.faces += piece.faces_before;
    if (estimate.vertices > kMaxVertices)
        refuse_estimate(document, key, estimate.vertices, "vertices", kMaxVertices);
    estimate_bytes(config.output.formats, estimate);
    if (const std::optional<Excess> excess = find_memory_excess(estimate, machine_memory_bytes()))
        document.fail(key, excess->wrong, excess->allowed);
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

ClothFile read_cloth(const PieceSource& piece, RunConfig& config)
{
    const SceneDocument& document = piece.document;
    const Json& cloth = piece.json;
    const std::string path = piece.file("file");
    const std::string unit = cloth["units"].get<std::string>();
    std::string extension = std::filesystem::path(path).extension().string();
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
    return file;
}

}  // namespace arris
