// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sewing/welding.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_pieces.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sewing.h"
#include "geometry/self_contact/self_intersection.h"
#include "geometry/self_contact/self_sweep.h"
#include "physics/elements/cloth_elements.h"
#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "solver/sewing/seam_springs.h"

namespace arris {
namespace {

/// The pairs of a seam, as vertices.
std::vector<std::array<int, 2>> pairs_of(const State& state, int seam)
{
    std::vector<std::array<int, 2>> pairs;
    for (const SeamPair& pair : state.seam_pairs)
        if (pair.seam == seam)
            pairs.push_back({state.index_of(pair.vertex_ids[0]), state.index_of(pair.vertex_ids[1])});
    return pairs;
}

/// Moves the vertices that become one to their centre of mass, with its velocity.
void bring_together(const std::vector<int>& vertex_of, const std::vector<double>& mass, State& state)
{
    std::vector<double> sum(mass.size(), 0.0);
    std::vector<Vec3> place(mass.size(), Vec3::Zero()), momentum = place;
    std::vector<int> count(mass.size(), 0);
    for (std::size_t v = 0; v < mass.size(); ++v) {
        const auto w = static_cast<std::size_t>(vertex_of[v]);
        sum[w] += mass[v];
        place[w] += mass[v] * state.mesh.world[v];
        momentum[w] += mass[v] * state.velocity[v];
        ++count[w];
    }
    for (std::size_t v = 0; v < mass.size(); ++v) {
        const auto w = static_cast<std::size_t>(vertex_of[v]);
        if (count[w] == 1) continue;
        state.mesh.world[v] = place[w] / sum[w];
        state.velocity[v] = momentum[w] / sum[w];
    }
}

/// Whether cloth that moves from `before` to `after` passes through nothing but the seam itself.
bool is_free(const Scene& scene, const State& before, const State& after)
{
    const MeshTopology topology = make_topology(before.mesh.vertex_count(), before.mesh.faces);
    for (const MovingObstacle& obstacle : scene.obstacles) {
        const ObstaclePose pose = obstacle.at(before.time);
        const ClothMotion motion = {&before.mesh.faces, &topology.edges,
                                    to_local(pose.placement, before.mesh.world),
                                    to_local(pose.placement, after.mesh.world)};
        if (!check_sweep(*pose.shape, motion, scene.materials.thickness()).is_clean()) return false;
    }
    if (!scene.self_contact) return true;
    SelfSurface surface(before.mesh.vertex_count(), before.mesh.faces, topology);
    surface.joined = number_joined(before);
    const auto are_joined = [&](SelfContactKind kind, int first, int second) {  // will be no pair
        return kind == SelfContactKind::VertexFace ? surface.joins(vertex_and_face(surface, first, second), 1)
                                                   : surface.joins(two_edges(surface, first, second), 2);
    };
    return check_self_sweep(surface, {before.mesh.world, after.mesh.world}, scene.self_contact->thickness,
                            are_joined)
        .is_clean();
}

/// The points of a state by their ids, ascending.
struct Points {
    std::vector<int> order;      ///< points of the state's mesh
    std::vector<int> vertex_of;  ///< vertex of each, before

    explicit Points(const State& state) : order(state.mesh.material.size())
    {
        const auto id = [&](int p) {
            const int n = state.mesh.vertex_count();
            return p < n ? state.ids[static_cast<std::size_t>(p)]
                         : state.seam_ids[static_cast<std::size_t>(p - n)];
        };
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](int p, int q) { return id(p) < id(q); });
        for (const int p : order) {
            vertex_of.push_back(state.mesh.vertex_of(p));
            ids.push_back(id(p));
        }
    }

    std::vector<std::uint32_t> ids;
};

