// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/material_users.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/text/counted.h"
#include "geometry/cloth/material_locator.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

/// The table that a pin, pull or probe (`key`) names; the only one where it names none.
int table_of_user(const Json& scene, const Json& user)
{
    const std::vector<const Json*> tables = cloth_tables(scene);
    int table = 0;
    while (user.contains("piece") && (*tables[static_cast<std::size_t>(table)])["name"] != user["piece"])
        ++table;
    return table;
}

/// The piece that a pin, pull or probe names; the only one where it names none.
const ClothPiece& piece_of(const RunConfig& config, const Json& user)
{
    const int table = table_of_user(config.as_run, user);
    return *std::find_if(config.pieces.begin(), config.pieces.end(), [&](const ClothPiece& piece) {
        return piece.table == table && (!user.contains("panel") || piece.panel == user["panel"]);
    });
}

/// Requires that pins, pulls and probes with a place in the material name one of several panels, and none
/// where there are none.
void check_panels(const SceneDocument& document, const RunConfig& config)
{
    for (const char* name : {"pin", "pull", "probe"}) {
        const Json users = config.as_run.value(name, Json::array());
        for (std::size_t i = 0; i < users.size(); ++i) {
            const std::string path = fmt::format("{}.{}", name, i);
            const int table = table_of_user(config.as_run, users[i]);
            std::string panels;
            bool is_there = false;
            for (const ClothPiece& piece : config.pieces) {
                if (piece.table != table || piece.panel.empty()) continue;
                panels += (panels.empty() ? "" : ", ") + piece.panel;
                is_there = is_there || (users[i].contains("panel") && users[i]["panel"] == piece.panel);
            }
            if (users[i].contains("panel") && !is_there)
                document.fail(
                    path + ".panel", "is not a panel",
                    panels.empty() ? "none, as this cloth has no panels" : "the name of a panel: " + panels);
            if (panels.empty() || is_there) continue;
            if (users[i].contains("vertices"))
                document.fail(path + ".vertices", "is written for a cloth of panels",
                              "material and panel, or label");
            if (users[i].contains("material") && panels.find(',') != std::string::npos)
                document.fail(path + ".panel", "is required and missing, as this cloth has several panels",
                              "the name of a panel: " + panels);
        }
    }
}

/// The vertices of the first mesh that pin i names by their numbers in a piece's file or mesh.
std::vector<int> find_pinned(const SceneDocument& document, std::size_t i, const RunConfig& config)
{
    const Json& pin = config.as_run["pin"][i];
    const ClothPiece& piece = piece_of(config, pin);
    // Vertices of a piece follow each other, also once seams before them are sewn.
    std::vector<int> own;
    for (int v = 0; v < config.cloth.vertex_count(); ++v)
        if (piece.holds(config.cloth.material[static_cast<std::size_t>(v)])) own.push_back(v);
    const std::vector<int>& of_file = piece.file_vertices;
    const std::size_t count = of_file.empty() ? own.size() : of_file.size();
    std::vector<int> vertices;
    for (std::size_t k = 0; k < pin["vertices"].size(); ++k) {
        const int number = pin["vertices"][k].get<int>();
        const std::string key = fmt::format("pin.{}.vertices.{}", i, k);
        if (static_cast<std::size_t>(number) >= count)
            document.fail(key, "is not a vertex of the cloth",
                          fmt::format("an integer from 0 to {}", count - 1));
        const int vertex = of_file.empty() ? number : of_file[static_cast<std::size_t>(number)];
        if (vertex < 0)
            document.fail(key, "is a vertex that no face of the cloth's file uses", "vertices of its faces");
        if (static_cast<std::size_t>(vertex) >= own.size())  // of a resumed run, whose numbers are untrusted
            document.fail(key, "is not a vertex of the run's first mesh", "vertices of the cloth");
        vertices.push_back(own[static_cast<std::size_t>(vertex)]);
    }
    sort_unique(vertices);
    return vertices;
}

/// The edges of panels that pin i names by a label.
MaterialRegion find_labelled(const SceneDocument& document, std::size_t i, const RunConfig& config)
{
    const Json& pin = config.as_run["pin"][i];
    std::vector<std::array<Vec2, 2>> lines;
    std::string labels;
    for (const SceneLabel& label : config.labels) {
        if (pin.contains("piece") && label.table != table_of_user(config.as_run, pin)) continue;
        labels += (labels.empty() ? "" : ", ") + label.label;
        if (label.label == pin["label"]) lines.insert(lines.end(), label.lines.begin(), label.lines.end());
    }
    if (lines.empty())
        document.fail(fmt::format("pin.{}.label", i), "is not a label of an edge",
                      labels.empty() ? "none, as no edge has a label" : "one of " + labels);
    return MaterialRegion::along(lines);
}

