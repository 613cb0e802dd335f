// SPDX-License-Identifier: GPL-3.0-or-later
//
// scripts/test_formats reads the arrays with VTK itself.
#include "app/export/export_vtk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/example_frame.h"
#include "tests/app/stretching_obstacle.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ExportVtk, CountsPointsLinesAndFaces)
{
    const TemporaryDirectory dir;
    write_vtp(dir / "a.vtp", make_example_frame());
    EXPECT_THAT(read_bytes(dir / "a.vtp"),
                HasSubstr("NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
                          "NumberOfPolys=\"2\""));
    write_vtp(dir / "empty.vtp", Frame{});
    EXPECT_THAT(read_bytes(dir / "empty.vtp"), HasSubstr("NumberOfPoints=\"0\""));
    EXPECT_EQ(dir.entry_count(), 2U);
}

TEST(ExportVtk, CollectionNamesStillObstaclesOnce)
{
    const TemporaryDirectory dir;
    ObstacleRecord still{"still", {}, {}, {}}, moving{"moving", {}, {}, {}};
    moving.motion.velocity = {1.0, 0.0, 0.0};
    write_pvd(dir / "cloth.pvd", {still, moving}, 3, 4.0);
    const std::string text = read_bytes(dir / "cloth.pvd");
    EXPECT_THAT(text,
                HasSubstr("timestep=\"0.5\" part=\"0\" name=\"cloth\" file=\"frames/cloth_00002.vtp\""));
    EXPECT_THAT(text,
                HasSubstr("timestep=\"0.5\" part=\"1\" name=\"still\" file=\"frames/still_00000.vtp\""));
    EXPECT_THAT(text,
                HasSubstr("timestep=\"0.5\" part=\"2\" name=\"moving\" file=\"frames/moving_00002.vtp\""));
    EXPECT_THAT(text, Not(HasSubstr("still_00002")));
    write_pvd(dir / "cloth.pvd", {make_stretching("body", {})}, 3, 4.0);
    EXPECT_THAT(read_bytes(dir / "cloth.pvd"), HasSubstr("file=\"frames/body_00002.vtp\""));
}

}  // namespace
}  // namespace arris
