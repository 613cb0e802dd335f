// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/state_readings.h"

#include <gtest/gtest.h>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/step.h"

namespace arris {
namespace {

TEST(Probes, ReadTheMaterialsVelocityWhereItFlowsThroughAVertexAtRest)
{
    // A sheet that slides at 0.7 m/s, two times stretched along its way, through the vertex in its middle.
    const Vec3 velocity(0.7, 0.0, 0.1);
    ClothGrid grid;
    grid.resolution = {4, 4};
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x.x() *= 2.0;
    State state = make_state(Scene{}, mesh, velocity);
    int middle = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if ((mesh.material[v] - Vec2(0.5, 0.5)).norm() < 1e-9) middle = v;
    state.velocity[middle] = Vec3(0.0, 0.0, 0.1);
    state.material_velocity[middle] = Vec2(-0.35, 0.0);
    for (const Vec2& X : {Vec2(0.5, 0.5), Vec2(0.55, 0.45), Vec2(0.1, 0.9)}) {
        Probe probe;
        probe.material = X;
        const std::vector<ProbeSample> samples = sample_probes({probe}, state);
        ASSERT_EQ(samples.size(), 1u);
        EXPECT_LT((samples[0].velocity - velocity).norm(), 1e-12) << X.transpose();
    }
}

TEST(Frames, MarkWhatAnObstacleOrALayerPressesAndNoPlaneBehindAWire)
{
    ClothGrid grid;
    grid.resolution = {4, 4};
    State state = make_state(Scene{}, make_cloth_grid(grid), Vec3::Zero());
    state.active = {{{2}, ContactKind::Vertex, 0, -1, Vec3::UnitZ(), 1.0},
                    {{3, 8}, ContactKind::Edge, 0, 0, Vec3::UnitZ(), 1.0},
                    {{5}, ContactKind::Vertex, 0, kFoldPlaneElement, Vec3::UnitX(), 1.0},
                    {{10, 11, 12, 13}, ContactKind::Vertex, kClothItself, 0, Vec3::UnitZ(), 1.0}};
    const ClothElements elements =
        make_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces));
    const Frame frame = make_frame({}, state, elements, {});
    for (std::size_t v = 0; v < frame.contact.size(); ++v)
        EXPECT_EQ(frame.contact[v], v == 2 || v == 3 || v == 8 || (v >= 10 && v <= 13)) << v;
}

}  // namespace
}  // namespace arris
