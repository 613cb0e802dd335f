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

/// sum A F^T (v_obs - w) of the faces around a vertex, in the material of its first point.
Vec2 find_lag(const Scene& scene, const State& state, const ClothStars& stars, int v, std::int32_t obstacle)
{
    const std::vector<Vec3>& x = state.mesh.world;
    Vec2 lag = Vec2::Zero();
    for (const int f : stars.faces[v]) {
        const auto& [a, b, c] = state.mesh.faces[f];
        if (!((x[b] - x[a]).cross(x[c] - x[a]).norm() > 0.0)) continue;  // as in look_around
        const std::array<Vec2, 3> X = state.mesh.corners(f);
        const Mat32 F = deformation_gradient(X, {x[a], x[b], x[c]});
        Vec3 mean = Vec3::Zero();  // of v_obs - w
        for (const int k : {a, b, c})
            mean += (scene.obstacles[obstacle].velocity_after(state.time, x[k]) - state.velocity[k] +
                     F * state.material_velocity[state.mesh.point_of(k, f)]) /
                    3.0;
        const Vec2 part = 0.5 * twice_area(X) * F.transpose() * mean;
        const int point = state.mesh.point_of(v, f);
        lag += point == v ? part : Vec2(find_turn(state.mesh, stars, point).transpose() * part);
    }
    return lag;
}

Vec2 finite_or_zero(const Vec2& flow)
{
    return flow.allFinite() ? flow : Vec2(Vec2::Zero());
}

/// Unit material direction of the cloth's border through a site on it, at the first point of `near`, an end
/// of its edge.
Vec2 border_through(const ClothMesh& mesh, const ClothStars& stars, const FeatureSite& site, int near)
{
    const int other = site.edge[0] == near ? site.edge[1] : site.edge[0];
    auto [from, to] = stars.border_neighbours[near];
    if (other != near) {
        if (mesh.vertex_of(to) != other) to = from;
        from = near;
    }
    return (mesh.material[to] - mesh.material[from]).normalized();
}

}  // namespace

Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars,
                       const FeatureSite& site)
{
    const int v = state.index_of(site.near);
    const Star star = look_around(state.mesh, stars, v, state.mesh.world);
    const Mat2 inverse = star.squared_F.inverse();
    const Vec2 flow = inverse * find_lag(scene, state, stars, v, site.on.obstacle);
    if (site.on.is_fixed()) return finite_or_zero(flow);
    const ObstaclePose obstacle = scene.obstacles[site.on.obstacle].at(state.time);
    const auto [from, to] = feature_segment(obstacle, site.on.index);
    const Vec3 tangent = obstacle.placement.rotation * (to - from);
    const Vec2 trace = (inverse * (star.F_transposed * tangent)).normalized();  // F maps it near `tangent`
    const Vec2 across(trace.y(), -trace.x());
    const Vec2 way = site.is_on_border ? border_through(state.mesh, stars, site, v) : across;
    const Vec2 sliding = finite_or_zero(across.dot(flow) / across.dot(way) * way);
    const int point = find_point_beside(state.mesh, stars, v, site.material);
    return point == v ? sliding : Vec2(find_turn(state.mesh, stars, point) * sliding);
}

}  // namespace arris