/// The state with vertices joined into one. Vertices that become one must be at one place.
State join_vertices(const State& state, const std::vector<std::array<int, 2>>& pairs)
{
    const Points points(state);
    const int count = static_cast<int>(points.order.size());
    std::vector<int> first_of(state.mesh.world.size(), -1), name(points.order.size());
    std::vector<std::array<int, 2>> same;
    ClothMesh parts;
    for (int k = 0; k < count; ++k) {
        name[static_cast<std::size_t>(points.order[static_cast<std::size_t>(k)])] = k;
        const auto v = static_cast<std::size_t>(points.vertex_of[static_cast<std::size_t>(k)]);
        if (first_of[v] < 0)
            first_of[v] = k;
        else
            same.push_back({first_of[v], k});
        parts.material.push_back(
            state.mesh.material[static_cast<std::size_t>(points.order[static_cast<std::size_t>(k)])]);
        parts.world.push_back(state.mesh.world[v]);
    }
    for (const auto& [v, w] : pairs)
        same.push_back({first_of[static_cast<std::size_t>(v)], first_of[static_cast<std::size_t>(w)]});
    for (int f = 0; f < state.mesh.face_count(); ++f) {
        Face face = state.mesh.points_of(f);
        for (int& p : face) p = name[static_cast<std::size_t>(p)];
        parts.faces.push_back(face);
    }
    const std::vector<int> vertex_of = number_vertices(count, same);

    // As `sew` orders points: the first of each vertex, then the others.
    std::vector<int> first, further;
    for (int k = 0; k < count; ++k)
        (vertex_of[static_cast<std::size_t>(k)] == static_cast<int>(first.size()) ? first : further)
            .push_back(k);
    State joined = state;
    joined.mesh = sew(std::move(parts), vertex_of);
    const auto keep = [&](auto& values, const std::vector<Vec3>& old) {
        values.clear();
        for (const int k : first)
            values.push_back(old[static_cast<std::size_t>(points.vertex_of[static_cast<std::size_t>(k)])]);
    };
    keep(joined.velocity, state.velocity);
    keep(joined.previous_world, state.previous_world);
    keep(joined.previous_velocity, state.previous_velocity);
    joined.ids.clear();
    joined.seam_ids.clear();
    for (const int k : first) joined.ids.push_back(points.ids[static_cast<std::size_t>(k)]);
    for (const int k : further) joined.seam_ids.push_back(points.ids[static_cast<std::size_t>(k)]);
    std::vector<int> all = first;
    all.insert(all.end(), further.begin(), further.end());
    for (auto [to, from] :
         {std::pair(&joined.material_velocity, &state.material_velocity),
          std::pair(&joined.previous_material, &state.previous_material),
          std::pair(&joined.previous_material_velocity, &state.previous_material_velocity)}) {
        to->clear();
        for (const int k : all)
            to->push_back((*from)[static_cast<std::size_t>(points.order[static_cast<std::size_t>(k)])]);
    }

    // Pairs and anchors name vertices by their ids.
    const auto rename = [&](std::uint32_t& id) {
        const int v = state.index_of(id);
        if (v >= 0)
            id = joined.ids[static_cast<std::size_t>(
                vertex_of[static_cast<std::size_t>(first_of[static_cast<std::size_t>(v)])])];
    };
    for (SeamPair& pair : joined.seam_pairs)
        for (std::uint32_t& id : pair.vertex_ids) rename(id);
    std::erase_if(joined.seam_pairs,
                  [](const SeamPair& pair) { return pair.vertex_ids[0] == pair.vertex_ids[1]; });
    for (PinAnchor& anchor : joined.anchors) rename(anchor.vertex_id);
    const auto by_pin = [](const PinAnchor& a, const PinAnchor& b) {
        return std::pair(a.pin, a.vertex_id) < std::pair(b.pin, b.vertex_id);
    };
    std::stable_sort(joined.anchors.begin(), joined.anchors.end(), by_pin);
    joined.anchors.erase(std::unique(joined.anchors.begin(), joined.anchors.end(),
                                     [](const PinAnchor& a, const PinAnchor& b) {
                                         return a.pin == b.pin && a.vertex_id == b.vertex_id;
                                     }),
                         joined.anchors.end());
    // Guesses of the next step and the order of its unknowns: it finds them anew.
    joined.active.clear();
    joined.refused_edges.clear();
    joined.coupled.clear();
    joined.previous_dt = 0.0;
    return joined;
}

