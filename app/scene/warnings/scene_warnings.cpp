// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/scene_warnings.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "app/scene/parts/scene_estimate.h"
#include "app/scene/warnings/layer_warnings.h"
#include "app/scene/warnings/motion_warnings.h"
#include "app/scene/warnings/placement_warnings.h"
#include "app/scene/warnings/still_scene.h"
#include "app/scene/warnings/warnings.h"
#include "app/text/counted.h"
#include "geometry/box_tree.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/obstacle_input/repair/sheet_opening.h"
#include "solver/eol/creases.h"

namespace arris {
namespace {

/// A piece of cloth, with its first mesh.
struct Piece {
    const ClothPiece& place;
    const nlohmann::ordered_json& json;
    const Material& material;
    ClothMesh mesh;

    std::string key(const std::string& leaf) const { return place.key + "." + leaf; }
    std::string material_key(const std::string& leaf) const { return place.material_key + "." + leaf; }
};

std::vector<Piece> list_pieces(const RunConfig& config)
{
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < config.pieces.size(); ++i)
        pieces.push_back({config.pieces[i], table_of(config.as_run, config.pieces[i]),
                          config.scene.materials[static_cast<int>(i)], extract_piece(config, i)});
    return pieces;
}

void check_material(const RunConfig& config, const Piece& piece, Warnings& warnings)
{
    const Material& material = piece.material;
    constexpr std::array kPresetKeys = {"density", "youngs_modulus", "poisson_ratio", "bending_stiffness"};
    const bool overrides_all = std::all_of(kPresetKeys.begin(), kPresetKeys.end(), [&](const char* key) {
        return warnings.is_written(piece.material_key(key));
    });
    if (overrides_all) warnings.add(piece.material_key("preset"), "keys override all values of the preset");
    constexpr double kStiffest = 1e6;  // N/m: ten times what sailcloth has
    const std::string stiffness = piece.material_key("youngs_modulus"),
                      density = piece.material_key("density"),
                      bending = piece.material_key("bending_stiffness");
    if (material.youngs_modulus > kStiffest && warnings.is_written(stiffness))
        warnings.note(stiffness,
                      "exceeds that of any cloth: the unit is N/m, a modulus in Pa times the cloth's "
                      "physical thickness in m");
    constexpr double kHeaviest = 3.0;  // kg/m^2: three times what thick leather has
    if (material.density > kHeaviest && warnings.is_written(density))
        warnings.note(density, "exceeds that of any cloth: the unit is kg/m^2, and 150 g/m^2 are 0.15");
    if (material.bending_stiffness > 0.0 &&
        make_topology(piece.mesh.vertex_count(), piece.mesh.faces).hinges.empty())
        warnings.add(bending, "no two faces of the cloth share an edge");
    const bool keeps_layers = config.scene.self_contact && !warnings.is_written("self_contact.thickness");
    if (config.scene.obstacles.empty() && !keeps_layers)
        warnings.add(piece.material_key("thickness"), "the scene has no obstacle");
}

void check_piece(const RunConfig& config, const Piece& piece, Warnings& warnings)
{
    if (!warnings.is_written(piece.key("file")))
        for (const char* leaf : {"units", "up", "uv_scale"})
            if (leaf != std::string_view("up") || !warnings.is_written(piece.key("pattern_file")))
                warnings.add(piece.key(leaf), "the cloth is not from a file");
    if (piece.json.value("pattern", "") == "unstructured")
        warnings.add(piece.key("pattern_angle"), "an unstructured mesh has no direction");
    check_material(config, piece, warnings);
}

/// Warns of fabrics that no piece is made of.
void check_fabrics(const RunConfig& config, Warnings& warnings)
{
    for (std::size_t k = 0; k < config.as_run.value("fabric", nlohmann::ordered_json::array()).size(); ++k) {
        const std::string key = fmt::format("fabric.{}", k);
        if (std::none_of(config.pieces.begin(), config.pieces.end(),
                         [&](const ClothPiece& piece) { return piece.material_key == key; }))
            warnings.add(key, "no piece of cloth is made of it");
    }
}

/// Warns of a cloth of implausible size, mostly because the unit is wrong.
void check_cloth_size(const Piece& piece, Warnings& warnings)
{
    constexpr double kSmallest = 5e-3, kLargest = 50.0;  // m, longer side
    const Vec2 sides = material_extents(piece.mesh);
    if (sides.maxCoeff() >= kSmallest && sides.maxCoeff() <= kLargest) return;
    std::string key = piece.key(warnings.is_written(piece.key("outline")) ? "outline" : "size");
    std::string advice = "sizes are in metres";
    if (warnings.is_written(piece.key("units"))) {
        key = piece.key("units");
        advice = fmt::format("check this unit; it is that of positions, while {} is that of UVs",
                             piece.key("uv_scale"));
    } else if (warnings.is_written(piece.key("file"))) {
        key = piece.key("file");
        advice =
            "a file that is not in metres needs 'units', such as \"mm\", for positions, and 'uv_scale' for "
            "UVs";
    }
    warnings.note(key, fmt::format("the cloth is {:.4g} x {:.4g} m: {}", sides.x(), sides.y(), advice));
}

/// Warns of borders of a file's cloth that nearly meet: they were to be sewn, but only equal positions are.
void check_open_seams(const Piece& piece, Warnings& warnings)
{
    if (!warnings.is_written(piece.key("file"))) return;
    const MeshTopology topology = make_topology(piece.mesh.vertex_count(), piece.mesh.faces);
    std::vector<int> border;
    for (int v = 0; v < piece.mesh.vertex_count(); ++v)
        if (topology.is_border[v]) border.push_back(v);
    const auto box_around = [&](int v, double reach) {
        const Vec3& x = piece.mesh.world[v];
        return BoxTree::Box(x.array() - reach, x.array() + reach);
    };
    // Layers start farther apart than this, as do the vertices of one border.
    double reach = 0.5 * piece.material.thickness;
    for (const MeshEdge& edge : topology.edges)
        reach = std::min(reach, 0.25 * (piece.mesh.world[edge.b] - piece.mesh.world[edge.a]).norm());
    std::vector<BoxTree::Box> boxes;
    for (const int v : border) boxes.push_back(box_around(v, 0.0));
    const BoxTree tree(boxes);
    std::vector<int> near;
    int count = 0, first = -1;
    for (const int v : border) {
        tree.find(box_around(v, reach), near);
        if (near.size() < 2) continue;  // itself
        if (count++ == 0) first = v;
    }
    if (count == 0) return;
    const Vec3& x = piece.mesh.world[first];
    warnings.note(
        piece.key("file"),
        fmt::format("{} of its borders lie within half a thickness of others, the first at ({:.6g}, "
                    "{:.6g}, {:.6g}) m, and stay open: only equal positions are sewn",
                    counted(count, "vertex", "vertices"), x.x(), x.y(), x.z()));
}

void check_wind(const RunConfig& config, Warnings& warnings)
{
    if (config.scene.gravity && is_zero(config.scene.gravity->acceleration))
        warnings.add("gravity.acceleration", "the acceleration is zero");
    if (!config.scene.wind) return;
    const Wind& wind = *config.scene.wind;
    if (is_zero(wind.drag) || is_zero(wind.air_density))
        warnings.add("wind", is_zero(wind.drag) ? "wind.drag is zero" : "wind.air_density is zero");
    if (!wind.gust) return;
    if (is_zero(wind.velocity))
        warnings.add("wind.gust", "the wind's velocity is zero");
    else if (is_zero(wind.gust->amplitude))
        warnings.add("wind.gust", "the amplitude is zero");
}

void check_pulls(const RunConfig& config, Warnings& warnings)
{
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i) {
        const Pull& pull = config.scene.pulls[i];
        const std::string path = fmt::format("pull.{}", i);
        if (is_zero(pull.force)) warnings.add(path + ".force", "the force is zero");
        if (pull.start >= config.duration)
            warnings.add(path + ".start", "the pull starts after the end of the run");
        else if (pull.stop >= config.duration)
            warnings.add(path + ".stop", "the run ends before that time");
    }
}