/// The material points of a piece, in its own coordinates.
std::vector<Vec2> material_of(const RunConfig& config, const ClothPiece& piece)
{
    std::vector<Vec2> material;
    for (const Vec2& X : config.cloth.material)
        if (piece.holds(X)) material.push_back(piece.from_plane(X));
    return material;
}

[[noreturn]] void refuse_miss(const SceneDocument& document, const std::string& key, const RunConfig& config,
                              const ClothPiece& piece, std::string_view wrong)
{
    const std::vector<Vec2> material = material_of(config, piece);
    Vec2 least = material.front(), greatest = least;
    for (const Vec2& X : material) {
        least = least.cwiseMin(X);
        greatest = greatest.cwiseMax(X);
    }
    document.fail(
        key, wrong,
        fmt::format("material coordinates of the cloth, within [[{:.6g}, {:.6g}], [{:.6g}, {:.6g}]] (m)",
                    least.x(), least.y(), greatest.x(), greatest.y()));
}

}  // namespace

void place_in_material(const SceneDocument& document, RunConfig& config)
{
    const Json& json = config.as_run;
    check_panels(document, config);
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        const Json& pin = json["pin"][i];
        config.scene.pins[i].material =
            pin.contains("label") ? find_labelled(document, i, config)
            : pin.contains("vertices")
                ? MaterialRegion::between(config.cloth, find_pinned(document, i, config))
                : MaterialRegion(piece_of(config, pin).to_plane(to_material_box(pin["material"])));
    }
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i) {
        const Json& pull = json["pull"][i];
        config.scene.pulls[i].material = piece_of(config, pull).to_plane(to_material_box(pull["material"]));
    }
    for (const Json& probe : json.value("probe", Json::array()))
        config.probes.push_back(
            {probe["name"].get<std::string>(), piece_of(config, probe).to_plane(to_vec2(probe["material"]))});
}

void check_meetings(const SceneDocument& document, const RunConfig& config)
{
    const ClothMesh& cloth = config.cloth;
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        if (!vertices_inside(cloth, config.scene.pins[i].material).empty()) continue;
        const Json& pin = config.as_run["pin"][i];
        const MaterialBox box = to_material_box(pin["material"]);
        const Vec2 middle = 0.5 * (box.min + box.max);
        const ClothPiece& piece = piece_of(config, pin);
        const std::vector<Vec2> material = material_of(config, piece);
        const Vec2 nearest =
            *std::min_element(material.begin(), material.end(), [&](const Vec2& a, const Vec2& b) {
                return (a - middle).squaredNorm() < (b - middle).squaredNorm();
            });
        refuse_miss(document, fmt::format("pin.{}.material", i), config, piece,
                    fmt::format("holds no vertex of the cloth; the nearest is at [{:.6g}, {:.6g}]",
                                nearest.x(), nearest.y()));
    }
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i)
        if (spread_over_box(cloth, config.scene.pulls[i].material).empty())
            refuse_miss(document, fmt::format("pull.{}.material", i), config,
                        piece_of(config, config.as_run["pull"][i]), "contains no cloth");
    for (std::size_t i = 0; i < config.probes.size(); ++i)
        if (const ClothPiece& piece = piece_of(config, config.as_run["probe"][i]);
            locate(cloth, config.probes[i].material).face < 0 || !piece.holds(config.probes[i].material))
            refuse_miss(document, fmt::format("probe.{}.material", i), config, piece, "is not on the cloth");
}

void warn_of_first_keyframes(const SceneDocument& document, RunConfig& config)
{
    const double tolerance = 1e-12 * (1.0 + material_size(config.cloth.material));
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        const Pin& pin = config.scene.pins[i];
        if (pin.motion.keyframes.empty() || !pin.holds(0.0, 0.0)) continue;
        const Placement first = pin.motion.at(0.0);
        int moved = 0;
        for (const int v : vertices_inside(config.cloth, pin.material)) {
            Vec3 way = first(config.cloth.world[v]) - config.cloth.world[v];
            for (int d = 0; d < 3; ++d)
                if (!pin.held[d]) way[d] = 0.0;
            if (way.norm() > tolerance) ++moved;
        }
        if (moved > 0)
            config.warnings.push_back(fmt::format("{}: moves {} from the initial placement at time 0",
                                                  document.describe(fmt::format("pin.{}.keyframes", i)),
                                                  counted(moved, "vertex", "vertices")));
    }
}

}  // namespace arris
