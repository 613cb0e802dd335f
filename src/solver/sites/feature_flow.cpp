// SPDX-License-Identifier: GPL-3.0-or-later
//
// A point that rests on the obstacle has material velocity V where F V + w = v_obs, w the velocity of the
// cloth's material there. Over several faces V is the least-squares solution, weighted by area:
//
//     (sum A F^T F) V = sum A F^T (v_obs - w)
#include "solver/sites/feature_flow.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "geometry/obstacle/feature_path.h"
#include "physics/elements/deformation_gradient.h"

namespace arris {

namespace {

/// sum A F^T (v_obs - w) of the faces around a vertex.
Vec2 find_lag(const Scene& scene, const State& state, const ClothStars& stars, int v, std::int32_t obstacle)
{
    const std::vector<Vec2>& X = state.mesh.material;
    const std::vector<Vec3>& x = state.mesh.world;
    Vec2 lag = Vec2::Zero();
    for (const int f : stars.faces[v]) {
        const auto& [a, b, c] = state.mesh.faces[f];
        if (!((x[b] - x[a]).cross(x[c] - x[a]).norm() > 0.0)) continue;  // as in look_around
        const Mat32 F = deformation_gradient({X[a], X[b], X[c]}, {x[a], x[b], x[c]});
        Vec3 mean = Vec3::Zero();  // of v_obs - w
        for (const int k : {a, b, c})
            mean += (scene.obstacles[obstacle].velocity_after(state.time, x[k]) - state.velocity[k] +
                     F * state.material_velocity[k]) /
                    3.0;
        lag += 0.5 * twice_area(X[a], X[b], X[c]) * F.transpose() * mean;
    }
    return lag;
}

Vec2 finite_or_zero(const Vec2& flow)
{
    return flow.allFinite() ? flow : Vec2(Vec2::Zero());
}

/// Unit material direction of the cloth's border through a site on the border.
Vec2 border_through(const State& state, const ClothStars& stars, const FeatureSite& site)
{
    const auto& [a, b] = site.edge;
    const auto [from, to] = a == b ? stars.border_neighbours[a] : site.edge;
    return (state.mesh.material[to] - state.mesh.material[from]).normalized();
}

}  // namespace

Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars,
                       const FeatureSite& site)
{
    const int v = state.index_of(site.near);
    const Star star = look_around(state.mesh, stars.faces[v], v, state.mesh.world);
    const Mat2 inverse = star.squared_F.inverse();
    const Vec2 flow = inverse * find_lag(scene, state, stars, v, site.on.obstacle);
    if (site.on.is_fixed()) return finite_or_zero(flow);
    const ObstaclePose obstacle = scene.obstacles[site.on.obstacle].at(state.time);
    const auto [from, to] = feature_segment(obstacle, site.on.index);
    const Vec3 tangent = obstacle.placement.rotation * (to - from);
    const Vec2 trace = (inverse * (star.F_transposed * tangent)).normalized();  // F maps it near `tangent`
    const Vec2 across(trace.y(), -trace.x());
    const Vec2 way = site.is_on_border ? border_through(state, stars, site) : across;
    return finite_or_zero(across.dot(flow) / across.dot(way) * way);
}

}  // namespace arris
