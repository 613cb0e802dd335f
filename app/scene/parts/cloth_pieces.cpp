// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/cloth_pieces.h"

#include <fmt/format.h>

#include <algorithm>

namespace arris {
namespace {

template <class Json>
std::vector<Json*> tables_of(Json& scene)
{
    Json& cloth = scene["cloth"];
    if (!cloth.is_array()) return {&cloth};
    std::vector<Json*> tables;
    for (Json& piece : cloth) tables.push_back(&piece);
    return tables;
}

}  // namespace

MaterialBox ClothPiece::to_plane(const MaterialBox& own) const
{
    MaterialBox box = {to_plane(own.min), to_plane(own.max)};
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

std::vector<nlohmann::ordered_json*> piece_tables(nlohmann::ordered_json& scene)
{
    return tables_of(scene);
}

std::vector<const nlohmann::ordered_json*> piece_tables(const nlohmann::ordered_json& scene)
{
    return tables_of(scene);
}

std::string piece_key(const nlohmann::ordered_json& scene, std::size_t i)
{
    return scene["cloth"].is_array() ? fmt::format("cloth.{}", i) : "cloth";
}

std::vector<ClothPiece> list_pieces(const nlohmann::ordered_json& scene)
{
    std::vector<ClothPiece> pieces;
    const std::vector<const nlohmann::ordered_json*> tables = piece_tables(scene);
    for (std::size_t i = 0; i < tables.size(); ++i) {
        ClothPiece piece;
        piece.key = piece_key(scene, i);
        piece.name = tables[i]->value("name", "");
        piece.material_key = piece.key + ".material";
        const nlohmann::ordered_json fabrics = scene.value("fabric", nlohmann::ordered_json::array());
        for (std::size_t k = 0; k < fabrics.size(); ++k)
            if (tables[i]->contains("fabric") && (*tables[i])["fabric"] == fabrics[k]["name"])
                piece.material_key = fmt::format("fabric.{}", k);
        pieces.push_back(piece);
    }
    return pieces;
}

}  // namespace arris