/// Warns of a surface that is closed except for a hole: it looks solid, but is a sheet.
void check_inside(const RunConfig& config, std::size_t i, Warnings& warnings)
{
    const auto& json = config.as_run["obstacle"][i];
    if (!json.contains("file")) return;
    const Obstacle& obstacle = config.scene.obstacles[i].shape();
    int count = 0, border_edges = 0;
    for (const SheetOpening& opening : find_sheet_openings(obstacle.mesh(), obstacle.topology())) {
        if (!opening.looks_solid()) continue;
        ++count;
        border_edges += opening.border_edges;
    }
    if (count == 0) return;
    const std::string which = count == 1 ? "a surface" : fmt::format("each of {} surfaces", count);
    warnings.note(fmt::format("obstacle.{}.file", i),
                  fmt::format("{} is closed except for a hole ({}{}), and so is a sheet without an "
                              "inside: cloth may enter through the hole; if a solid is meant, close the mesh",
                              which, counted(border_edges, "border edge", "border edges"),
                              count == 1 ? "" : " in all"));
}

void check_obstacles(const RunConfig& config, Warnings& warnings)
{
    for (std::size_t i = 0; i < config.scene.obstacles.size(); ++i) {
        const MovingObstacle& obstacle = config.scene.obstacles[i];
        const std::string path = fmt::format("obstacle.{}", i);
        const auto& json = config.as_run["obstacle"][i];
        if (!json.contains("file")) {
            warnings.add(path + ".units", "the obstacle is not from a file");
            warnings.add(path + ".up", "the obstacle is not from a file");
        }
        if (!json.contains("wire")) warnings.add(path + ".closed", "the obstacle is not a wire");
        if (obstacle.shape().mesh().faces.empty())
            warnings.add(path + ".feature_angle", "the obstacle has no faces");
        check_inside(config, i, warnings);
        check_obstacle_motion(config, obstacle.motion(), path, warnings);
    }
    if (config.as_run["eol"]["enabled"].get<bool>() && !config.scene.eol)
        warnings.add("eol.enabled", "no obstacle has a sharp feature");
}

