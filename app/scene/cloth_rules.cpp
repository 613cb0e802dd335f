// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/cloth_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

#include "app/scene/keys/scene_keys.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/scene/parts/scene_cloth.h"
#include "physics/elements/material.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

void fill_material(Json& material)
{
    const auto fill = [&](const char* key, double value) {
        if (material[key].is_null()) material[key] = value;
    };
    const Material preset = find_material_preset(material["preset"].get<std::string>()).value();
    fill("density", preset.density);
    fill("youngs_modulus", preset.youngs_modulus);
    fill("poisson_ratio", preset.poisson_ratio);
    fill("bending_stiffness", preset.bending_stiffness);
}

/// Refuses keys of a piece's shape that is not the one chosen where they are written; else removes their
/// defaults.
void drop_cloth_keys(const SceneDocument& document, const std::string& piece,
                     std::initializer_list<const char*> leaves, const std::string& wrong, Json& cloth)
{
    for (const std::string leaf : leaves) {
        const std::string key = piece + "." + leaf;
        if (document.find(key))
            document.fail(key, wrong,
                          fmt::format("keys of one shape: a rectangle, {0}.outline or {0}.file", piece));
        cloth.erase(leaf);
    }
}

void require_cloth_keys(const SceneDocument& document, const std::string& piece,
                        std::initializer_list<const char*> leaves, const std::string& why)
{
    for (const std::string leaf : leaves)
        if (!document.find(piece + "." + leaf))
            document.fail(piece + "." + leaf, "is required and missing, " + why,
                          allowed_values(*find_scene_key("cloth." + leaf)));
}

/// Requires one shape of a piece: a rectangle, an outline or a file. Keys that only refine a file's reading
/// remain for a warning.
void settle_cloth_shape(const SceneDocument& document, const std::string& piece, Json& cloth)
{
    const std::string shape = cloth_shape_key(document, piece), outline = piece + ".outline",
                      file = piece + ".file";
    if (shape != file)
        for (const char* key : {"units", "up", "uv_scale"}) cloth.erase(key);
    if (shape != outline && shape != file) {
        drop_cloth_keys(document, piece, {"holes", "edge_length"}, "is written without " + outline, cloth);
        require_cloth_keys(document, piece, {"size", "resolution"},
                           fmt::format("as there is neither {} nor {}", outline, file));
        return;
    }
    drop_cloth_keys(document, piece, {"size", "resolution", "pattern", "pattern_angle"},
                    "contradicts " + shape, cloth);
    if (shape == outline)
        require_cloth_keys(document, piece, {"edge_length"}, "as there is " + outline);
    else
        drop_cloth_keys(document, piece, {"outline", "holes", "edge_length", "folds"}, "contradicts " + shape,
                        cloth);
}

/// Names of the tables in an array, as "a, b, c".
std::string names_in(const Json& tables)
{
    std::string names;
    for (const Json& table : tables) {
        if (!table.contains("name")) continue;
        names += (names.empty() ? "" : ", ") + table["name"].get<std::string>();
    }
    return names;
}

/// Gives a piece the material of its fabric, where it names one.
void settle_fabric(const SceneDocument& document, const std::string& piece, const Json& fabrics, Json& cloth)
{
    if (!cloth.contains("fabric")) return fill_material(cloth["material"]);
    const std::string key = piece + ".fabric";
    if (document.find(piece + ".material"))
        document.fail(key, fmt::format("contradicts {}.material", piece), "either a fabric or a material");
    for (const Json& fabric : fabrics)
        if (fabric["name"] == cloth["fabric"]) {
            cloth["material"] = fabric;
            cloth["material"].erase("name");
            return;
        }
    document.fail(key, "is not a fabric",
                  fabrics.empty() ? "the name of a [[fabric]]; this scene has none"
                                  : "the name of a fabric: " + names_in(fabrics));
}

void settle_fabrics(const SceneDocument& document, Json& fabrics)
{
    std::set<std::string> names;
    for (std::size_t i = 0; i < fabrics.size(); ++i) {
        fill_material(fabrics[i]);
        if (!names.insert(fabrics[i]["name"].get<std::string>()).second)
            document.fail(fmt::format("fabric.{}.name", i), "is already the name of a fabric",
                          "a name that no other fabric has");
    }
}

}  // namespace

void settle_pieces(const SceneDocument& document, Json& scene)
{
    Json fabrics = scene.value("fabric", Json::array());
    settle_fabrics(document, fabrics);
    if (scene.contains("fabric")) scene["fabric"] = fabrics;
    const std::vector<Json*> tables = piece_tables(scene);
    if (tables.size() > kMaxPieces)
        document.fail(piece_key(scene, kMaxPieces), fmt::format("is one of {} pieces", tables.size()),
                      fmt::format("at most {} pieces", kMaxPieces));
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const std::string key = piece_key(scene, i);
        Json& piece = *tables[i];
        settle_fabric(document, key, fabrics, piece);
        settle_cloth_shape(document, key, piece);
        if (!piece["name"].is_null()) continue;
        if (scene["cloth"].is_array())
            piece["name"] = fmt::format("piece{}", i);
        else
            piece.erase("name");
    }
}

}  // namespace arris
