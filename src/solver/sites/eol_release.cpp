// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/eol_release.h"

#include <algorithm>

#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "solver/eol/eol_features.h"
#include "solver/eol/free_fold.h"
#include "solver/sites/border_room.h"

namespace arris {

namespace {

/// Whether the cloth turns at the vertex.
bool is_folded(const State& state, std::span<const int> faces)
{
    std::vector<Vec3> normals;
    Vec3 mean = Vec3::Zero();
    for (const int f : faces) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const std::vector<Vec3>& x = state.mesh.world;
        normals.push_back((x[b] - x[a]).cross(x[c] - x[a]).normalized());
        mean += normals.back();
    }
    mean.normalize();
    return !std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(mean) > kFlat; });
}

/// Whether an EOL vertex is of a corner which presses on a face of the cloth: it holds one vertex, and is
/// where that face is.
bool is_corner_under_face(const Scene& scene, const State& state, const EolVertex& eol)
{
    const Obstacle& obstacle = scene.obstacles[eol.on.obstacle];
    if (!eol.on.is_corner()) return false;
    const int point = obstacle.features().corners[eol.on.index].point;
    return std::any_of(state.active.begin(), state.active.end(), [&](const ActiveContact& contact) {
        return contact.obstacle == eol.on.obstacle && contact.kind == ContactKind::Triangle &&
               contact.element == point;
    });
}

/// Whether an EOL vertex that has left its edge or wire, through which material flows fast, is led otherwise
/// than what comes to it: it then bends that, with every step. Along a face it is not (free_fold.h).
bool is_led_astray(const Scene& scene, const State& state, const EolVertex& eol, const EolCoordinates& at,
                   const Vec3& place)
{
    constexpr double kAlongFace = 0.15;  // sine
    if (eol.on.is_corner() || !has_left_feature(at.frame.point, place, scene.material.thickness) ||
        !(state.material_velocity[at.vertex].norm() > 0.5 * kFreeFlow))
        return false;
    const Obstacle& obstacle = scene.obstacles[eol.on.obstacle];
    if (!is_on_convex_edge(obstacle, eol)) return true;
    const std::array<Vec3, 2>& normals = obstacle.features().edges[eol.on.index].normals;
    return std::none_of(normals.begin(), normals.end(), [&](const Vec3& normal) {
        return std::abs(normal.dot(at.frame.outward)) < kAlongFace;
    });
}

/// Whether an EOL vertex is still on the polyline that it is on: not at its end.
bool is_on_feature(const Obstacle& obstacle, const EolVertex& vertex, const Vec3& place)
{
    return vertex.on.is_corner() || !is_past_end(obstacle, vertex.on.index, place);
}

}  // namespace

EolRetention decide_retention(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                              const EolCoordinates& at, const Vec3& place)
{
    const EolVertex& eol = state.eol[entry];
    if (eol.idle < kIdleSteps) return EolRetention::Firm;
    const double gap = (place - at.frame.point).norm();
    const double cells = is_led_astray(scene, state, eol, at, place) ? kAstrayCells : 1.0;
    if (gap > cells * scene.eol->shortest && gap > cells * scene.eol->length(state.mesh.material[at.vertex]))
        return EolRetention::None;
    const bool has_left = gap > kOnFeature * scene.material.thickness;
    if (has_left && is_corner_under_face(scene, state, eol)) return EolRetention::None;
    if (is_folded(state, stars.faces[at.vertex])) return EolRetention::Firm;
    return has_left ? EolRetention::None : EolRetention::Loose;
}

void retain_between(const Scene& scene, const State& state, const ClothStars& stars,
                    std::vector<EolRetention>& retained)
{
    if (std::find(retained.begin(), retained.end(), EolRetention::Loose) == retained.end()) return;
    std::vector<std::vector<int>> beside(retained.size());
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        if (retained[a] == EolRetention::None || retained[b] == EolRetention::None) continue;
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    // What is left when loose ends are cut off, again and again, lies between.
    std::vector<int> open;
    for (std::size_t entry = 0; entry < retained.size(); ++entry) open.push_back(static_cast<int>(entry));
    while (!open.empty()) {
        const int at = open.back();
        open.pop_back();
        if (retained[at] != EolRetention::Loose || beside[at].size() > 1) continue;
        retained[at] = EolRetention::None;
        for (const int next : beside[at]) {
            std::erase(beside[next], at);
            open.push_back(next);
        }
    }
    for (EolRetention& retention : retained)
        if (retention == EolRetention::Loose) retention = EolRetention::Firm;
}

bool is_at_border(const Scene& scene, const State& state, const ClothStars& stars, const EolVertex& eol)
{
    constexpr double kRoom = 0.15, kCornerRoom = 0.3;  // target lengths to a border ahead
    const int v = state.index_of(eol.vertex_id);
    const Vec2& X = state.mesh.material[v];
    const double wanted = eol.on.is_corner() ? kCornerRoom : kRoom;
    const double room = room_to_border(scene, state, stars, X, v, stars.border_neighbours[v][0] >= 0, eol);
    return !(room > wanted * scene.eol->longest) && !(room > wanted * scene.eol->length(X));
}

std::vector<std::uint32_t> find_releases(const Scene& scene, const State& state, const ClothStars& stars)
{
    EolPlacer placer(scene.obstacles, scene.material.thickness, state, stars);
    std::vector<EolRetention> retained;
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry) {
        const EolVertex& eol = state.eol[entry];
        const Obstacle& obstacle = scene.obstacles[eol.on.obstacle];
        retained.push_back(EolRetention::None);
        const Vec3 place = obstacle.at(state.time).inverse(state.mesh.world[state.index_of(eol.vertex_id)]);
        const EolPlacing placing = placer.place(entry);
        if (!placing.coordinates || is_at_border(scene, state, stars, eol) ||
            !is_on_feature(obstacle, eol, place))
            continue;
        retained.back() = decide_retention(scene, state, stars, entry, *placing.coordinates, place);
    }
    retain_between(scene, state, stars, retained);
    std::vector<std::uint32_t> released;
    for (std::size_t entry = 0; entry < retained.size(); ++entry)
        if (retained[entry] != EolRetention::Firm) released.push_back(state.eol[entry].vertex_id);
    return released;
}

}  // namespace arris
