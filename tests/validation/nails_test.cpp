// SPDX-License-Identifier: GPL-3.0-or-later
// A silk cloth falls on three nails without shafts. The cloth slides over the nails as it sags between them,
// and hangs down around them in pleats. On any mesh, almost all contacts with the nails must be EOL vertices
// instead of rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "solver/contact/audit.h"

namespace arris {
namespace {

ClothRun make_run(int cells)
{
    ClothMesh mesh = make_sheet(Vec2(0.6, 0.6), {cells, cells}, GridPattern::Cross);
    for (std::size_t v = 0; v < mesh.world.size(); ++v)
        mesh.world[v] = Vec3(mesh.material[v].x() - 0.3, mesh.material[v].y() - 0.3, 0.02);
    Scene scene;
    scene.materials[0] = *find_material_preset("silk");
    scene.materials[0].damping = 0.002;
    scene.gravity = Gravity{};
    scene.obstacles.push_back(MovingObstacle(
        "nails", make_points({{-0.15, -0.1, 0.0}, {0.16, -0.09, 0.0}, {0.01, 0.15, 0.0}}), {}, {}, 30.0));
    scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh));
}

struct Pressing {
    int eol = 0, rows = 0;  ///< rows: counted if the contact pressed before and could be EOL
    double rise = 0.0;      ///< J

    double share() const { return eol / double(eol + rows); }
};

Pressing fall(int cells)
{
    constexpr double kFall = 0.6, kStep = 0.005;  // s
    ClothRun run = make_run(cells);
    Pressing found;
    run.advance(kFall, kStep, [&](const StepReport& report) {
        found.eol += report.eol_pressing;
        for (std::size_t k = 0; k < kConstraintCauses; ++k) {
            const auto cause = static_cast<ConstraintCause>(k);
            if (cause != ConstraintCause::New && !is_excluded(cause)) found.rows += report.rows_by_cause[k];
        }
        found.rise = std::max(found.rise, report.energy_rise);
        EXPECT_EQ(report.crossings, 0) << cells << " cells";
    });
    EXPECT_EQ(audit(run.scene, run.state.mesh, run.state.time).obstacle, -1);
    return found;
}

TEST(ClothOnNails, IsEolOnThemWhateverItsMesh)
{
    // The nails share the contacts about equally. A pleat that blocks a nail's EOL vertex may do so for long,
    // on some meshes and not on others. So a run may have as many rows as if one of its nails had no EOL
    // vertex at all, and all runs together as if one of all their nails had none.
    constexpr int kMeshes[] = {7, 8, 9, 10, 11, 12, 13, 14, 16};
    constexpr double kNails = 3.0, kAllNails = kNails * std::size(kMeshes);
    constexpr double kLeastShare = (kNails - 1.0) / kNails, kShare = (kAllNails - 1.0) / kAllNails;
    Pressing all;
    for (const int cells : kMeshes) {
        const Pressing found = fall(cells);
        EXPECT_EQ(found.rise, 0.0) << cells;
        EXPECT_GT(found.share(), kLeastShare) << cells;
        RecordProperty("share_" + std::to_string(cells), std::to_string(found.share()));
        all.eol += found.eol;
        all.rows += found.rows;
    }
    RecordProperty("share", std::to_string(all.share()));
    EXPECT_GT(all.share(), kShare);
}

}  // namespace
}  // namespace arris
