// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/gathering.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/tolerances.h"
#include "solver/eol/eol_features.h"
#include "solver/model/hysteresis.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

const double kGathered = std::log(20.0);

/// Material area at a vertex, m^2: a third of its faces'.
double area_at(const State& state, const ClothStars& stars, int v)
{
    double area = 0.0;
    for (const int f : stars.faces[v]) area += twice_area(state.mesh.corners(f)) / 6.0;
    return area;
}

/// Force with which obstacles pressed on a vertex in the last step, N.
double force_on(const State& state, int v)
{
    if (!(state.previous_dt > 0.0)) return 0.0;
    const std::uint32_t id = state.ids[v];
    auto at = std::lower_bound(
        state.active.begin(), state.active.end(), id,
        [](const ActiveContact& contact, std::uint32_t wanted) { return contact.vertex_ids[0] < wanted; });
    double sum = 0.0;
    for (; at != state.active.end() && at->vertex_ids[0] == id; ++at)
        if (at->kind == ContactKind::Vertex && at->obstacle != kClothItself) sum += at->multiplier;
    return sum / state.previous_dt;
}

/// Growth rate, 1/s, of the pleat that grows fastest; negative where none pays. `strain`: compression.
double find_growth_rate(const Scene& scene, const State& state, const ClothStars& stars, int v, double strain)
{
    const Material& material = scene.materials.at(state.mesh.material[v]);
    const double e = std::max(strain, kComputed), area = area_at(state, stars, v);
    const double weight = scene.gravity ? material.density * area * scene.gravity->acceleration.norm() : 0.0;
    const double force = std::max(force_on(state, v), weight);
    const double cell = target_length(scene, state, state.mesh.material[v]);
    double fastest = -std::numeric_limits<double>::infinity();
    for (const double q : {std::numbers::pi / cell, 0.5 * std::numbers::pi / cell}) {
        const double drive = 0.5 * material.youngs_modulus * e - plate_rigidity(material) * q * q -
                             2.0 * force / (area * q * std::sqrt(e));
        const double rate = q * std::sqrt(2.0 * std::abs(drive) / material.density);
        fastest = std::max(fastest, drive > 0.0 ? rate : -rate);
    }
    return fastest;
}

/// Compression of the cloth along each EOL vertex's trace edges; 0 where it has none, and at corners, around
/// which the cloth is compressed across its edges, too, which its flaps take up.
std::vector<double> find_trace_compressions(const Scene& scene, const State& state, const ClothStars& stars)
{
    std::vector<double> world(state.eol.size(), 0.0), material(state.eol.size(), 0.0);  // lengths, m
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        const int v = state.index_of(state.eol[a].vertex_id), w = state.index_of(state.eol[b].vertex_id);
        for (const int entry : {a, b}) {
            world[entry] += (state.mesh.world[v] - state.mesh.world[w]).norm();
            material[entry] += material_length(state.mesh, stars, v, w);
        }
    }
    std::vector<double> compressions(state.eol.size(), 0.0);
    for (std::size_t entry = 0; entry < state.eol.size(); ++entry)
        if (material[entry] > 0.0 && !state.eol[entry].on.is_corner())
            compressions[entry] = 1.0 - world[entry] / material[entry];
    return compressions;
}

}  // namespace

void grow_gathering(const Scene& scene, const ClothStars& stars, double dt, State& state)
{
    if (!scene.eol || state.eol.empty()) return;
    const std::vector<double> on_trace = find_trace_compressions(scene, state, stars);
    for (std::size_t entry = 0; entry < state.eol.size(); ++entry) {
        EolVertex& vertex = state.eol[entry];
        const int v = state.index_of(vertex.vertex_id);
        const double growth = dt * find_growth_rate(scene, state, stars, v, on_trace[entry]);
        vertex.gathering = std::clamp(vertex.gathering + growth, 0.0, kGathered);
    }
}

bool has_gathered(const EolVertex& vertex)
{
    return vertex.gathering >= kGathered;
}

bool is_near_gathering(const Scene& scene, const State& state, const ClothStars& stars, int v,
                       const Vec3& tangent)
{
    const Star star = look_around(state.mesh, stars, v, state.mesh.world);
    if (!(star.squared_F.determinant() > 0.0)) return false;
    // The material direction that maps onto the tangent, as nearly as the faces agree.
    const Vec2 direction = star.squared_F.inverse() * (star.F_transposed * tangent);
    if (!(direction.norm() > 0.0)) return false;
    return find_growth_rate(scene, state, stars, v, (1.0 - 1.0 / direction.norm()) / kStayRatio) > 0.0;
}

}  // namespace arris
