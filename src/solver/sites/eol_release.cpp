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
    const Obstacle& obstacle = scene.obstacles[eol.obstacle];
    if (!eol.is_corner) return false;
    const int point = obstacle.features().corners[eol.feature].point;
    return std::any_of(state.active.begin(), state.active.end(), [&](const ActiveContact& contact) {
        return contact.obstacle == eol.obstacle && contact.kind == ContactKind::Triangle &&
               contact.element == point;
    });
}

/// Whether an EOL vertex that has left its edge or wire, through which material flows fast, is led otherwise
/// than what comes to it: it then bends that, with every step. Along a face it is not (free_fold.h).
bool is_led_astray(const Scene& scene, const State& state, const EolVertex& eol, const EolCoordinates& at,
                   const Vec3& place)
{
    constexpr double kAlongFace = 0.15;  // sine
    if (eol.is_corner || !has_left_feature(at.frame.point, place, scene.material.thickness) ||
        !(state.material_velocity[at.vertex].norm() > 0.5 * kFreeFlow))
        return false;
    const Obstacle& obstacle = scene.obstacles[eol.obstacle];
    if (!is_on_convex_edge(obstacle, eol)) return true;
    const std::array<Vec3, 2>& normals = obstacle.features().edges[eol.feature].normals;
    return std::none_of(normals.begin(), normals.end(), [&](const Vec3& normal) {
        return std::abs(normal.dot(at.frame.outward)) < kAlongFace;
    });
}

/// Whether an EOL vertex is still on the polyline that it is on: not at its end.
bool is_on_feature(const Obstacle& obstacle, const EolVertex& vertex, const Vec3& place)
{
    return vertex.is_corner || !is_past_end(obstacle, vertex.feature, place);
}

}  // namespace

EolHold find_hold(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                  const EolCoordinates& at, const Vec3& place)
{
    const EolVertex& eol = state.eol[entry];
    if (eol.idle < kIdleSteps) return EolHold::Firm;
    const double gap = (place - at.frame.point).norm();
    const double cells = is_led_astray(scene, state, eol, at, place) ? kAstrayCells : 1.0;
    if (gap > cells * scene.eol->shortest && gap > cells * scene.eol->length(state.mesh.material[at.vertex]))
        return EolHold::None;
    const bool has_left = gap > kOnFeature * scene.material.thickness;
    if (has_left && is_corner_under_face(scene, state, eol)) return EolHold::None;
    if (is_folded(state, stars.faces[at.vertex])) return EolHold::Firm;
    return has_left ? EolHold::None : EolHold::Loose;
}

void hold_between(const Scene& scene, const State& state, const ClothStars& stars,
                  std::vector<EolHold>& holds)
{
    if (std::find(holds.begin(), holds.end(), EolHold::Loose) == holds.end()) return;
    std::vector<std::vector<int>> beside(holds.size());
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        if (holds[a] == EolHold::None || holds[b] == EolHold::None) continue;
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    // What is left when loose ends are cut off, again and again, lies between.
    std::vector<int> open;
    for (std::size_t entry = 0; entry < holds.size(); ++entry) open.push_back(static_cast<int>(entry));
    while (!open.empty()) {
        const int at = open.back();
        open.pop_back();
        if (holds[at] != EolHold::Loose || beside[at].size() > 1) continue;
        holds[at] = EolHold::None;
        for (const int next : beside[at]) {
            std::erase(beside[next], at);
            open.push_back(next);
        }
    }
    for (EolHold& hold : holds)
        if (hold == EolHold::Loose) hold = EolHold::Firm;
}

bool is_at_border(const Scene& scene, const State& state, const ClothStars& stars, const EolVertex& eol)
{
    constexpr double kRoom = 0.15, kCornerRoom = 0.3;  // target lengths to a border ahead
    const int v = state.index_of(eol.vertex_id);
    const Vec2& X = state.mesh.material[v];
    const double wanted = eol.is_corner ? kCornerRoom : kRoom;
    const double room = room_to_border(scene, state, stars, X, v, stars.border_neighbours[v][0] >= 0, eol);
    return !(room > wanted * scene.eol->longest) && !(room > wanted * scene.eol->length(X));
}

std::vector<std::uint32_t> find_releases(const Scene& scene, const State& state, const ClothStars& stars)
{
    EolPlacer placer(scene.obstacles, scene.material.thickness, state, stars);
    std::vector<EolHold> holds;
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry) {
        const EolVertex& eol = state.eol[entry];
        const Obstacle& obstacle = scene.obstacles[eol.obstacle];
        holds.push_back(EolHold::None);
        const Vec3 place = obstacle.at(state.time).inverse(state.mesh.world[state.index_of(eol.vertex_id)]);
        const EolPlacing placing = placer.place(entry);
        if (!placing.coordinates || is_at_border(scene, state, stars, eol) ||
            !is_on_feature(obstacle, eol, place))
            continue;
        holds.back() = find_hold(scene, state, stars, entry, *placing.coordinates, place);
    }
    hold_between(scene, state, stars, holds);
    std::vector<std::uint32_t> released;
    for (std::size_t entry = 0; entry < holds.size(); ++entry)
        if (holds[entry] != EolHold::Firm) released.push_back(state.eol[entry].vertex_id);
    return released;
}

}  // namespace arris
