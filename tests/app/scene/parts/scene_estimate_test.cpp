// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_estimate.h"

#include <gtest/gtest.h>

#include "app/run/timeline.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/scene_load.h"

namespace arris {
namespace {

ClothGrid grid(int nu, int nv, GridPattern pattern)
{
    ClothGrid result;
    result.resolution = {nu, nv};
    result.pattern = pattern;
    return result;
}

TEST(SceneEstimate, CountsRegularGridsExactly)
{
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross})
        for (const auto& [nu, nv] : {std::pair(1, 1), std::pair(7, 3), std::pair(2, 20)}) {
            const SceneEstimate estimate = to_estimate(estimate_cloth_grid(grid(nu, nv, pattern)));
            const ClothMesh mesh = make_cloth_grid(grid(nu, nv, pattern));
            EXPECT_EQ(estimate.vertices, mesh.vertex_count());
            EXPECT_EQ(estimate.faces, mesh.face_count());
        }
}

TEST(SceneEstimate, IsNearForUnstructuredAndTurnedGrids)
{
    constexpr double kShare = 0.3;  // of the count: what an estimate may be off
    ClothGrid turned = grid(30, 20, GridPattern::Cross);
    turned.size = Vec2(1.5, 1.0);
    ClothGrid unstructured = turned;
    turned.pattern_angle = 30.0;
    unstructured.pattern = GridPattern::Unstructured;
    for (const ClothGrid& any : {turned, unstructured}) {
        const SceneEstimate estimate = to_estimate(estimate_cloth_grid(any));
        const double vertices = make_cloth_grid(any).vertex_count();
        EXPECT_NEAR(estimate.vertices, vertices, kShare * vertices);
    }
}

TEST(SceneEstimate, SurvivesGridsBeyondEveryInteger)
{
    const SceneEstimate estimate =
        to_estimate(estimate_cloth_grid(grid(5'000'000, 5'000'000, GridPattern::Cross)));
    EXPECT_GT(estimate.vertices, 4.9e13);
}

TEST(CountFrames, IncludesBothEnds)
{
    EXPECT_EQ(count_frames(1.0, 24.0), 25.0);
    EXPECT_EQ(count_frames(0.99, 24.0), 24.0);
    EXPECT_EQ(count_frames(0.1 + 0.2, 10.0), 4.0);
    EXPECT_EQ(count_frames(0.01, 24.0), 1.0);
    EXPECT_EQ(count_frames(1.0, 0.0), 0.0);
    EXPECT_EQ(count_frames(1e6, 1e6), 1e12 + 1.0);
}

TEST(CountSteps, DividesEveryIntervalEqually)
{
    EXPECT_EQ(count_steps(0.1 + 0.2, 0.1, 0.0, {}), 3.0);  // longer than three steps by rounding alone
    EXPECT_EQ(count_steps(1.0, 0.3, 0.0, {}), 4.0);
    EXPECT_EQ(count_steps(1.0, 0.005, 24.0, {}), 24.0 * 9.0);
    EXPECT_EQ(count_steps(1.0, 1e3, 10.0, {}), 10.0);
    EXPECT_EQ(count_steps(1.0, 0.1, 0.0, {0.25}), 3.0 + 8.0);
    EXPECT_EQ(count_steps(1.0, 0.1, 0.0, {0.25, 2.0}), 3.0 + 8.0);  // beyond the end
    EXPECT_EQ(count_steps(1.0, 0.25, 4.0, {0.25, 0.5}), 4.0);       // on frames
}

TEST(CountSteps, IsWhatTheTimelinePlans)
{
    const std::string text =
        "duration = 0.83\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[time]\nstep = 0.007\n"
        "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nrelease = 0.31\nkeyframes = [ { time = 0.1 }, { time = 0.25 } "
        "]\n"
        "[[pull]]\nmaterial = [[1, 0], [1, 1]]\nforce = [0, 0, 1]\nstart = 0.125\nstop = 0.5\n";
    for (const std::string fps : {"0", "1", "24", "29.97", "200"}) {
        const RunConfig config = load_scene(SceneSource{"s.toml", text, {"output.frames_per_second=" + fps}});
        const Timeline timeline(config);
        double planned = 0.0;
        for (TimelinePosition at; !timeline.is_over(at); at = timeline.next(at)) planned += 1.0;
        const double frames_per_second = config.output.frames_per_second;
        EXPECT_EQ(count_steps(config.duration, 0.007, frames_per_second, input_jumps(config.scene)), planned)
            << fps;
        EXPECT_EQ(count_frames(config.duration, frames_per_second), timeline.frame_count()) << fps;
    }
}

TEST(SceneEstimate, RefusesMoreMemoryThanThereIs)
{
    SceneEstimate estimate;
    estimate.vertices = 4e6;
    estimate_bytes({}, estimate);
    EXPECT_FALSE(find_memory_excess(estimate, estimate.memory_bytes));
    const auto excess = find_memory_excess(estimate, 2e9);
    ASSERT_TRUE(excess);
    EXPECT_EQ(excess->wrong, "the run would take about " + human_bytes(estimate.memory_bytes) +
                                 " of memory for 4000000 vertices");
    EXPECT_EQ(excess->allowed, "at most the 2 GB of this machine");
    EXPECT_GT(machine_memory_bytes(), 1e8);
}

TEST(SceneEstimate, CountsEveryFormatOnDisk)
{
    SceneEstimate estimate;
    estimate.vertices = 1000.0;
    estimate.faces = 2000.0;
    estimate.frames = 10.0;
    estimate_bytes({}, estimate);
    const double frames_alone = estimate.disk_bytes;
    EXPECT_GE(frames_alone, 10.0 * (1000.0 * 94.0 + 2000.0 * 37.0));
    for (const char* format : {"obj", "usd", "viewer", "vtk"}) {
        estimate_bytes({format}, estimate);
        EXPECT_GT(estimate.disk_bytes, frames_alone) << format;
    }
}

TEST(SceneEstimate, CountsObstaclesOnceOrInEveryFrameIfTheyMove)
{
    const auto estimate = [](const std::string& motion) {
        const RunConfig config = load_scene(
            SceneSource{"s.toml",
                        "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[[obstacle]]\nbox = "
                        "[1, 1, 1]\ntranslate = [0, 0, 9]\n" +
                            motion + "[[obstacle]]\nwire = [[0, 0, 9], [1, 0, 9], [2, 0, 9]]\n",
                        {}});
        SceneEstimate result;
        result.frames = 25.0;
        add_obstacles(config.scene.obstacles, result);
        return result;
    };
    SceneEstimate resting = estimate(""), moving = estimate("motion = { velocity = [0, 0, 1] }\n");
    EXPECT_EQ(resting.obstacle_elements, 14.0);
    EXPECT_EQ(resting.moving_elements, 0.0);
    EXPECT_EQ(moving.moving_elements, 12.0);
    estimate_bytes({"obj"}, resting);
    estimate_bytes({"obj"}, moving);
    EXPECT_GT(moving.disk_bytes, resting.disk_bytes + 24 * 12 * 20.0);  // 20: no line is shorter
    EXPECT_EQ(moving.memory_bytes, resting.memory_bytes);
}

TEST(HumanBytes, KeepsThreeDigits)
{
    EXPECT_EQ(human_bytes(0.0), "0 B");
    EXPECT_EQ(human_bytes(999.0), "999 B");
    EXPECT_EQ(human_bytes(1234.0), "1.23 kB");
    EXPECT_EQ(human_bytes(25.3e9), "25.3 GB");
    EXPECT_EQ(human_bytes(999.9e6), "1 GB");
}

}  // namespace
}  // namespace arris
