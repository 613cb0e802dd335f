// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/cloth_pieces.h"

#include <fmt/format.h>

#include <algorithm>

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

template <class Table>
std::vector<Table*> tables_of(Table& scene)
{
    Table& cloth = scene["cloth"];
    if (!cloth.is_array()) return {&cloth};
    std::vector<Table*> tables;
    for (Table& piece : cloth) tables.push_back(&piece);
    return tables;
}

/// Number of the fabric that a cloth or a panel names; -1 where it names none of the scene's.
int find_fabric(const Json& scene, const Json& user)
{
    if (!user.contains("fabric") || !scene.contains("fabric")) return -1;
    const Json& fabrics = scene["fabric"];
    for (std::size_t k = 0; k < fabrics.size(); ++k)
        if (fabrics[k]["name"] == user["fabric"]) return static_cast<int>(k);
    return -1;
}

/// Number of the fabric that a piece is made of: its panel's, else its cloth's; -1 without.
int fabric_of(const Json& scene, const ClothPiece& piece)
{
    const Json& cloth = table_of(scene, piece);
    if (cloth.contains("panel"))
        for (const Json& panel : cloth["panel"])
            if (panel["name"] == piece.panel && panel.contains("fabric")) return find_fabric(scene, panel);
    return find_fabric(scene, cloth);
}

}  // namespace

MaterialBox ClothPiece::to_plane(const MaterialBox& own) const
{
    const Vec2 one = to_plane(own.min), other = to_plane(own.max);
    MaterialBox box = {one.cwiseMin(other), one.cwiseMax(other)};
    box.min.x() = std::clamp(box.min.x(), begin, end);
    box.max.x() = std::clamp(box.max.x(), begin, end);
    return box;
}

std::string material_in_words(const Scene& scene, const Vec2& X, int digits)
{
    const PiecePlace& piece = scene.pieces[static_cast<std::size_t>(scene.materials.piece_at(X))];
    const Vec2 own = piece.from_plane(X);
    std::string words = fmt::format("[{:.{}g}, {:.{}g}]", own.x(), digits, own.y(), digits);
    if (!piece.name.empty()) words += " of " + piece.name;
    return words;
}

std::vector<Json*> cloth_tables(Json& scene)
{
    return tables_of(scene);
}

std::vector<const Json*> cloth_tables(const Json& scene)
{
    return tables_of(scene);
}

std::string cloth_key(const Json& scene, std::size_t i)
{
    return scene["cloth"].is_array() ? fmt::format("cloth.{}", i) : "cloth";
}

bool has_panels(const Json& cloth)
{
    return cloth.contains("pattern_file") || cloth.contains("panel");
}

std::vector<ClothPiece> list_pieces(const Json& scene)
{
    std::vector<ClothPiece> pieces;
    const std::vector<const Json*> tables = cloth_tables(scene);
    for (std::size_t i = 0; i < tables.size(); ++i) {
        ClothPiece piece;
        piece.name = tables[i]->value("name", "");
        piece.table = static_cast<int>(i);
        find_keys(scene, piece);
        pieces.push_back(piece);
    }
    return pieces;
}

void find_keys(const Json& scene, ClothPiece& piece)
{
    piece.key = cloth_key(scene, static_cast<std::size_t>(piece.table));
    const int fabric = fabric_of(scene, piece);
    piece.material_key = fabric < 0 ? piece.key + ".material" : fmt::format("fabric.{}", fabric);
}

const Json& table_of(const Json& scene, const ClothPiece& piece)
{
    return *cloth_tables(scene)[static_cast<std::size_t>(piece.table)];
}

const Json& material_of(const Json& scene, const ClothPiece& piece)
{
    const int fabric = fabric_of(scene, piece);
    return fabric < 0 ? table_of(scene, piece)["material"]
                      : scene["fabric"][static_cast<std::size_t>(fabric)];
}

std::vector<const Json*> material_tables(const Json& scene)
{
    std::vector<const Json*> materials;
    for (const Json* cloth : cloth_tables(scene)) {
        materials.push_back(&(*cloth)["material"]);
        if (!cloth->contains("panel")) continue;
        for (const Json& panel : (*cloth)["panel"])
            if (const int fabric = find_fabric(scene, panel); fabric >= 0)
                materials.push_back(&scene["fabric"][static_cast<std::size_t>(fabric)]);
    }
    return materials;
}

}  // namespace arris
