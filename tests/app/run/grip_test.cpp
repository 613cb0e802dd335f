// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles that grip cloth: it goes where they go, and holds against a pull that friction can bear.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "app/files/csv_table.h"
#include "geometry/vectors.h"
#include "tests/app/program.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

constexpr const char* kFriction = "[friction]\ncoefficient = 0.5\n";
constexpr const char* kFloor =
    "[[obstacle]]\nname = \"floor\"\nbox = [1, 1, 0.1]\ntranslate = [0, 0, -0.05]\n";

/// A sheet on a floor, which is pulled along x from 0.4 s on.
std::string sheet(double size, double pull)
{
    const std::string side = std::to_string(size), half = std::to_string(0.5 * size);
    return "duration = 0.7\n[gravity]\n[cloth]\nsize = [" + side + ", " + side +
           "]\nresolution = [6, 6]\ntranslate = [-" + half + ", -" + half +
           ", 0.0011]\n[[pull]]\nmaterial = [[0, 0], [" + side + ", " + side + "]]\nforce = [" +
           std::to_string(pull) + ", 0, 0]\nstart = 0.4\n[[probe]]\nname = \"p\"\nmaterial = [" + half +
           ", " + half + "]\n" + kFloor;
}

/// An obstacle whose lowest point comes down within 0.3 s to the height of one thickness above the floor.
std::string coming_down(const std::string& shape, double lowest, const std::string& rotate = "")
{
    const auto key = [&](double time, double height) {
        return "{ time = " + std::to_string(time) + ", translate = [0, 0, " +
               std::to_string(height - lowest) + "]" + rotate + " }";
    };
    return "[[obstacle]]\nname = \"ram\"\n" + shape + "\nkeyframes = [" + key(0.0, 0.02) + ", " +
           key(0.3, 0.001) + "]\n";
}

/// Two boxes, above and below or to both sides, that close to a gap of `gap` and then move by `way`.
std::string jaws(const Vec3& axis, const std::string& box, double half, double gap, const Vec3& at,
                 const Vec3& way)
{
    std::string text;
    for (const double side : {1.0, -1.0}) {
        const auto key = [&](double time, double apart, const Vec3& moved) {
            const Vec3 place = at + side * (half + 0.5 * apart) * axis + moved;
            return "{ time = " + std::to_string(time) + ", translate = [" + std::to_string(place.x()) + ", " +
                   std::to_string(place.y()) + ", " + std::to_string(place.z()) + "] }";
        };
        text += "[[obstacle]]\nbox = " + box + "\nkeyframes = [" + key(0.0, 0.02, Vec3::Zero()) + ", " +
                key(0.2, gap, Vec3::Zero()) + ", " + key(0.35, gap, Vec3::Zero()) + ", " +
                key(0.65, gap, way) + "]\n";
    }
    return text;
}

/// Rollers of 0.03 m that turn with 5 rad/s from 0.1 s on.
std::string rollers(const TemporaryDirectory& folder)
{
    constexpr int kSides = 48;
    constexpr double kRadius = 0.03, kApart = 0.0312;
    std::string mesh, faces, first = "f", second = "f";
    for (const char* y : {"-0.1", "0.1"})
        for (int i = 0; i < kSides; ++i)
            mesh += "v " + std::to_string(kRadius * std::cos(2.0 * M_PI * i / kSides)) + " " + y + " " +
                    std::to_string(kRadius * std::sin(2.0 * M_PI * i / kSides)) + "\n";
    for (int i = 0; i < kSides; ++i) {
        const int j = (i + 1) % kSides;
        faces += "f " + std::to_string(i + 1) + " " + std::to_string(kSides + i + 1) + " " +
                 std::to_string(kSides + j + 1) + " " + std::to_string(j + 1) + "\n";
        first += " " + std::to_string(i + 1);
        second += " " + std::to_string(2 * kSides - i);
    }
    write_bytes(folder / "roller.obj", mesh + faces + first + "\n" + second + "\n");
    std::string text =
        "duration = 0.9\n[cloth]\nsize = [0.4, 0.1]\nresolution = [16, 4]\ntranslate = [-0.05, -0.05, 0]\n"
        "[[probe]]\nname = \"p\"\nmaterial = [0.4, 0.05]\n";
    for (const int side : {1, -1}) {
        const std::string at = "[0, 0, " + std::to_string(side * (0.5 * kApart + 0.015)) + "]";
        text += "[[obstacle]]\nfile = \"roller.obj\"\ntranslate = " + at +
                "\nmotion = { angular_velocity = [0, " + std::to_string(-5 * side) + ", 0], pivot = " + at +
                ", start = 0.1 }\n";
    }
    return text;
}

