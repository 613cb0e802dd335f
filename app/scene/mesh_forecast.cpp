// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/mesh_forecast.h"

#include <fmt/format.h>

#include "app/scene/keys/scene_document.h"
#include "app/scene/keys/scene_values.h"
#include "app/scene/parts/cloth_shapes.h"
#include "app/scene/scene_rules.h"

namespace arris {

std::optional<std::string> forecast_long_meshing(const SceneSource& source)
{
    constexpr double kLong = 100000.0;  // vertices: loading takes some seconds
    SceneDocument document(source.path, source.text);
    for (const std::string& assignment : source.overrides) document.set(assignment);
    nlohmann::ordered_json as_run = complete_scene(document);
    apply_scene_rules(document, as_run);
    for (std::size_t i = 0; i < cloth_tables(as_run).size(); ++i) {
        const std::optional<SceneEstimate> estimate = estimate_piece(document, as_run, i);
        // A mesh of more vertices is refused without being made.
        if (!estimate || estimate->vertices < kLong || estimate->vertices > kMaxVertices) continue;
        return fmt::format("making a mesh of about {:.2g} million vertices, by {}", estimate->vertices / 1e6,
                           cloth_fineness_key(document, cloth_key(as_run, i)));
    }
    return std::nullopt;
}

}  // namespace arris
