// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/start_untangling.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/text/counted.h"
#include "geometry/untangle/untangle.h"
#include "solver/model/pin_targets.h"
#include "solver/step.h"

namespace arris {
namespace {

bool is_untangled(const nlohmann::ordered_json& contact)
{
    return contact["start"] == "untangle";
}

/// Vertices that pins hold in some direction at time 0.
std::vector<int> find_held(const Scene& scene, const State& state)
{
    std::vector<int> held;
    for (const PinTarget& target : find_pin_targets(scene, state, 0.0)) held.push_back(target.vertex);
    return held;
}

}  // namespace

std::string untangle_start(const SceneDocument& document, RunConfig& config)
{
    const Scene& scene = config.scene;
    UntangleRequest request;
    std::string keys;
    const auto add_key = [&](const std::string& key) {
        keys += (keys.empty() ? "" : " and ") + document.describe(key);
    };
    if (scene.self_contact) {
        const bool is_on = is_untangled(config.as_run["self_contact"]);
        request.self = is_on ? StartRule::Untangle : StartRule::KeepApart;
        if (is_on) add_key("self_contact.start");
    }
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
        const bool is_on = is_untangled(config.as_run["obstacle"][i]);
        const std::string key = fmt::format("obstacle.{}.start", i);
        if (is_on && scene.obstacles[i].shape().mesh().faces.empty())
            document.fail(key, "is for surfaces, and this obstacle has none", "\"clear\"");
        request.obstacles.push_back(
            {scene.obstacles[i].at(0.0), is_on ? StartRule::Untangle : StartRule::KeepApart});
        if (is_on) add_key(key);
    }
    if (keys.empty()) return {};
    const State start = make_state(scene, config.cloth, config.cloth_velocity);
    request.held = find_held(scene, start);
    request.thickness = scene.materials.thickness();
    if (scene.self_contact) request.thickness = std::max(request.thickness, scene.self_contact->thickness);
    ClothMesh mesh = start.mesh;
    const UntangleReport report = untangle(request, mesh);
    if (report.crossings_before == 0) return {};
    for (std::size_t v = 0; v < mesh.world.size(); ++v)  // what pins move at time 0 stays as it was before
        if (mesh.world[v] != start.mesh.world[v]) config.cloth.world[v] = mesh.world[v];
    config.warnings.push_back(
        fmt::format("{}: at time 0 {} of faces crossed or touched; {}: {} moved by up to {:.3g} m, with "
                    "edges strained by "
                    "up to {:.2g} %",
                    keys, counted(report.crossings_before, "pair", "pairs"),
                    report.left.empty() ? std::string("all came apart")
                                        : fmt::format("{} of them are left", report.left.size()),
                    counted(report.moved_vertices, "vertex", "vertices"), report.greatest_displacement,
                    100.0 * report.greatest_strain));
    if (report.left.empty()) return {};
    return fmt::format("untangling has left {} of {}", report.left.size(),
                       counted(report.crossings_before, "pair", "pairs"));
}

}  // namespace arris
