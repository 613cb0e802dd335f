// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/scene_remeshing.h"

#include <numbers>

#include "solver/remesh/cell_lengths.h"

namespace arris {

Remeshing to_remeshing(const nlohmann::ordered_json& json, double step, const ClothMesh& cloth)
{
    Remeshing remesh;
    remesh.shortest = to_double(json["edge_length"][0]);
    remesh.longest = to_double(json["edge_length"][1]);
    remesh.angle = to_double(json["angle"]) * std::numbers::pi / 180.0;
    remesh.compression = to_double(json["compression"]);
    remesh.velocity = to_double(json["velocity"]);
    remesh.aspect = to_double(json["aspect"]);
    if (json.contains("vertices")) remesh.most_vertices = json["vertices"].get<int>();
    remesh.step = step;
    measure_first_mesh(cloth, remesh);
    return remesh;
}

}  // namespace arris
