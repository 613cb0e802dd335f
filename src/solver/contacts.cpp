// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contacts.h"

#include <algorithm>
#include <utility>

namespace arris {

namespace {

/// Where the vertex was at time 0; for one that was inserted later, where the pin's motion would have had it.
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

std::vector<HeldVertex> find_held_vertices(const Scene& scene, const State& state, double end)
{
    std::vector<int> slot(state.mesh.world.size(), -1);
    std::vector<HeldVertex> held;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!pin.holds_until(end)) continue;
        const Placement now = pin.motion.at(state.time), then = pin.motion.at(end);
        for (const int v : vertices_in_box(state.mesh, pin.material)) {
            if (slot[v] < 0) {
                slot[v] = static_cast<int>(held.size());
                held.push_back({v, {false, false, false}, Vec3::Zero()});
            }
            const Vec3 target = then(find_origin(state, p, v, now));
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                held[slot[v]].held[d] = true;
                held[slot[v]].target[d] = target[d];
            }
        }
    }
    std::sort(held.begin(), held.end(),
              [](const HeldVertex& a, const HeldVertex& b) { return a.vertex < b.vertex; });
    return held;
}

std::vector<Contact> find_contacts(const Scene& scene, const State& state, Prediction& prediction)
{
    std::vector<Contact> contacts;
    if (!scene.floor) return contacts;
    const Vec3& n = scene.floor->normal;
    const double stand_off = scene.floor->offset + scene.material.thickness;
    contacts.reserve(state.mesh.world.size());
    auto active = state.active.begin();
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
        while (active != state.active.end() && active->vertex_id < state.ids[v]) ++active;
        const bool was_active = active != state.active.end() && active->vertex_id == state.ids[v];

        Contact contact{v, n, n.dot(state.mesh.world[v]) - stand_off,
                        n.dot(prediction.position[v]) - stand_off};
        if (prediction.has_history && (contact.gap < 0.0 || was_active)) {
            prediction.position[v] += (contact.gap_now - contact.gap) * n;
            prediction.velocity[v] += n.dot(state.velocity[v] - prediction.velocity[v]) * n;
            contact.gap = contact.gap_now;
        }
        contacts.push_back(contact);
    }
    return contacts;
}

}  // namespace arris
