// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/pin_targets.h"

#include <algorithm>
#include <utility>

#include "geometry/sort_unique.h"

namespace arris {

namespace {

std::pair<std::uint32_t, std::uint32_t> key_of(const PinAnchor& anchor)
{
    return {anchor.pin, anchor.vertex_id};
}

/// An anchor that takes hold of a vertex where it is at `time`.
PinAnchor take_hold(const Scene& scene, std::uint32_t pin, std::uint32_t vertex_id, double time,
                    const Vec3& place)
{
    const SurfacePlace on = pin_surface(scene, scene.pins[pin], time, place);
    return {pin, vertex_id, pin_placement(scene, scene.pins[pin], on, time).inverse(place), on};
}

/// The anchor of a vertex; for one without an anchor, its current place moved back with the pin.
PinAnchor find_anchor(const Scene& scene, const State& state, std::uint32_t pin, int vertex)
{
    const std::pair<std::uint32_t, std::uint32_t> key(pin, state.ids[vertex]);
    const auto anchor =
        std::lower_bound(state.anchors.begin(), state.anchors.end(), key,
                         [](const PinAnchor& a, const auto& wanted) { return key_of(a) < wanted; });
    if (anchor != state.anchors.end() && key_of(*anchor) == key) return *anchor;
    return take_hold(scene, pin, state.ids[vertex], state.time, state.mesh.world[vertex]);
}

/// Vertices in the pin's region, and those that it has taken hold of; ascending.
std::vector<int> find_held(const Pin& pin, std::uint32_t index, const State& state)
{
    std::vector<int> held = vertices_inside(state.mesh, pin.material);
    for (const PinAnchor& anchor : state.anchors)
        if (anchor.pin == index) held.push_back(state.index_of(anchor.vertex_id));
    sort_unique(held);
    return held;
}

/// Vertices that a pin takes hold of: those in its region, else the nearest one (lowest index on ties).
std::vector<int> find_to_hold(const ClothMesh& mesh, const MaterialRegion& region)
{
    std::vector<int> inside = vertices_inside(mesh, region);
    if (!inside.empty() || mesh.material.empty()) return inside;
    const auto nearest = std::min_element(
        mesh.material.begin(), mesh.material.end(),
        [&](const Vec2& X, const Vec2& Y) { return region.distance(X) < region.distance(Y); });
    return {mesh.vertex_of(static_cast<int>(nearest - mesh.material.begin()))};
}

/// Ids of the vertices that pins released in the step from `begin` have held, ascending.
std::vector<std::uint32_t> find_freed(const Scene& scene, double begin, const State& state)
{
    std::vector<std::uint32_t> freed;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!pin.holds(begin, pin.release) || pin.release > state.time) continue;
        for (const int v : find_held(pin, p, state)) freed.push_back(state.ids[v]);
    }
    sort_unique(freed);
    return freed;
}

}  // namespace

std::vector<PinTarget> find_pin_targets(const Scene& scene, const State& state, double end)
{
    if (scene.pins.empty()) return {};
    std::vector<int> slot(state.mesh.world.size(), -1);
    std::vector<PinTarget> held;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!pin.holds(state.time, end)) continue;
        for (const int v : find_held(pin, p, state)) {
            if (slot[v] < 0) {
                slot[v] = static_cast<int>(held.size());
                held.push_back({v, {false, false, false}, Vec3::Zero()});
            }
            held[slot[v]].pin = static_cast<int>(p);
            const PinAnchor anchor = find_anchor(scene, state, p, v);
            const Vec3 target = pin_placement(scene, pin, anchor.on, end)(anchor.origin);
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
        if (!pin.holds(0.0, 0.0)) continue;
        for (const int v : vertices_inside(state.mesh, pin.material)) {
            const SurfacePlace on = pin_surface(scene, pin, 0.0, placed[v]);
            state.anchors.push_back({p, state.ids[v], placed[v], on});
            const Vec3 target = pin_placement(scene, pin, on, 0.0)(placed[v]);
            const Vec3 moving = pin_velocity(scene, pin, on, 0.0, target);
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                state.mesh.world[v][d] = target[d];
                state.velocity[v][d] = moving[d];
            }
        }
    }
}

void update_anchors(const Scene& scene, double begin, State& state)
{
    if (scene.pins.empty()) return;
    const std::vector<std::uint32_t> freed = find_freed(scene, begin, state);
    std::erase_if(state.anchors,
                  [&](const PinAnchor& anchor) { return scene.pins[anchor.pin].release <= state.time; });
    const auto hold_now = [&](std::uint32_t pin, int vertex) {
        return take_hold(scene, pin, state.ids[vertex], state.time, state.mesh.world[vertex]);
    };
    for (PinAnchor& anchor : state.anchors)
        if (std::binary_search(freed.begin(), freed.end(), anchor.vertex_id))
            anchor = hold_now(anchor.pin, state.index_of(anchor.vertex_id));
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!(begin < pin.start) || !pin.holds(state.time, state.time)) continue;
        for (const int v : find_to_hold(state.mesh, pin.material)) state.anchors.push_back(hold_now(p, v));
    }
    std::sort(state.anchors.begin(), state.anchors.end(),
              [](const PinAnchor& a, const PinAnchor& b) { return key_of(a) < key_of(b); });
}

}  // namespace arris