void check_time(const RunConfig& config, Warnings& warnings)
{
    const double fps = config.output.frames_per_second;
    if (is_zero(fps) && !config.output.formats.empty())
        warnings.add("output.formats", "with frames_per_second = 0 there are no frames to export");
    const double longest = fps > 0.0 ? std::min(config.duration, 1.0 / fps) : config.duration;
    if (config.settings.step > longest * (1.0 + 1e-9))
        warnings.note(
            "time.step",
            fmt::format("is shortened to {:.6g} s: steps end at frames and at the duration", longest));
}

/// Square root of the world's area over the material's.
double mean_stretch(const ClothMesh& cloth)
{
    double world_area = 0.0;
    for (const auto& [a, b, c] : cloth.faces)
        world_area += (cloth.world[b] - cloth.world[a]).cross(cloth.world[c] - cloth.world[a]).norm() / 2.0;
    return std::sqrt(world_area / material_area(cloth));
}

/// Warns of a cloth that starts strongly strained, mostly because its UVs are not in metres.
void check_strain(const Piece& piece, const StrainRange& placed, Warnings& warnings)
{
    if (!placed.is_surprising()) return;
    const bool is_scaled = warnings.is_written(piece.key("scale"));
    std::string remedy;
    if (piece.json.contains("file"))
        remedy = fmt::format("; scale the UVs in the file to metres, or set {} (near {:.3g})",
                             piece.key("uv_scale"),
                             piece.json["uv_scale"].get<double>() * mean_stretch(piece.mesh));
    else if (is_scaled)
        remedy = "; change 'size' instead of 'scale'";
    warnings.note(is_scaled ? piece.key("scale") : piece.place.key,
                  fmt::format("{} strained, {}: material coordinates are in metres, and the "
                              "cloth will contract or expand to their size{}",
                              is_scaled ? "starts the cloth" : "starts", in_words(placed), remedy));
}

/// Warns of thin faces. Mesh surgery refuses operations that leave thin faces, so few EOL vertices fit in.
void check_angles(const RunConfig& config, const Piece& piece, Warnings& warnings)
{
    constexpr double kThin = 5.0;  // degrees
    if (!config.scene.eol) return;
    const ClothMesh& cloth = piece.mesh;
    int thin = 0, thinnest = 0;
    double least = kThin;
    for (int f = 0; f < cloth.face_count(); ++f) {
        const double angle = least_material_angle(cloth, f);
        if (!(angle < kThin)) continue;
        ++thin;
        if (angle < least) std::tie(least, thinnest) = std::pair(angle, f);
    }
    if (thin == 0) return;
    const bool is_from_file = warnings.is_written(piece.key("file"));
    const bool is_outline = warnings.is_written(piece.key("outline"));
    const Vec2 X = piece.place.from_plane(cloth.corners(thinnest)[0]);
    warnings.note(
        piece.key(is_from_file ? "file"
                  : is_outline ? "outline"
                               : "resolution"),
        fmt::format(
            "{} of {} an angle below {:g} degrees, the least {:.2g} degrees at [{:.6g}, {:.6g}] "
            "(material): EOL vertices can hardly be placed in such thin faces; {}",
            thin, counted(cloth.face_count(), "face has", thin == 1 ? "faces has" : "faces have"), kThin,
            least, X.x(), X.y(),
            is_outline ? "round off sharp corners"
            : is_from_file
                ? "remesh the file with more even faces"
                : "use cells with more even sides, or folds and a pattern_angle that cut off no slivers"));
}

