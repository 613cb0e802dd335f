// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_remeshing.h"

#include <fmt/format.h>

#include <numbers>

#include "app/scene/keys/scene_json.h"
#include "geometry/cloth/mesh_quality.h"
#include "solver/remesh/sizing_field.h"

namespace arris {
namespace {

/// Refuses a smallest edge length above every distance on the cloth, mostly because its unit is wrong.
void check_shortest(const SceneDocument& document, const ClothMesh& cloth, double shortest)
{
    const Vec2 sides = material_extents(cloth);
    if (shortest <= sides.norm()) return;
    document.fail(
        "remesh.edge_length",
        fmt::format("the smallest, {:g} m, exceeds the cloth's diagonal of {:.4g} m", shortest, sides.norm()),
        fmt::format("lengths (m) whose smallest is below the cloth's extent of {:.4g} x {:.4g} m", sides.x(),
                    sides.y()));
}

}  // namespace

Remeshing to_remeshing(const SceneDocument& document, const RunConfig& config)
{
    const nlohmann::ordered_json& json = config.as_run["remesh"];
    Remeshing remesh;
    remesh.shortest = to_double(json["edge_length"][0]);
    remesh.longest = to_double(json["edge_length"][1]);
    for (std::size_t i = 0; i < config.pieces.size(); ++i)
        check_shortest(document, extract_piece(config, i), remesh.shortest);
    remesh.angle = to_double(json["angle"]) * std::numbers::pi / 180.0;
    remesh.compression = to_double(json["compression"]);
    remesh.velocity = to_double(json["velocity"]);
    remesh.aspect = to_double(json["aspect"]);
    if (json.contains("vertices")) remesh.most_vertices = json["vertices"].get<int>();
    remesh.step = config.settings.step;
    measure_first_mesh(config.cloth, remesh);
    return remesh;
}

}  // namespace arris
