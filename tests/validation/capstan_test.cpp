// SPDX-License-Identifier: GPL-3.0-or-later
// A strip hangs over a drum of N sides and is held at one end; its tensions obey the capstan's law,
// T_held = exp(+-mu pi) T_load, with the strip's own weight added.
//
//        ___         going from the load up and over the drum, with s = 1 where the strip slides on the drum
//      /     \       towards the load, s = -1 towards the held end:
//     |       |
//  held     load     an edge that turns the cloth by phi:        T *= exp(-s mu phi)
//                    a side of length l with normal angle a:     T += rho g l (cos a - s mu sin a)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloth_run.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr double kPi = std::numbers::pi, kG = 9.81;
constexpr double kRadius = 0.15, kThickness = 1e-3, kHeld = 0.1, kLoad = 0.8, kWidth = 0.1;  // m
constexpr double kDensity = 0.2, kStiffness = 5000.0;                                        // kg/m^2, N/m
constexpr double kStep = 0.005;                                                              // s
constexpr double kSpeed = 0.01;  // m/s of the pulled end: slow, as rho V^2 and waves count for nothing

struct DrumCase {
    int sides = 12;         ///< a multiple of 4; the drum's edges are at the angles 2 pi k / sides
    bool has_eol = true;    ///< whether its edges are features
    double friction = 0.3;  ///< coefficient
    double pull = 0.0;      ///< m/s, of the held end, downwards
    double turning = 0.0;   ///< rad/s of the drum, positive towards the load
    int strip_sides = 35;   ///< of the strip on the drum, without features
    int cells = 28;
    GridPattern pattern = GridPattern::Cross;
    double pattern_angle = 0.0;  ///< degrees

    /// s: 1 where the strip slides on the drum towards the load, else -1.
    double sense() const { return turning < 0.0 || pull < 0.0 ? 1.0 : -1.0; }
};

/// A drum with its axis along y.
ObstacleMesh make_drum(int sides)
{
    ObstacleMesh mesh;
    for (const double y : {-0.25, 0.25})
        for (int k = 0; k < sides; ++k) {
            const double angle = 2.0 * kPi * k / sides;
            mesh.points.emplace_back(kRadius * std::cos(angle), y, kRadius * std::sin(angle));
        }
    for (int k = 0; k < sides; ++k) {
        const int next = (k + 1) % sides;
        mesh.faces.push_back({k, sides + next, next});
        mesh.faces.push_back({k, sides + k, sides + next});
        if (k == 0 || next == 0) continue;
        mesh.faces.push_back({0, k, next});
        mesh.faces.push_back({sides, sides + next, sides + k});
    }
    return mesh;
}

/// The strip's line around the drum, from the held side over the top to the load: its corners, at the
/// stand-off from the drum's sides. Without features the strip starts around the drum, whose edges it meets
/// anywhere.
std::vector<Vec3> find_corners(const DrumCase& drum)
{
    std::vector<Vec3> corners;
    const auto outward = [](double angle) { return Vec3(std::cos(angle), 0.0, std::sin(angle)); };
    const int count = drum.has_eol ? drum.sides / 2 : drum.strip_sides;
    const double turn = kPi / count;
    for (int k = count; k >= 0; --k) {
        const double angle = turn * k;
        if (!drum.has_eol) {
            corners.push_back((kRadius + kThickness) / std::cos(0.5 * turn) * outward(angle));
            continue;
        }
        // Normals of the sides before and after; beyond the drum the strip hangs down.
        const Vec3 a = outward(std::min(angle + 0.5 * turn, kPi)),
                   b = outward(std::max(angle - 0.5 * turn, 0.0));
        corners.push_back(kRadius * outward(angle) + kThickness / (1.0 + a.dot(b)) * (a + b));
    }
    return corners;
}

/// Lengths along the strip at which it turns, m.
std::vector<double> find_folds(const std::vector<Vec3>& corners)
{
    std::vector<double> folds = {kHeld};
    for (std::size_t k = 1; k < corners.size(); ++k)
        folds.push_back(folds.back() + (corners[k] - corners[k - 1]).norm());
    return folds;
}

Vec3 place_on_drum(const std::vector<Vec3>& corners, const std::vector<double>& folds, const Vec2& material)
{
    const double u = material.x();
    const Vec3 across(0.0, material.y() - 0.5 * kWidth, 0.0);
    if (u <= folds.front()) return corners.front() - (folds.front() - u) * Vec3::UnitZ() + across;
    for (std::size_t k = 1; k < folds.size(); ++k)
        if (u <= folds[k])
            return corners[k - 1] +
                   (u - folds[k - 1]) / (folds[k] - folds[k - 1]) * (corners[k] - corners[k - 1]) + across;
    return corners.back() - (u - folds.back()) * Vec3::UnitZ() + across;
}

