// SPDX-License-Identifier: GPL-3.0-or-later
//
// A point that rests on the obstacle has material velocity V where F V + w = v_obs, w the velocity of the
// cloth's material there. Over several faces that is the least-squares solution, weighted by area:
//
//     (sum A F^T F) V = sum A F^T (v_obs - w)
#include "solver/feature_flow.h"

#include <Eigen/LU>

#include "physics/deformation_gradient.h"

namespace arris {

Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars, int v,
                       std::int32_t obstacle)
{
    const std::vector<Vec2>& X = state.mesh.material;
    const std::vector<Vec3>& x = state.mesh.world;
    Mat2 squared = Mat2::Zero();
    Vec2 sum = Vec2::Zero();
    for (const int f : stars.faces[v]) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const Mat32 F = deformation_gradient({X[a], X[b], X[c]}, {x[a], x[b], x[c]});
        const double area = twice_area(X[a], X[b], X[c]);
        Vec3 lag = Vec3::Zero();  // mean of v_obs - w
        for (const int k : {a, b, c})
            lag += (scene.obstacles[obstacle].velocity_after(state.time, x[k]) - state.velocity[k] +
                    F * state.material_velocity[k]) /
                   3.0;
        squared += area * F.transpose() * F;
        sum += area * F.transpose() * lag;
    }
    const Vec2 flow = squared.inverse() * sum;
    return flow.allFinite() ? flow : Vec2(Vec2::Zero());
}

}  // namespace arris
