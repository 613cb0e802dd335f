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
#include "app/scene/parts/cloth_shapes.h"
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
            document.fail(
                key, wrong,
                fmt::format(
                    "keys of one shape: a rectangle, {0}.outline, {0}.panel, {0}.pattern_file or {0}.file",
                    piece));
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

/// Requires panels by hand, or those of a file that some entries change.
void settle_panels(const SceneDocument& document, const std::string& piece, Json& cloth)
{
    const bool is_file = cloth.contains("pattern_file");
    drop_cloth_keys(document, piece, {"outline", "holes", "folds"}, "contradicts panels", cloth);
    if (!is_file) {
        if (document.find(piece + ".rotation_order"))
            document.fail(piece + ".rotation_order", "is written without a pattern file",
                          piece + ".pattern_file");
        cloth.erase("rotation_order");
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < cloth.value("panel", Json::array()).size(); ++i) {
        const Json& panel = cloth["panel"][i];
        const std::string key = fmt::format("{}.panel.{}", piece, i);
        if (!names.insert(panel["name"].get<std::string>()).second)
            document.fail(key + ".name", "is already the name of a panel", "a name that no other panel has");
        if (!is_file && !panel.contains("outline"))
            document.fail(key + ".outline", "is required and missing",
                          allowed_values(*find_scene_key("cloth.panel[].outline")));
        for (const char* leaf : {"outline", "edges"})
            if (is_file && panel.contains(leaf))
                document.fail(fmt::format("{}.{}", key, leaf),
                              fmt::format("contradicts {}.pattern_file", piece),
                              "a panel's shape from one place");
    }
}

/// Requires one shape of a piece: a rectangle, an outline, panels or a file. Keys that only refine a file's
/// reading remain for a warning.
void settle_cloth_shape(const SceneDocument& document, const std::string& piece, Json& cloth)
{
    const std::string shape = cloth_shape_key(document, piece), outline = piece + ".outline",
                      file = piece + ".file";
    const auto drop = [&](std::initializer_list<const char*> leaves, const std::string& wrong) {
        drop_cloth_keys(document, piece, leaves, wrong, cloth);
    };
    const bool is_sewn = has_panels(cloth), is_file = shape == file;
    for (const char* leaf : {"seam", "assembly", "rotation_order"}) {
        const bool may_be =
            is_sewn || (is_file && std::string_view(leaf) == "assembly");  // a file has stitches
        if (!may_be && document.find(piece + "." + leaf))
            document.fail(piece + "." + leaf, "is written without panels",
                          fmt::format("{0}.panel or {0}.pattern_file", piece));
        if (!is_sewn && !document.find(piece + "." + leaf)) cloth.erase(leaf);
    }
    if (!is_file)
        for (const char* key : {"units", "uv_scale"}) cloth.erase(key);
    if (!is_file && !cloth.contains("pattern_file")) cloth.erase("up");
    if (cloth.contains("up") && cloth["up"].is_null()) cloth["up"] = is_file ? "z" : "y";
    if (shape == piece + ".size") {
        drop({"holes", "edge_length"}, "is written without " + outline);
        require_cloth_keys(document, piece, {"size", "resolution"},
                           fmt::format("as there is none of {0}.outline, {0}.panel, {0}.pattern_file and "
                                       "{0}.file",
                                       piece));
        return;
    }
    drop({"size", "resolution", "pattern", "pattern_angle"}, "contradicts " + shape);
    if (is_file)
        return drop({"outline", "holes", "edge_length", "folds", "panel", "pattern_file"},
                    "contradicts " + shape);
    require_cloth_keys(document, piece, {"edge_length"}, "as there is " + shape);
    if (is_sewn) settle_panels(document, piece, cloth);
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

const Json& require_fabric(const SceneDocument& document, const std::string& key, const Json& fabrics,
                           const Json& name)
{
    for (const Json& fabric : fabrics)
        if (fabric["name"] == name) return fabric;
    document.fail(key, "is not a fabric",
                  fabrics.empty() ? "the name of a [[fabric]]; this scene has none"
                                  : "the name of a fabric: " + names_in(fabrics));
}

/// Gives a piece the material of its fabric, where it names one.
void settle_fabric(const SceneDocument& document, const std::string& piece, const Json& fabrics, Json& cloth)
{
    if (cloth.contains("panel"))
        for (std::size_t i = 0; i < cloth["panel"].size(); ++i) {
            Json& panel = cloth["panel"][i];
            if (panel["fabric"].is_null())
                panel.erase("fabric");
            else
                require_fabric(document, fmt::format("{}.panel.{}.fabric", piece, i), fabrics,
                               panel["fabric"]);
        }
    if (!cloth.contains("fabric")) return fill_material(cloth["material"]);
    const std::string key = piece + ".fabric";
    if (document.find(piece + ".material"))
        document.fail(key, fmt::format("contradicts {}.material", piece), "either a fabric or a material");
    cloth["material"] = require_fabric(document, key, fabrics, cloth["fabric"]);
    cloth["material"].erase("name");
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
    const std::vector<Json*> tables = cloth_tables(scene);
    if (tables.size() > kMaxPieces)
        document.fail(cloth_key(scene, kMaxPieces), fmt::format("is one of {} pieces", tables.size()),
                      fmt::format("at most {} pieces", kMaxPieces));
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const std::string key = cloth_key(scene, i);
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
