// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/buckling_seed.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "geometry/tolerances.h"
#include "physics/forces/membrane.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/plane_stars.h"

namespace arris {

namespace {

// Deviation from the plane in one step, relative to the longest edge at a vertex. Raising it lets cloth fold
// a few steps earlier, as deviations grow exponentially. Must be well above kComputed, up to which cloth
// counts as exactly plane: beyond, a deviation grows without a seed.
constexpr double kSeed = 1e-10;

// Share of the deviation that differs from vertex to vertex, so that free cloth is bent and not just moved.
// All deviations have one sign: where an obstacle meets cloth edge-on, the cloth then passes on one side.
// With signs at random it hooked onto a rod that meets a hanging sheet, in three of five runs.
constexpr double kVariation = 0.5;

// Least compressive tension that is seeded, as a share of Young's modulus: a strain of 0.1 %, which costs
// little energy. Plane cloth in tension stays below: 0.07 % in the statics of a hanging sheet, 0.002 % in
// data/scenes.
constexpr double kLeastCompression = 1e-3;

/// 1 for each vertex of a compressed face; empty where no face is compressed.
std::vector<char> mark_compressed(const Materials& materials, const ClothMesh& mesh,
                                  const std::vector<Vec2>& stretches)
{
    std::vector<char> is_compressed;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Material& material = materials.at(mesh.corners(f)[0]);
        const double least = principal_tensions(stretches[f], material).minCoeff();
        if (!(least < -kLeastCompression * material.youngs_modulus)) continue;
        is_compressed.resize(mesh.world.size(), 0);
        for (const int v : mesh.faces[f]) is_compressed[v] = 1;
    }
    return is_compressed;
}

/// Finds normals of vertices around which the cloth is plane, now and after a further step like the last, and
/// on which nothing acts across it.
class UnloadedNormals {
  public:
    UnloadedNormals(const Scene& scene, const State& state, const VertexFaces& stars, double dt,
                    const std::vector<Contact>& contacts)
        : scene_(scene), state_(state), stars_(stars), dt_(dt), contacts_(contacts)
    {
    }

    std::optional<Vec3> operator()(int v)
    {
        const std::optional<Vec3> normal =
            find_plane_normal(v, state_.mesh.faces, stars_, state_.mesh.world, kComputed);
        return normal && !is_loaded(v, *normal) && stays_plane(v) ? normal : std::nullopt;
    }

  private:
    bool is_loaded(int v, const Vec3& normal)
    {
        if (scene_.gravity) {
            const Vec3& g = scene_.gravity->acceleration;
            if (std::abs(g.dot(normal)) > kLevel * g.norm()) return true;
        }
        if (state_.eol_entry(state_.ids[v]) >= 0) return true;
        if (!pressing_) find_pressing();
        const auto [begin, end] = pressing_->equal_range(v);
        return std::any_of(
            begin, end, [&](const auto& pressing) { return std::abs(pressing.second.dot(normal)) > kLevel; });
    }

    void find_pressing()
    {
        pressing_.emplace();
        for (const Contact& contact : contacts_) {
            if (!contact.was_active() || contact.is_with_itself()) continue;
            for (const int v : contact.vertices)
                if (v >= 0) pressing_->emplace(v, contact.normal);
        }
    }

    bool stays_plane(int v)
    {
        if (moved_.empty()) {
            moved_ = state_.mesh.world;
            for (std::size_t w = 0; w < moved_.size(); ++w) moved_[w] += dt_ * state_.velocity[w];
        }
        return find_plane_normal(v, state_.mesh.faces, stars_, moved_, kComputed).has_value();
    }

    const Scene& scene_;
    const State& state_;
    const VertexFaces& stars_;
    double dt_;  ///< s
    const std::vector<Contact>& contacts_;

    // Computed when first needed.
    std::optional<std::multimap<int, Vec3>> pressing_;  ///< normals of contacts that pressed, by vertex
    std::vector<Vec3> moved_;                           ///< m
};

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

void seed_buckling(const Scene& scene, const State& state, MeshCache& mesh,
                   const std::vector<Contact>& contacts, Prediction& prediction)
{
    const std::vector<char> is_compressed =
        mark_compressed(scene.materials, state.mesh, find_stretches(state, mesh));
    if (is_compressed.empty()) return;
    const VertexFaces& stars = mesh.stars.faces;
    UnloadedNormals find_normal(scene, state, stars, prediction.gamma, contacts);
    PlaneStars plane(state.mesh.faces, stars, state.mesh.vertex_count(), std::ref(find_normal));
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
        if (!is_compressed[v] || !plane.is_plane_around(v)) continue;
        const double deviation =
            kSeed * longest_edge(state, stars[v], v) * (1.0 + kVariation * draw(state.ids[v]));
        prediction.velocity[v] += deviation / prediction.gamma * *plane.normal(v);
    }
}

}  // namespace arris
