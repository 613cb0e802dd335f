// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_cloth.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/scene/parts/cloth_shapes.h"
#include "app/scene/parts/piece_source.h"
#include "app/scene/parts/scene_pattern.h"
#include "app/text/printable.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/piece_layout.h"
#include "geometry/cloth/sewing.h"
#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/cloth_input/pattern/pattern_cloth.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

// ---- panels

PatternCloth make_sewn(const PieceSource& piece, const std::string& name, RunConfig& config)
{
    const std::string of = name.empty() ? "" : " of " + name;
    const SewingPattern pattern = read_pattern(piece, config.notes, config.warnings);
    const double length = to_double(piece.json["edge_length"]);
    check_size(piece, config, to_estimate(estimate_pattern(pattern, length)));
    PatternCloth cloth = blame(piece, "edge_length",
                               [&] { return join_panels(pattern, mesh_pattern(pattern, length), length); });
    for (std::size_t s = 0; s < pattern.seams.size(); ++s)
        if (!cloth.seams[s].is_closed)
            config.seams.push_back({{seam_in_words(pattern, static_cast<int>(s)) + of, pattern.seams[s].order,
                                     pattern.seams[s].is_tie},
                                    {}});
    return cloth;
}

/// The cloth of one of the scene's tables.
struct MadeCloth {
    ClothMesh mesh;
    std::vector<ClothPiece> pieces;  ///< one, or the panels; in the plane of this cloth alone
};

/// Makes or reads a cloth, folds it and places it in the world.
MadeCloth make_cloth(const PieceSource& source, const ClothPiece& table, RunConfig& config)
{
    const int before = source.vertices_before;
    MadeCloth made{{}, {table}};
    if (has_panels(source.json)) {
        PatternCloth cloth = make_sewn(source, table.name, config);
        auto seam = config.seams.end();
        for (auto of = cloth.seams.rbegin(); of != cloth.seams.rend(); ++of) {
            if (of->is_closed) continue;
            --seam;
            for (const auto& [p, q] : of->pairs)
                if (const int v = cloth.mesh.vertex_of(p), w = cloth.mesh.vertex_of(q); v != w)
                    seam->pairs.push_back({before + v, before + w});
        }
        made.pieces.assign(cloth.panels.size(), table);
        for (std::size_t p = 0; p < cloth.panels.size(); ++p) {
            static_cast<PiecePlace&>(made.pieces[p]) = cloth.panels[p].place;
            made.pieces[p].panel = cloth.panels[p].place.name;
            if (!table.name.empty()) made.pieces[p].name = table.name + "_" + made.pieces[p].panel;
        }
        for (LabelledLines& label : cloth.labels) config.labels.push_back({table.table, std::move(label)});
        made.mesh = std::move(cloth.mesh);
    } else if (source.json.contains("file")) {
        ClothFile file = read_cloth(source, config);
        if (!file.ties.empty()) {
            config.seams.push_back(
                {{"the stitches of " + source.json["file"].get<std::string>(), 0, true}, {}});
            for (const auto& [v, w] : file.ties)
                config.seams.back().pairs.push_back({before + v, before + w});
        }
        made.pieces.front().file_vertices = std::move(file.vertices);
        made.mesh = std::move(file.mesh);
    } else {
        made.mesh =
            source.json.contains("outline") ? make_outlined(source, config) : make_rectangle(source, config);
    }
    const double scale = to_double(source.json["scale"]);
    const Placement placement = {to_rotation(source.json["rotate"]), to_vec3(source.json["translate"])};
    for (Vec3& x : made.mesh.world) x = placement(scale * x);
    return made;
}

// ---- several cloths

/// Room between neighbours in the plane of all material: what is near a piece there is its own. It does not
/// depend on the meshes, so that a material point is at one place for every resolution.
double room_between(const std::vector<MadeCloth>& cloths)
{
    double room = 0.0;
    for (const MadeCloth& cloth : cloths)
        room = std::max(room, material_bounds(cloth.mesh).sizes().maxCoeff());
    return room;
}