ClothRun make_drum_run(const DrumCase& drum)
{
    const std::vector<Vec3> corners = find_corners(drum);
    const std::vector<double> folds = find_folds(corners);
    ClothGrid grid;
    grid.size = Vec2(folds.back() + kLoad, kWidth);
    grid.resolution = {drum.cells, 2};
    grid.pattern = drum.pattern;
    grid.pattern_angle = drum.pattern_angle;
    for (const double fold : folds) grid.folds.push_back({{Vec2(fold, 0.0), Vec2(fold, kWidth)}, 0.0});
    ClothMesh mesh = make_cloth_grid(grid);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.world[v] = place_on_drum(corners, folds, mesh.material[v]);
    Scene scene;
    scene.materials[0] = {kDensity, kStiffness, 0.0, 1e-7, 0.01, kThickness};
    scene.gravity = Gravity{};
    RigidMotion turning;
    turning.angular_velocity = Vec3(0.0, drum.turning, 0.0);
    scene.obstacles.push_back(
        MovingObstacle("drum", make_drum(drum.sides), {}, turning, drum.has_eol ? 10.0 : 60.0));
    scene.friction = Friction{{drum.friction}};
    if (drum.has_eol) scene.eol = make_initial_target(mesh);
    Pin pin;
    pin.material = {Vec2(0.0, 0.0), Vec2(0.0, kWidth)};
    pin.motion.velocity = Vec3(0.0, 0.0, -drum.pull);
    scene.pins = {pin};
    return ClothRun(std::move(scene), std::move(mesh));
}

/// The strip's tension where it arrives at the drum from its held end, N/m: from the strain of its two
/// borders between that end and their next vertices, and the weight between that and the drum.
double measure_tension(const DrumCase& drum, const ClothRun& run)
{
    const ClothMesh& mesh = run.state.mesh;
    const double held = kHeld + drum.pull * run.state.time;
    double sum = 0.0;
    for (const double border : {0.0, kWidth}) {
        int end = -1, next = -1;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Vec2& at = mesh.material[v];
            if (at.y() != border) continue;
            if (at.x() == 0.0)
                end = v;
            else if (next < 0 || at.x() < mesh.material[next].x())
                next = v;
        }
        const double way = mesh.material[next].x();
        const double strain = (mesh.world[next] - mesh.world[end]).norm() / way - 1.0;
        sum += kStiffness * strain + kDensity * kG * (held - 0.5 * way);
    }
    return 0.5 * sum;
}

/// The tension there by the closed form, N/m, at `time`.
double find_tension(const DrumCase& drum, double time)
{
    const double s = drum.sense(), w = kDensity * kG;
    double tension = w * (kLoad - drum.pull * time);
    const double turn = 2.0 * kPi / drum.sides;
    const double side = 2.0 * (kRadius * std::sin(0.5 * turn) + kThickness * std::tan(0.5 * turn));
    for (int k = 0; k <= drum.sides / 2; ++k) {
        const bool is_end = k == 0 || k == drum.sides / 2;
        tension *= std::exp(-s * drum.friction * (is_end ? 0.5 : 1.0) * turn);
        const double normal = (k + 0.5) * turn;
        if (k < drum.sides / 2)
            tension += w * side * (std::cos(normal) - s * drum.friction * std::sin(normal));
    }
    return tension;
}

/// Mean of the measured tension over that of the closed form, while the strip slides. `settling`, `duration`:
/// s.
double share_of_closed_form(const DrumCase& drum, double settling, double duration)
{
    ClothRun run = make_drum_run(drum);
    run.advance(settling, kStep);
    double sum = 0.0;
    int steps = 0;
    run.advance(duration, kStep, [&](const StepReport& report) {
        EXPECT_EQ(report.sticking, 0);
        sum += measure_tension(drum, run) / find_tension(drum, run.state.time);
        ++steps;
    });
    return sum / steps;
}

TEST(Capstan, MultipliesTheTensionOverTheEdgesOfADrum)
{
    // Sliding to the held end: 5e-4 as the strip stretches by 1e-3, on turned meshes 9e-4. Sliding to the
    // load a twelfth of the tension is left, and the weight that vertices gather counts more: 5e-3.
    constexpr double kTightError = 2e-3, kSlackError = 1e-2;
    Table table("capstan_edges", {"coefficient", "slides to", "cells", "pattern", "tension / closed form"});
    std::vector<DrumCase> cases;
    for (const double pull : {kSpeed, -kSpeed}) {
        for (const double friction : {0.1, 0.3}) cases.push_back({.friction = friction, .pull = pull});
        cases.push_back({.pull = pull, .cells = 14});
        cases.push_back({.pull = pull, .cells = 42, .pattern = GridPattern::Diagonal, .pattern_angle = 17.0});
    }
    cases.push_back({.friction = 0.5, .pull = kSpeed});
    for (const DrumCase& drum : cases) {
        const double share = share_of_closed_form(drum, 0.2, 0.1);
        EXPECT_NEAR(share, 1.0, drum.pull > 0.0 ? kTightError : kSlackError)
            << drum.friction << " " << drum.pull << " " << drum.cells;
        table.add({fmt::format("{:g}", drum.friction), drum.pull > 0.0 ? "the held end" : "the load",
                   fmt::format("{}", drum.cells), name_of(drum.pattern), fmt::format("{:.5f}", share)});
    }
}

// Faces of the strip meet edges of the drum in rows. A drum of few sides under a strip of few sides is a gear
// even without friction, by 1 %; the numbers of sides have no common divisor.
TEST(Capstan, MultipliesTheTensionOverATurningDrumWithoutEolVertices)
{
    constexpr double kError = 0.02;
    Table table("capstan_rows", {"coefficient", "drum turns to", "tension / closed form"});
    for (const double turning : {0.1, -0.1})  // rad/s
        for (const double friction : {0.1, 0.3}) {
            const DrumCase drum{.sides = 36, .has_eol = false, .friction = friction, .turning = turning};
            const double share = share_of_closed_form(drum, 0.2, 0.3);
            EXPECT_NEAR(share, 1.0, kError) << friction << " " << turning;
            table.add({fmt::format("{:g}", friction), turning > 0.0 ? "the load" : "the held end",
                       fmt::format("{:.4f}", share)});
        }
}

}  // namespace
}  // namespace arris
