// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/pin_targets.h"

#include <algorithm>
#include <utility>

namespace arris {

namespace {

/// Place of the vertex at time 0; for one inserted later, its current place moved back with the pin.
Vec3 find_origin(const State& state, std::uint32_t pin, int vertex, const Placement& now)
{
    const std::pair<std::uint32_t, std::uint32_t> key(pin, state.ids[vertex]);
    const auto anchor = std::lower_bound(
        state.anchors.begin(), state.anchors.end(), key,
        [](const PinAnchor& a, const auto& wanted) { return std::pair(a.pin, a.vertex_id) < wanted; });
    if (anchor != state.anchors.end() && std::pair(anchor->pin, anchor->vertex_id) == key)
        return anchor->origin;
    return now.inverse(state.mesh.world[vertex]);
}

}  // namespace

std::vector<PinTarget> find_pin_targets(const Scene& scene, const State& state, double end)
{
    if (scene.pins.empty()) return {};
    std::vector<int> slot(state.mesh.world.size(), -1);
    std::vector<PinTarget> held;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!pin.holds_until(end)) continue;
        const Placement now = pin_placement(scene, pin, state.time), then = pin_placement(scene, pin, end);
        for (const int v : vertices_in_box(state.mesh, pin.material)) {
            if (slot[v] < 0) {
                slot[v] = static_cast<int>(held.size());
                held.push_back({v, {false, false, false}, Vec3::Zero()});
            }
            held[slot[v]].pin = static_cast<int>(p);
            const Vec3 target = then(find_origin(state, p, v, now));
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                held[slot[v]].held[d] = true;
                held[slot[v]].target[d] = target[d];
            }
        }
    }
    std::sort(held.begin(), held.end(),
              [](const PinTarget& a, const PinTarget& b) { return a.vertex < b.vertex; });
    return held;
}

void hold_in_place(const std::vector<PinTarget>& held, std::vector<Vec3>& world)
{
    for (const PinTarget& vertex : held)
        for (int d = 0; d < 3; ++d)
            if (vertex.held[d]) world[vertex.vertex][d] = vertex.target[d];
}

void attach_pins(const Scene& scene, State& state)
{
    if (scene.pins.empty()) return;
    const std::vector<Vec3> placed = state.mesh.world;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!(pin.release > 0.0)) continue;
        const Placement place = pin_placement(scene, pin, 0.0);
        for (const int v : vertices_in_box(state.mesh, pin.material)) {
            state.anchors.push_back({p, state.ids[v], placed[v]});
            const Vec3 target = place(placed[v]);
            const Vec3 moving = pin_velocity(scene, pin, 0.0, target);
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                state.mesh.world[v][d] = target[d];
                state.velocity[v][d] = moving[d];
            }
        }
    }
}

}  // namespace arris