struct GripCase {
    const char* name;
    std::string text;
    Vec3 way;          ///< of the probe, m
    double tolerance;  ///< m
};

std::vector<GripCase> list_cases(const TemporaryDirectory& folder)
{
    const std::string hanging =
        "duration = 0.7\n[gravity]\n[cloth]\nsize = [0.1, 0.15]\nresolution = [4, 6]\ntranslate = [-0.05, 0, "
        "-0.15]\n"
        "rotate = { axis = [1, 0, 0], degrees = 90 }\n[[pin]]\nmaterial = [[0, 0.15], [0.1, 0.15]]\n"
        "release = 0.3\n[[probe]]\nname = \"p\"\nmaterial = [0.05, 0.125]\n";
    const std::string flat =
        "duration = 0.7\n[gravity]\n[cloth]\nsize = [0.1, 0.1]\nresolution = [5, 5]\ntranslate = [-0.05, "
        "-0.05, 0]\n"
        "[[probe]]\nname = \"p\"\nmaterial = [0.05, 0.05]\n";
    const std::string blade = ", rotate = { axis = [0, 1, 0], degrees = 45 }";
    return {
        {"tweezers lift",
         hanging +
             jaws(Vec3::UnitY(), "[0.06, 0.02, 0.03]", 0.01, 1.2e-3, Vec3(0, 0, -0.02), Vec3(0, 0, 0.15)),
         Vec3(0, 0, 0.15), 1e-4},
        {"plates carry",
         flat + jaws(Vec3::UnitZ(), "[0.2, 0.2, 0.1]", 0.05, 1.2e-3, Vec3::Zero(), Vec3(0.2, 0.1, 0.1)),
         Vec3(0.2, 0.1, 0.1), 7e-4},
        {"a door closes on it", sheet(0.2, 1.0) + coming_down("box = [0.03, 1, 0.2]", -0.1), Vec3::Zero(),
         3e-4},
        {"a wire presses", sheet(0.2, 0.05) + coming_down("wire = [[0, -0.3, 0], [0, 0.3, 0]]", 0.0),
         Vec3::Zero(), 3e-4},
        {"a blade presses", sheet(0.2, 0.05) + coming_down("box = [0.05, 0.5, 0.05]", -0.0353553, blade),
         Vec3::Zero(), 3e-4},
        {"a nail presses", sheet(0.2, 0.05) + coming_down("points = [[0.003, 0.004, 0]]", 0.0), Vec3::Zero(),
         3e-4},
        {"rollers transport", rollers(folder), Vec3(0.12, 0, 0), 4e-3},
    };
}

/// Runs a scene to its end. Returns its probes.
CsvTable run_scene(const TemporaryDirectory& folder, const std::string& text)
{
    write_bytes(folder / "scene.toml", text);
    Program program(folder, {"run", folder / "scene.toml", "-o", folder / "out", "--overwrite", "--quiet",
                             "--set", "output.formats=[]", "--set", "output.frames_per_second=4"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    return read_csv(folder / "out/probes.csv");
}

TEST(Grip, HoldsClothBetweenObstaclesByFriction)
{
    const TemporaryDirectory folder;
    for (const GripCase& one : list_cases(folder)) {
        SCOPED_TRACE(one.name);
        const CsvTable probe = run_scene(folder, one.text + kFriction);
        const std::size_t last = probe.row_count() - 1;
        const char* axes[] = {"p_x", "p_y", "p_z"};
        for (int d = 0; d < 3; ++d) {
            const std::vector<double> place = probe.column(axes[d]);
            EXPECT_NEAR(place[last] - place[0], one.way[d], d == 2 ? one.tolerance + 6e-4 : one.tolerance)
                << axes[d];
        }
    }
}

TEST(Grip, HoldsNothingWithoutFriction)
{
    const TemporaryDirectory folder;
    for (const GripCase& one : list_cases(folder)) {
        const bool is_lifted = std::string(one.name) == "tweezers lift";
        if (!is_lifted && std::string(one.name) != "rollers transport") continue;
        SCOPED_TRACE(one.name);
        const CsvTable probe = run_scene(folder, one.text);
        const std::vector<double> x = probe.column("p_x"), z = probe.column("p_z");
        EXPECT_LT(std::abs(x.back() - x.front()), 0.01);
        if (is_lifted) {
            EXPECT_LT(z.back() - z.front(), -0.3) << "0.78 m in free fall";
        }
    }
}

}  // namespace
}  // namespace arris
