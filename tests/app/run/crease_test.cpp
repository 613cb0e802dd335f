// SPDX-License-Identifier: GPL-3.0-or-later
// Two plates that close on cloth between them, like a hinge or a book: the cloth moves up the crease, where
// it keeps its distance from both, in ordinary steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "app/files/csv_table.h"
#include "geometry/vectors.h"
#include "tests/app/program.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

struct CreaseCase {
    double slope;  ///< degrees, of the plates at the end
    int cells;     ///< along the cloth's longer side
    double friction;
    bool is_bare = false;  ///< without contact of the cloth with itself
};

/// Plates of .3 m at 30 degrees, which turn about the crease from .4 s to .8 s.
std::string scene_of(const CreaseCase& one)
{
    constexpr double kStart = 30.0 * M_PI / 180.0, kHalf = 0.15, kThin = 0.01;
    std::string text = fmt::format(
        "duration = 1.0\n[gravity]\n[cloth]\nsize = [0.3, 0.2]\nresolution = [{}, {}]\ntranslate = [-0.15, "
        "-0.1, "
        "0.095]\n[cloth.material]\npreset = \"cotton\"\ndamping = 0.003\n",
        one.cells, 2 * one.cells / 3);
    if (one.friction > 0.0) text += fmt::format("[friction]\ncoefficient = {}\n", one.friction);
    if (!one.is_bare) text += "[self_contact]\n";
    const double rate = (one.slope * M_PI / 180.0 - kStart) / 0.4;
    for (const double side : {1.0, -1.0})
        text += fmt::format(
            "[[obstacle]]\nbox = [{}, 0.4, {}]\ntranslate = [{}, 0, {}]\nrotate = {{ axis = [0, 1, 0], "
            "degrees = {} "
            "}}\nmotion = {{ angular_velocity = [0, {}, 0], start = 0.4, stop = 0.8 }}\n",
            2.0 * kHalf, 2.0 * kThin, side * (kHalf * std::cos(kStart) + kThin * std::sin(kStart)),
            kHalf * std::sin(kStart) - kThin * std::cos(kStart), -30.0 * side, -rate * side);
    return text;
}

TEST(Crease, ClothMovesUpBetweenPlatesThatClose)
{
    constexpr std::size_t kSteps = 217;  // of the default length, with the start's part
    constexpr std::size_t kMoreSteps = 20;
    // Friction above the tangent of half the crease's angle would lock the cloth there: how many steps it
    // then takes is chance.
    const TemporaryDirectory folder;
    for (const CreaseCase& one :
         {CreaseCase{60.0, 6, 0.0}, CreaseCase{70.0, 9, 0.2}, CreaseCase{78.0, 12, 0.0, true},
          CreaseCase{80.0, 6, 0.0, true}, CreaseCase{82.0, 9, 0.1}, CreaseCase{84.0, 12, 0.0},
          CreaseCase{86.0, 6, 0.05}}) {
        SCOPED_TRACE(fmt::format("{} degrees, {} cells, friction {}", one.slope, one.cells, one.friction));
        write_bytes(folder / "scene.toml", scene_of(one));
        Program program(folder, {"run", folder / "scene.toml", "-o", folder / "out", "--overwrite", "--quiet",
                                 "--set", "output.formats=[]", "--set", "output.frames_per_second=4"});
        EXPECT_EQ(program.wait(), 0) << program.err();
        const CsvTable steps = read_csv(folder / "out/steps.csv");
        EXPECT_LE(steps.row_count(), kSteps + kMoreSteps);
    }
}

}  // namespace
}  // namespace arris
