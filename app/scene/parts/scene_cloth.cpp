// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_cloth.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "geometry/cloth_input/cloth_file.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/cloth_input/cloth_outline.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

void check_size(const SceneDocument& document, const RunConfig& config, SceneEstimate estimate)
{
    const std::string key = cloth_fineness_key(document);
    if (estimate.vertices > kMaxVertices)
        refuse_estimate(document, key, estimate.vertices, "vertices", kMaxVertices);
    estimate_bytes(config.output.formats, estimate);
    if (const std::optional<Excess> excess = find_memory_excess(estimate, machine_memory_bytes()))
        document.fail(key, excess->wrong, excess->allowed);
}

/// Runs `build` and reports an InputError of it as an error of `key`.
template <typename Build>
auto blame(const SceneDocument& document, const std::string& key, const Build& build)
{
    try {
        return build();
    } catch (const InputError& error) {
        document.fail(document.find(key) ? key : "cloth", error.what());
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

SceneEstimate estimate_grid(const SceneDocument& document, const ClothGrid& grid)
{
    return to_estimate(blame(document, "cloth.folds", [&] { return estimate_cloth_grid(grid); }));
}

ClothMesh make_rectangle(const SceneDocument& document, const RunConfig& config, const Json& cloth)
{
    const ClothGrid grid = to_grid(cloth);
    check_size(document, config, estimate_grid(document, grid));
    return blame(document, "cloth.folds", [&] {
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

BorderLoops read_border(const SceneDocument& document, const Json& cloth)
{
    std::vector<std::vector<Vec2>> holes;
    for (const Json& hole : cloth.value("holes", Json::array())) holes.push_back(to_polygon(hole));
    BorderLoops border = to_border_loops(to_polygon(cloth["outline"]), holes);
    if (const std::optional<BorderDefect> defect = find_border_defect(border))
        document.fail(defect->loop == 0 ? "cloth.outline" : fmt::format("cloth.holes.{}", defect->loop - 1),
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
void check_coarsening(const SceneDocument& document, const BorderLoops& border, const ClothOutline& outline,
                      RunConfig& config)
{
    constexpr double kWorthWarning = 0.01;  // of the area; a disc divided into 25 sides loses as much
    constexpr double kOtherShape = 0.1;     // of the area; a disc becomes an octagon
    const Vec2 extent = extent_of(border[0]);
    const auto refuse = [&](const std::string& wrong) {
        document.fail(
            "cloth.edge_length", wrong,
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
        "{}: {} are left out, as they are finer than cloth.edge_length; this changes the area by {:.2g} %",
        document.describe("cloth.outline"), left_out, 100.0 * change));
}

ClothOutline to_outline(const BorderLoops& border, const Json& cloth)
{
    ClothOutline outline;
    outline.edge_length = to_double(cloth["edge_length"]);
    outline.folds = to_folds(cloth);
    outline.border = coarsen_border(border, outline.edge_length);
    return outline;
}

ClothMesh make_outlined(const SceneDocument& document, RunConfig& config, const Json& cloth)
{
    const BorderLoops border = read_border(document, cloth);
    const ClothOutline outline = to_outline(border, cloth);
    check_size(document, config, to_estimate(estimate_cloth_outline(outline)));
    check_coarsening(document, border, outline, config);
    return blame(document, outline.folds.empty() ? "cloth.outline" : "cloth.folds", [&] {
        ClothMesh mesh = make_cloth_outline(outline);
        fold_cloth(outline.folds, mesh);
        return mesh;
    });
}

// ---- a file

ClothMesh read_cloth(const SceneDocument& document, RunConfig& config, const Json& cloth)
{
    const std::filesystem::path name(cloth["file"].get<std::string>());
    const std::string path = (std::filesystem::path(document.path()).parent_path() / name).string();
    const std::string unit = cloth["units"].get<std::string>();
    std::string extension = name.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (extension != ".obj")
        document.fail("cloth.file", "a cloth of this format is not built yet in this version",
                      "an .obj file");
    ClothFile file = blame(document, "cloth.file", [&] {
        return read_cloth_file(path, metres_of(unit), cloth["up"].get<std::string>()[0],
                               cloth["uv_scale"].get<double>());
    });
    if (document.find("cloth.uv_scale") && !file.has_uv)
        config.warnings.push_back(document.describe("cloth.uv_scale") +
                                  ": has no effect: the file has no UVs");
    for (const std::string& warning : file.warnings)
        config.warnings.push_back(fmt::format("{}: {}", document.describe("cloth.file"), warning));
    SceneEstimate estimate;
    estimate.vertices = file.mesh.vertex_count();
    check_size(document, config, estimate);
    return std::move(file.mesh);
}

ClothMesh make_flat_or_folded(const SceneDocument& document, RunConfig& config, const Json& cloth)
{
    if (cloth.contains("file")) return read_cloth(document, config, cloth);
    if (cloth.contains("outline")) return make_outlined(document, config, cloth);
    return make_rectangle(document, config, cloth);
}

}  // namespace

std::string cloth_shape_key(const SceneDocument& document)
{
    for (const char* key : {"cloth.file", "cloth.outline"})
        if (document.find(key)) return key;
    return "cloth.size";
}

std::string cloth_fineness_key(const SceneDocument& document)
{
    const std::string shape = cloth_shape_key(document);
    if (shape == "cloth.file") return shape;
    return shape == "cloth.outline" ? "cloth.edge_length" : "cloth.resolution";
}

std::optional<SceneEstimate> estimate_scene_cloth(const SceneDocument& document, const Json& as_run)
{
    const Json& cloth = as_run["cloth"];
    if (cloth.contains("file")) return std::nullopt;
    if (!cloth.contains("outline")) return estimate_grid(document, to_grid(cloth));
    return to_estimate(estimate_cloth_outline(to_outline(read_border(document, cloth), cloth)));
}

ClothMesh make_scene_cloth(const SceneDocument& document, RunConfig& config)
{
    const Json& cloth = config.as_run["cloth"];
    ClothMesh mesh = make_flat_or_folded(document, config, cloth);
    const double scale = to_double(cloth["scale"]);
    const Placement placement = {to_rotation(cloth["rotate"]), to_vec3(cloth["translate"])};
    for (Vec3& x : mesh.world) x = placement(scale * x);
    return mesh;
}

}  // namespace arris