/// Lays the cloths side by side, and joins them.
void lay_side_by_side(std::vector<MadeCloth> cloths, RunConfig& config)
{
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const MadeCloth& cloth : cloths) boxes.push_back(material_bounds(cloth.mesh));
    const std::vector<PiecePlace> places = lay_out(boxes, room_between(cloths));
    std::vector<ClothMesh> meshes;
    config.pieces.clear();
    for (std::size_t i = 0; i < cloths.size(); ++i) {
        for (ClothPiece& piece : cloths[i].pieces) {
            const bool is_first = &piece == &cloths[i].pieces.front();
            piece.shift += places[i].shift;
            piece.begin = is_first ? places[i].begin : piece.begin + places[i].shift;
            config.pieces.push_back(std::move(piece));
        }
        if (i > 0)
            for (Vec2& X : cloths[i].mesh.material) X = places[i].to_plane(X);
        for (SceneLabel& label : config.labels)
            if (label.table == static_cast<int>(i))
                for (auto& line : label.lines)
                    for (Vec2& X : line) X = places[i].to_plane(X);
        meshes.push_back(std::move(cloths[i].mesh));
    }
    for (std::size_t i = 1; i < config.pieces.size(); ++i) config.pieces[i - 1].end = config.pieces[i].begin;
    config.cloth = join(meshes);
}

/// Panels have names of their own, which nothing else in the scene may have.
void check_panel_names(const SceneDocument& document, const RunConfig& config)
{
    std::set<std::string> names = {"cloth"};
    for (const char* table : {"obstacle", "probe"})
        for (const Json& named : config.as_run.value(table, Json::array()))
            names.insert(named["name"].get<std::string>());
    for (const ClothPiece& piece : config.pieces)
        if (piece.panel.empty()) names.insert(piece.name);
    for (const ClothPiece& piece : config.pieces)
        if (!piece.panel.empty() && !names.insert(piece.name).second)
            document.fail(piece.key, fmt::format("has a panel whose name \"{}\" is taken", piece.name),
                          "panels, pieces, obstacles and probes with names of their own");
}

/// Checks pieces that come from a run's folder against the scene, and gives them their keys.
void take_pieces(const LoadOptions& options, RunConfig& config)
{
    const auto damaged = [&](const std::string& why) {
        throw InputError(fmt::format("{}: is damaged: {}", options.pieces_file, why));
    };
    std::vector<ClothPiece> pieces = *options.pieces;
    const std::vector<const Json*> tables = cloth_tables(std::as_const(config.as_run));
    int last = -1;
    for (ClothPiece& piece : pieces) {
        const bool is_next = piece.table == last + 1,
                   is_further = piece.table == last && !piece.panel.empty();
        last = piece.table;
        if (!(is_next || is_further) || last >= static_cast<int>(tables.size()) ||
            has_panels(*tables[static_cast<std::size_t>(last)]) == piece.panel.empty())
            damaged(fmt::format("its pieces of cloth are not those of its scene, at \"{}\"",
                                printable(piece.name, 64)));
        find_keys(config.as_run, piece);
    }
    if (last + 1 != static_cast<int>(tables.size()))
        damaged(fmt::format("it has {} pieces of cloth, and its scene has {}", last + 1, tables.size()));
    std::vector<int> faces(pieces.size(), 0);
    for (int f = 0; f < config.cloth.face_count(); ++f) {
        const auto [a, b, c] = config.cloth.corners(f);
        const int piece = piece_at(pieces, a);
        if (piece_at(pieces, b) != piece || piece_at(pieces, c) != piece)
            damaged(fmt::format("face {} is in two pieces of cloth", f));
        ++faces[static_cast<std::size_t>(piece)];
    }
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (faces[i] == 0) damaged(fmt::format("piece {} has no cloth", i));
    config.pieces = std::move(pieces);
}

}  // namespace

void make_scene_cloth(const SceneDocument& document, RunConfig& config)
{
    const auto tables = cloth_tables(std::as_const(config.as_run));
    std::vector<MadeCloth> cloths;
    int vertices = 0, faces = 0;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const ClothPiece& table = config.pieces[i];
        cloths.push_back(make_cloth({document, *tables[i], table.key, vertices, faces}, table, config));
        vertices += cloths.back().mesh.vertex_count();
        faces += cloths.back().mesh.face_count();
    }
    lay_side_by_side(std::move(cloths), config);
    for (ClothPiece& piece : config.pieces) find_keys(config.as_run, piece);
    check_panel_names(document, config);
}

void take_scene_cloth(const LoadOptions& options, RunConfig& config)
{
    config.cloth = *options.cloth;
    if (options.seams) config.seams = *options.seams;
    if (options.labels) config.labels = *options.labels;
    if (options.pieces) take_pieces(options, config);
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