/// Warns of a thickness above the mean edge, mostly because the unit is wrong.
void check_thickness(const RunConfig& config, const Piece& piece, Warnings& warnings)
{
    if (config.scene.obstacles.empty()) return;
    const ClothMesh& mesh = piece.mesh;
    const double cell = measure_edges(mesh, make_topology(mesh.vertex_count(), mesh.faces)).mean;
    if (piece.material.thickness > cell)
        warnings.note(
            piece.material_key("thickness"),
            fmt::format("exceeds the mean edge of the cloth's mesh, {:.3g} m: the thickness is the distance "
                        "kept from obstacles, in metres, and should be well below that edge",
                        cell));
}

/// Warns where the mesh resolves the bend of the cloth over a feature: EOL vertices then only cost time and
/// energy.
void check_bends(const RunConfig& config, Warnings& warnings)
{
    if (!resolves_bends(config.scene, config.cloth)) return;
    std::size_t softest = 0;
    for (std::size_t i = 1; i < config.pieces.size(); ++i)
        if (config.scene.materials[static_cast<int>(i)].bending_stiffness <
            config.scene.materials[static_cast<int>(softest)].bending_stiffness)
            softest = i;
    const std::string stiffness = config.pieces[softest].material_key + ".bending_stiffness",
                      preset = config.pieces[softest].material_key + ".preset";
    const double bending_stiffness = config.scene.materials[static_cast<int>(softest)].bending_stiffness;
    const std::string what = fmt::format(
        "the mean edge of {:.3g} m resolves the bend of cloth with a bending stiffness of {:.3g} J over a "
        "sharp feature: without EOL vertices (eol.enabled = false) the cloth slides as well, at less cost; "
        "see docs/accuracy.md, Stiff bends",
        config.scene.eol->mean_lengths[softest], bending_stiffness);
    if (warnings.is_written(stiffness))
        warnings.note(stiffness, what);
    else if (warnings.is_written(preset))
        warnings.note(preset, what);
    else
        warnings.note(what);
}

void check_stillness(const RunConfig& config, const MeshTopology& topology, Warnings& warnings)
{
    if (stays_still(config, topology))
        warnings.note(
            "nothing moves the cloth: there is no [gravity], no acting wind or [[pull]], no moving pin or "
            "obstacle and no cloth.velocity, and the cloth starts flat and unstrained");
}

/// Warns of remeshing that may make fewer vertices than the first mesh has, or than its longest edges need.
void check_remeshing(const RunConfig& config, Warnings& warnings)
{
    if (!config.scene.remesh) return;
    const Remeshing& remesh = *config.scene.remesh;
    if (remesh.most_vertices < config.cloth.vertex_count())
        warnings.note("remesh.vertices",
                      fmt::format("is below the {} vertices of the first mesh, so cells become coarser "
                                  "everywhere",
                                  config.cloth.vertex_count()));
    const double written = config.as_run["remesh"]["edge_length"][1].get<double>();
    if (!(remesh.longest > written)) return;
    warnings.note(
        warnings.is_written("remesh.vertices") ? "remesh.vertices" : "remesh",
        fmt::format("edges of {:g} m need more than {} vertices on this cloth, so edges may be as long as "
                    "{:.3g} m; allow more vertices or longer edges",
                    written, remesh.most_vertices, remesh.longest));
}

}  // namespace

std::vector<std::string> find_ineffective_keys(const SceneDocument& document, const RunConfig& config,
                                               const std::vector<StrainRange>& placed)
{
    Warnings warnings(document);
    const MeshTopology topology = make_topology(config.cloth.vertex_count(), config.cloth.faces);
    const std::vector<Piece> pieces = list_pieces(config);
    const auto check_pieces = [&](const auto& check) {
        for (const Piece& piece : pieces) check(piece);
    };
    check_time(config, warnings);
    check_pieces([&](const Piece& piece) { check_piece(config, piece, warnings); });
    check_fabrics(config, warnings);
    check_pieces([&](const Piece& piece) {
        check_cloth_size(piece, warnings);
        check_open_seams(piece, warnings);
    });
    check_pieces([&](const Piece& piece) { check_angles(config, piece, warnings); });
    check_pins(config, warnings);
    check_wind(config, warnings);
    check_pulls(config, warnings);
    check_obstacles(config, warnings);
    check_placement(config, warnings);
    check_turns(config, warnings);
    for (std::size_t i = 0; i < pieces.size(); ++i) check_strain(pieces[i], placed[i], warnings);
    check_pieces([&](const Piece& piece) { check_thickness(config, piece, warnings); });
    check_layers(config, topology, warnings);
    check_bends(config, warnings);
    check_stillness(config, topology, warnings);
    check_remeshing(config, warnings);
    // Pieces of one fabric have the same warnings.
    std::vector<std::string> lines;
    for (const std::string& line : warnings.lines_)
        if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
    return lines;
}

}  // namespace arris