/// Vertices of the connected parts of the cloth that hold some of them.
std::vector<char> find_piece(const State& state, const std::vector<int>& some)
{
    const std::vector<int> piece = label_pieces(state.mesh.vertex_count(), state.mesh.faces);
    std::vector<char> is_of_piece(piece.size(), 0), is_in(piece.size(), 0);
    for (const int v : some) is_of_piece[static_cast<std::size_t>(piece[static_cast<std::size_t>(v)])] = 1;
    for (std::size_t v = 0; v < piece.size(); ++v) is_in[v] = is_of_piece[static_cast<std::size_t>(piece[v])];
    return is_in;
}

ClothElements elements_of(const Scene& scene, const State& state)
{
    ClothElements elements =
        list_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces), HingeUse::Terms,
                      scene.materials);
    elements.springs = list_springs(scene, state);
    return elements;
}

/// Turns the velocities of vertices about their centre of mass so that the cloth's angular momentum becomes
/// `wanted`, N m s.
void turn(const Scene& scene, const ClothElements& elements, const std::vector<char>& is_in,
          const Vec3& wanted, State& state)
{
    const std::vector<double> mass = lump_masses(scene.materials, elements);
    double total = 0.0;
    Vec3 centre = Vec3::Zero();
    for (std::size_t v = 0; v < mass.size(); ++v)
        if (is_in[v]) {
            total += mass[v];
            centre += mass[v] * state.mesh.world[v];
        }
    centre /= total;
    const auto momentum_of = [&](const std::vector<Vec3>& velocity) {
        return angular_momentum(scene.materials, elements, state.mesh.world, velocity);
    };
    Mat3 inertia;  // column k: of a rotation about axis k
    for (int k = 0; k < 3; ++k) {
        std::vector<Vec3> velocity(mass.size(), Vec3::Zero());
        for (std::size_t v = 0; v < mass.size(); ++v)
            if (is_in[v]) velocity[v] = Vec3::Unit(k).cross(state.mesh.world[v] - centre);
        inertia.col(k) = momentum_of(velocity);
    }
    const Vec3 rate = inertia.ldlt().solve(wanted - momentum_of(state.velocity));
    if (!rate.allFinite()) return;
    for (std::size_t v = 0; v < mass.size(); ++v)
        if (is_in[v]) state.velocity[v] += rate.cross(state.mesh.world[v] - centre);
}

}  // namespace

bool weld(const Scene& scene, int seam, State& state)
{
    const std::vector<std::array<int, 2>> pairs = pairs_of(state, seam);
    const ClothElements before = elements_of(scene, state);
    const std::vector<double> mass = lump_masses(scene.materials, before);
    State moved = state;
    bring_together(number_vertices(state.mesh.vertex_count(), pairs), mass, moved);
    if (!is_free(scene, state, moved)) return false;
    State joined = join_vertices(moved, pairs);
    if (!validate(joined.mesh).empty()) return false;
    std::vector<char> is_at_seam(state.mesh.world.size(), 0);
    for (const auto& pair : pairs)
        for (const int v : pair) is_at_seam[static_cast<std::size_t>(v)] = 1;
    std::vector<int> around;
    for (int f = 0; f < state.mesh.face_count(); ++f)
        for (const int v : state.mesh.faces[f])
            if (is_at_seam[static_cast<std::size_t>(v)] && (around.empty() || around.back() != f))
                around.push_back(f);
    if (scene.self_contact && !find_self_intersections(joined.mesh.world, joined.mesh.faces, around).empty())
        return false;

    const ClothElements after = elements_of(scene, joined);
    std::vector<int> sewn;
    for (const auto& pair : pairs)
        for (const int v : pair)
            if (const int u = joined.index_of(state.ids[static_cast<std::size_t>(v)]); u >= 0)
                sewn.push_back(u);
    turn(scene, after, find_piece(joined, sewn),
         angular_momentum(scene.materials, before, state.mesh.world, state.velocity), joined);
    const Terms terms = make_terms(scene.materials, scene.gravity, {}, {}, true);
    const auto energy = [&](const ClothElements& elements, const State& of) {
        return compute_energies(elements, terms, of.mesh.world).sum() +
               kinetic_energy(scene.materials, elements, of.velocity);
    };
    joined.sewn_energy += energy(before, state) - energy(after, joined);
    state = std::move(joined);
    return true;
}

}  // namespace arris
