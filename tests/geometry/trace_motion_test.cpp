// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/trace_motion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "geometry/mesh_quality.h"
#include "geometry/surgery_cleanup.h"
#include "geometry/trace_insertion.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

constexpr double kAngle = 15.0;

// Cuts a polyline in; the vertices at its corners. Fails the test where it is refused.
std::vector<VertexId> cut(ClothSurgery& surgery, const MeshTarget& target, const std::vector<Vec2>& line,
                          int tag)
{
    std::vector<VertexId> nodes;
    for (const Vec2& X : line) {
        const TraceInsertion made =
            insert_trace_point(surgery, target, X, nearest_vertex(surgery, X), {TraceRole::Node, tag});
        EXPECT_EQ(made.verdict, Verdict::Done) << to_string(made.verdict) << " at " << X.transpose();
        nodes.push_back(made.vertex);
    }
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const TraceJoin join = join_trace_vertices(surgery, target, nodes[k], nodes[k + 1], tag);
        EXPECT_EQ(join.verdict, Verdict::Done) << to_string(join.verdict);
    }
    return nodes;
}

// All trace vertices of a tag, moved by the same vector.
std::vector<VertexMove> shifted(const ClothSurgery& surgery, int tag, const Vec2& by)
{
    std::vector<VertexMove> moves;
    const SurgeryResult result = surgery.result();
    for (std::size_t k = 0; k < result.ids.size(); ++k)
        if (result.roles[k] != TraceRole::Free && result.tags[k] == tag)
            moves.push_back({result.ids[k], result.mesh.material[k] + by});
    return moves;
}

TEST(MoveTrace, SweptToAndFroHundredTimesKeepsCountAndAngles)
{
    const SurgeryCloth cloth = square_cloth(20, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = uniform_target(1.14 * cloth.cell, kAngle);
    cut(surgery, target, {{0.15, 0.2}, {0.5, 0.27}, {0.85, 0.2}}, 7);
    clean_up(surgery, target);
    int most = 0, steps = 0;
    double least = 180.0;
    for (int sweep = 0; sweep < 100; ++sweep) {
        for (int step = 0; step < 20; ++step, ++steps) {
            const Vec2 by(0.0, (sweep % 2 == 0 ? 1.0 : -1.0) * 0.025);
            const TraceMotionReport report = move_trace(surgery, target, shifted(surgery, 7, by));
            ASSERT_EQ(report.verdict, Verdict::Done) << to_string(report.verdict) << " step " << steps;
            ASSERT_EQ(check.find_wrong(surgery), "") << steps;
            surgery.clear_events();
            most = std::max(most, surgery.vertex_count());
            least = std::min(least, least_material_angle(surgery.result().mesh));
        }
    }
    fmt::print("vertices {} -> {} most {}, least angle ever {:.2f}\n", cloth.mesh.vertex_count(),
               surgery.vertex_count(), most, least);
    EXPECT_LE(most, 1.2 * cloth.mesh.vertex_count());
}

}  // namespace
}  // namespace arris
