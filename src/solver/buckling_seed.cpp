// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/buckling_seed.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "physics/membrane.h"
#include "solver/plane_stars.h"

namespace arris {

namespace {

// Deviation from the plane in one step, relative to the longest edge at a vertex. Raising it lets cloth fold
// a few steps earlier, as deviations grow exponentially. Round-off of positions is about 1e-15.
constexpr double kSeed = 1e-10;

// Share of the deviation that differs from vertex to vertex, so that free cloth is bent and not just moved.
// All deviations have one sign: where an obstacle meets cloth edge-on, the cloth then passes on one side.
// With signs at random it hooked onto a rod that meets a hanging sheet, in three of five runs.
constexpr double kVariation = 0.5;

// Deviation up to which cloth counts as exactly plane, relative to the same edge. Above it, the deviation
// grows without a seed. Must be well below kSeed.
constexpr double kPlane = 1e-12;

// Least compressive tension that is seeded, as a share of Young's modulus: a strain of 0.1 %, which costs
// little energy. Plane cloth in tension stays below: 0.07 % in the statics of a hanging sheet, 0.002 % in
// data/scenes.
constexpr double kLeastCompression = 1e-3;

// Sine of the angle with the cloth above which gravity or a contact acts across it.
constexpr double kAcross = 1e-6;

/// 1 for each vertex of a compressed face; empty where no face is compressed.
std::vector<char> mark_compressed(const Material& material, const State& state, const ClothElements& elements)
{
    std::vector<char> is_compressed;
    for (const FaceElement& face : elements.faces) {
        const Vec2 stretches = principal_stretches(FaceState(face, state.mesh.world).F);
        const double least =
            principal_tensions(stretches, material.youngs_modulus, material.poisson_ratio).minCoeff();
        if (!(least < -kLeastCompression * material.youngs_modulus)) continue;
        is_compressed.resize(state.mesh.world.size(), 0);
        for (const int v : face.vertices) is_compressed[v] = 1;
    }
    return is_compressed;
}

/// Drops the normals of vertices around which the cloth is no longer plane after a further step like the
/// last.
void drop_bending(const State& state, const VertexFaces& stars, double dt,
                  std::vector<std::optional<Vec3>>& normals)
{
    std::vector<Vec3> moved = state.mesh.world;
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += dt * state.velocity[v];
    const std::vector<std::optional<Vec3>> then = find_plane_stars(state.mesh.faces, stars, moved, kPlane);
    for (std::size_t v = 0; v < normals.size(); ++v)
        if (!then[v]) normals[v].reset();
}

/// Drops the normals of EOL vertices, and of vertices on which gravity or an obstacle acts across the cloth.
void drop_loaded(const Scene& scene, const State& state, const std::vector<Contact>& contacts,
                 std::vector<std::optional<Vec3>>& normals)
{
    if (scene.gravity) {
        const Vec3& g = scene.gravity->acceleration;
        for (std::optional<Vec3>& normal : normals)
            if (normal && std::abs(g.dot(*normal)) > kAcross * g.norm()) normal.reset();
    }
    for (const EolVertex& eol : state.eol) normals[state.index_of(eol.vertex_id)].reset();
    for (const Contact& contact : contacts) {
        if (!contact.was_active()) continue;
        for (const int v : contact.in_frame.vertices)
            if (v >= 0 && normals[v] && std::abs(contact.normal.dot(*normals[v])) > kAcross)
                normals[v].reset();
    }
}

/// A number from -1 to 1 that depends on `id` alone, with mean 0 over many ids (SplitMix64, Steele, Lea and
/// Flood 2014).
double draw(std::uint32_t id)
{
    std::uint64_t z = (static_cast<std::uint64_t>(id) + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return std::ldexp(static_cast<double>(z >> 11), -52) - 1.0;
}

double longest_edge(const State& state, std::span<const int> star, int v)
{
    double squared = 0.0;
    for (const int f : star)
        for (const int w : state.mesh.faces[f])
            squared = std::max(squared, (state.mesh.world[w] - state.mesh.world[v]).squaredNorm());
    return std::sqrt(squared);
}

}  // namespace

void seed_buckling(const Scene& scene, const State& state, const MeshCache& mesh,
                   const std::vector<Contact>& contacts, Prediction& prediction)
{
    const VertexFaces& stars = mesh.stars.faces;
    std::vector<std::optional<Vec3>> normals =
        find_plane_stars(state.mesh.faces, stars, state.mesh.world, kPlane);
    const bool is_any_plane =
        std::any_of(normals.begin(), normals.end(), [](const auto& n) { return n.has_value(); });
    if (!is_any_plane) return;  // nearly all cloth that moves
    const std::vector<char> is_compressed = mark_compressed(scene.material, state, mesh.elements);
    if (is_compressed.empty()) return;
    drop_bending(state, stars, prediction.gamma, normals);
    drop_loaded(scene, state, contacts, normals);
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
        if (!is_compressed[v] || !is_plane_around(v, state.mesh.faces, stars, normals)) continue;
        const double deviation =
            kSeed * longest_edge(state, stars[v], v) * (1.0 + kVariation * draw(state.ids[v]));
        prediction.velocity[v] += deviation / prediction.gamma * *normals[v];
    }
}

}  // namespace arris
