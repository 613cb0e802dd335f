// SPDX-License-Identifier: GPL-3.0-or-later
// Friction against closed forms: on slopes, over edges, on obstacles that move.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "ode.h"
#include "refinement.h"
#include "sliding_strip.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "solver/energy_balance.h"
#include "solver/model/time_integration.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kG = 9.81, kThickness = 1e-3, kStep = 0.005;
constexpr double kDegrees = std::numbers::pi / 180.0;

/// A sheet of .4 m that lies on a wide floor under gravity that leans by `slope` (rad) towards x. `corner`: x
/// of its border, m.
ClothRun make_floor_run(double friction, double slope, GridPattern pattern, const RigidMotion& motion = {},
                        double corner = 0.2)
{
    Scene scene;
    scene.materials[0] = {0.15, 2000.0, 0.3, 1e-5, 0.0, kThickness};
    scene.gravity = Gravity{kG * Vec3(std::sin(slope), 0.0, -std::cos(slope))};
    const MovingObstacle floor = make_floor();
    scene.obstacles.push_back(MovingObstacle("floor", floor.shape().mesh(), {}, motion, 30.0));
    scene.friction = Friction{{friction}};
    ClothMesh mesh = make_sheet({0.4, 0.4}, {4, 4}, pattern);
    lay(mesh, Vec3(corner, -0.2, kThickness));
    return ClothRun(std::move(scene), std::move(mesh));
}

Vec3 middle_of(const ClothRun& run)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : run.state.mesh.world) sum += x;
    return sum / static_cast<double>(run.state.mesh.world.size());
}

Vec3 mean_velocity(const ClothRun& run)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : run.state.velocity) sum += v;
    return sum / static_cast<double>(run.state.velocity.size());
}

TEST(FrictionOnASlope, SlidesWithGTimesSinMinusMuCos)
{
    constexpr double kDuration = 0.2, kError = 1e-6;  // m/s^2
    for (const GridPattern pattern : kPatterns)
        for (const double friction : {0.1, 0.3, 0.5}) {
            const double slope = std::atan(friction) + 3.0 * kDegrees;
            ClothRun run = make_floor_run(friction, slope, pattern);
            run.advance(kDuration, kStep);
            EXPECT_NEAR(mean_velocity(run).x() / kDuration,
                        kG * (std::sin(slope) - friction * std::cos(slope)), kError)
                << name_of(pattern) << " " << friction;
            EXPECT_NEAR(mean_velocity(run).y(), 0.0, kError);
        }
}

TEST(FrictionOnASlope, BeginsToSlideAtTheAngleOfFriction)
{
    constexpr double kAngle = 0.05 * kDegrees;
    constexpr double kSprings = 1e-8;  // m: friction's springs give way while the load comes on them
    for (const double friction : {0.1, 0.3, 0.5}) {
        ClothRun below = make_floor_run(friction, std::atan(friction) - kAngle, GridPattern::Cross),
                 above = make_floor_run(friction, std::atan(friction) + kAngle, GridPattern::Cross);
        const double start = middle_of(below).x();
        below.advance(1.0, kStep);
        EXPECT_NEAR(middle_of(below).x(), start, kSprings) << friction;
        const double rest = middle_of(below).x();
        below.advance(1.0, kStep);
        EXPECT_NEAR(middle_of(below).x(), rest, 1e-12) << friction;  // no creep
        above.advance(1.0, kStep);
        EXPECT_GT(middle_of(above).x(), start + 1e-3) << friction;
    }
}

TEST(FrictionOnMovingObstacles, LagsBehindAFloorThatJumpsByVSquaredOver2MuG)
{
    constexpr double kError = 2e-5;  // m
    const double friction = 0.3, speed = 0.5, lag = speed * speed / (2.0 * friction * kG);
    RigidMotion motion;
    motion.velocity = Vec3(speed, 0.0, 0.0);
    ClothRun run = make_floor_run(friction, 0.0, GridPattern::Cross, motion);
    const double start = middle_of(run).x();
    run.advance(1.0, kStep);
    EXPECT_NEAR(start + speed * 1.0 - middle_of(run).x(), lag, kError);
    const double settled = middle_of(run).x() - speed * run.state.time;
    run.advance(1.0, kStep);
    EXPECT_NEAR(middle_of(run).x() - speed * run.state.time, settled, 1e-13);
}

TEST(FrictionOnMovingObstacles, RidesOnATurntableWithoutCreep)
{
    const double friction = 0.5, rate = 3.0;  // rad/s: friction holds up to .54 m from the axis
    RigidMotion motion;
    motion.angular_velocity = Vec3(0.0, 0.0, rate);
    ClothRun run = make_floor_run(friction, 0.0, GridPattern::Cross, motion);
    const auto on_table = [&] {
        const Mat3 back = Eigen::AngleAxisd(-rate * run.state.time, Vec3::UnitZ()).toRotationMatrix();
        return Vec3(back * middle_of(run));
    };
    run.advance(0.5, kStep);
    const Vec3 stuck = on_table();
    run.advance(2.0, kStep);
    EXPECT_LT((on_table() - stuck).norm(), 1e-12);  // m
}

/// Strip over an edge: x" (x + e (L - x)) = g (x (sin b - mu cos b) + e (L - x) (sin a - mu cos a)) + (e - 1)
/// x'^2 with e = exp(mu (b - a)); on a slope beyond the vertical nothing presses.
double length_with_friction_after(const StripCase& strip, double time)
{
    const double a = strip.slopes.before, b = strip.slopes.after, mu = strip.friction, L = strip.length;
    const double e = std::exp(mu * (b - a));
    const auto slope = [&](double, const Eigen::Vector2d& at) {
        const double x = at[0], rest = e * (L - x);
        const double force = kG * (x * (std::sin(b) - mu * std::max(std::cos(b), 0.0)) +
                                   rest * (std::sin(a) - mu * std::cos(a)));
        return Eigen::Vector2d(at[1], (force + (e - 1.0) * at[1] * at[1]) / (x + rest));
    };
    return integrate_rk4(Eigen::Vector2d(strip.start, 0.0), 0.0, time, 4000, slope)[0];
}

/// Share of a strip beyond the edge at which it begins to slide.
double find_onset(const StripCase& strip)
{
    const double a = strip.slopes.before, b = strip.slopes.after, mu = strip.friction;
    const double e = std::exp(mu * (b - a));
    const double pulls = std::sin(b) - mu * std::max(std::cos(b), 0.0),
                 holds = e * (mu * std::cos(a) - std::sin(a));
    return holds / (pulls + holds);
}

double way_over_edge(const StripCase& strip, double duration, double step)
{
    ClothRun run = make_strip_run(strip);
    run.advance(duration, step);
    return (measure_length_after(strip, run) - strip.start) /
           (length_with_friction_after(strip, duration) - strip.start);
}

TEST(FrictionOverAnEdge, SlidesByTheCapstansLawOnAnyMesh)
{
    constexpr double kDuration = 0.3, kError = 1e-3, kAgree = 2e-4;  // budgets agree to 2e-5
    std::vector<StripCase> cases;
    for (const int cells : {4, 8, 16, 32}) cases.push_back({.cells = {cells, 2}});
    for (const GridPattern pattern : kPatterns) cases.push_back({.pattern = pattern, .pattern_angle = 17.0});
    double least = 2.0, greatest = 0.0;
    Table table("friction_over_an_edge", {"cells", "pattern", "way / closed form"});
    for (StripCase& strip : cases) {
        strip.friction = 0.3;
        strip.start = 1.1 * find_onset(strip);
        const double share = way_over_edge(strip, kDuration, kStep);
        EXPECT_NEAR(share, 1.0, kError) << strip.cells[0] << " " << name_of(strip.pattern);
        least = std::min(least, share);
        greatest = std::max(greatest, share);
        table.add({fmt::format("{}", strip.cells[0]), std::string(name_of(strip.pattern)),
                   fmt::format("{:.5f}", share)});
    }
    EXPECT_LT(greatest - least, kAgree);
}

TEST(FrictionOverAnEdge, SlidesOnSlopesThatRub)
{
    constexpr double kError = 1e-3;
    for (const auto& [before, after] : {std::pair(0.0, 60.0), {20.0, 65.0}, {-20.0, 45.0}, {-30.0, 90.0}}) {
        StripCase strip{.slopes = {before * kDegrees, after * kDegrees}, .friction = 0.3};
        strip.start = std::max(0.1, 1.1 * find_onset(strip));
        EXPECT_NEAR(way_over_edge(strip, 0.3, kStep), 1.0, kError) << before << " " << after;
    }
}

TEST(FrictionOverAnEdge, HasTheIntegratorsOrder)
{
    StripCase strip{.friction = 0.3};
    strip.start = 1.1 * find_onset(strip);
    std::vector<double> steps = {0.01, 0.005, 0.0025}, errors;
    for (const double step : steps) errors.push_back(std::abs(way_over_edge(strip, 0.6, step) - 1.0));
    EXPECT_NEAR(order_of(steps, errors), 2.0, 0.3);
}

TEST(FrictionOverAnEdge, RestsBelowTheOnsetAndGoesAboveIt)
{
    constexpr double kElastic = 2e-6;  // m
    for (const double friction : {0.1, 0.3, 0.5}) {
        StripCase strip{.friction = friction};
        strip.start = 0.98 * find_onset(strip);
        ClothRun run = make_strip_run(strip);
        run.advance(0.6, kStep);
        EXPECT_NEAR(measure_length_after(strip, run), strip.start, kElastic) << friction;
        strip.start = 1.02 * find_onset(strip);
        EXPECT_NEAR(way_over_edge(strip, 0.6, kStep), 1.0, 0.01) << friction;
    }
}

// A sheet lies on both sides of a ridge, which fall by b, and slides along the ridge. Its sides press by
// cos b of their weight, and around the edge by b times their tension, sin b of their weight.
TEST(FrictionAlongAnEdge, SlidesByMuTimesTheTurn)
{
    constexpr double kDuration = 0.2;  // s
    constexpr double kError = 5e-4;    // relative
    Table table("friction_along_an_edge", {"coefficient", "sides fall by", "acceleration / closed form"});
    for (const double friction : {0.1, 0.3, 0.5})
        for (const double fall : {30.0, 60.0}) {
            const double b = fall * kDegrees, share = friction * (std::cos(b) + b * std::sin(b));
            StripCase strip{
                .slopes = {-b, b}, .length = 0.2, .start = 0.1, .cells = {2, 6}, .friction = friction};
            strip.lean = std::atan(share) + 0.05;
            ClothRun above = make_strip_run(strip);
            above.advance(kDuration, kStep);
            const double expected = kDuration * kG * (std::sin(strip.lean) - share * std::cos(strip.lean));
            EXPECT_NEAR(mean_velocity(above).y() / expected, 1.0, kError) << friction << " " << fall;
            table.add({fmt::format("{:g}", friction), fmt::format("{:g} degrees", fall),
                       fmt::format("{:.5f}", mean_velocity(above).y() / expected)});
            strip.lean = std::atan(share) - 0.01;
            ClothRun below = make_strip_run(strip);
            below.advance(kDuration, kStep);
            EXPECT_NEAR(mean_velocity(below).y(), 0.0, 1e-12) << friction << " " << fall;
        }
}

/// A stiff sheet lies with its middle on a nail, and gravity leans by `slope` towards `direction` (rad).
ClothRun make_nail_run(double friction, double slope, double direction)
{
    Scene scene;
    scene.materials[0] = {0.15, 1e4, 0.3, 10.0, 0.002, kThickness};
    const Vec3 level(std::cos(direction), std::sin(direction), 0.0);
    scene.gravity = Gravity{kG * (std::sin(slope) * level - std::cos(slope) * Vec3::UnitZ())};
    scene.obstacles.push_back(MovingObstacle("nail", make_points({Vec3::Zero()}), {}, {}, 30.0));
    scene.friction = Friction{{friction}};
    ClothMesh mesh = make_sheet({0.2, 0.2}, {6, 6}, GridPattern::Cross);
    lay(mesh, Vec3(-0.1, -0.1, kThickness));
    scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh));
}

// The whole weight presses on the nail, and the sheet stays flat: beta = 0. In 50 ms it tips by 4e-4 rad.
TEST(FrictionOnANail, HoldsAStiffSheetUpToTheAngleOfFriction)
{
    constexpr double kDuration = 0.05;  // s
    constexpr double kError = 3e-3;     // relative: tipping adds up to 2e-3
    constexpr double kTurn = 1e-6;      // rad: no direction is preferred
    Table table("friction_on_a_nail", {"coefficient", "direction", "acceleration / closed form"});
    for (const double friction : {0.1, 0.3, 0.5})
        for (const double degrees : {0.0, 30.0, 100.0}) {
            const double slope = std::atan(friction) + 10.0 * kDegrees;
            ClothRun run = make_nail_run(friction, slope, degrees * kDegrees);
            run.advance(kDuration, kStep);
            ASSERT_EQ(run.state.eol.size(), 1u);
            Vec3 sum = Vec3::Zero();  // without the vertex on the nail, which does not move with its material
            for (std::size_t v = 0; v < run.state.velocity.size(); ++v)
                if (run.state.eol_entry(run.state.ids[v]) < 0) sum += run.state.velocity[v];
            const double speed = sum.head<2>().norm() / static_cast<double>(run.state.velocity.size() - 1);
            const double expected = kG * (std::sin(slope) - friction * std::cos(slope)) * kDuration;
            EXPECT_NEAR(speed / expected, 1.0, kError) << friction << " " << degrees;
            EXPECT_NEAR(std::atan2(sum.y(), sum.x()), degrees * kDegrees, kTurn) << friction;
            table.add({fmt::format("{:g}", friction), fmt::format("{:g} degrees", degrees),
                       fmt::format("{:.4f}", speed / expected)});
        }
}

TEST(FrictionOnANail, HoldsAStiffSheetBelowTheAngleOfFriction)
{
    constexpr double kSprings = 2e-6;  // m: friction's spring gives way while the load comes on it
    for (const double friction : {0.1, 0.3, 0.5}) {
        ClothRun run = make_nail_run(friction, std::atan(friction) - 1.0 * kDegrees, 0.5);
        run.advance(0.1, kStep);
        EXPECT_LT(middle_of(run).head<2>().norm(), kSprings) << friction;
        const Vec3 rest = middle_of(run);
        run.advance(0.1, kStep);
        EXPECT_LT((middle_of(run) - rest).head<2>().norm(), 1e-9) << friction;
    }
}

/// Greatest distance of corresponding vertices, m; infinite on different meshes.
double greatest_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    if (from.size() != to.size()) return std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (std::size_t v = 0; v < from.size(); ++v) most = std::max(most, (to[v] - from[v]).norm());
    return most;
}

// Damping alone ends the swinging of the sides (docs/research-notes.md, "Friction").
TEST(FrictionOnATable, BringsADroppedClothToRestWithoutCreep)
{
    constexpr double kDensity = 0.15, kStill = 1e-8;  // kg/m^2, J/kg
    constexpr double kCreep = 1e-9;                   // m in ten seconds
    ClothMesh mesh = make_sheet({1.0, 1.0}, {10, 10}, GridPattern::Cross, 10.0);
    lay(mesh, Vec3(-0.5, -0.5, 0.02));
    Scene scene = make_table_scene(mesh, {kDensity, 500.0, 0.3, 1e-4, 0.1, kThickness}, Vec3(0.7, 0.7, 0.3),
                                   Vec3(0.0, 0.0, -0.15));
    scene.friction = Friction{{0.3}};
    ClothRun run(std::move(scene), std::move(mesh));
    double energy = measure_energy(run).sum(), rise = 0.0;
    const double first = energy;
    run.advance(3.0, kStep, [&](const StepReport& report) {
        const double now = measure_energy(run).sum();
        rise = std::max(rise, now - energy);
        energy = std::min(energy, now);
        EXPECT_GE(report.friction_work, -1e-9);
    });
    EXPECT_LT(rise, 1e-3 * (first - energy));
    EXPECT_LT(measure_energy(run).kinetic / kDensity, kStill);
    run.advance(4.0, 4.0 * kStep);
    const std::vector<Vec3> rest = run.state.mesh.world;
    run.advance(10.0, 20.0 * kStep);
    EXPECT_LT(greatest_move(rest, run.state.mesh.world), kCreep);
}

/// A sheet hangs over a box, around whose corners it is EOL; the box starts to turn after a while.
ClothRun make_turning_box_run(double friction, double rate, double start)
{
    ClothMesh mesh = make_sheet({0.5, 0.5}, {10, 10}, GridPattern::Cross);
    lay(mesh, Vec3(-0.25, -0.25, 0.002));
    Scene scene = make_table_scene(mesh, {0.15, 500.0, 0.3, 1e-4, 0.05, kThickness}, Vec3(0.4, 0.4, 0.2),
                                   Vec3(0.0, 0.0, -0.1));
    Placement place;
    place.translation = Vec3(0.0, 0.0, -0.1);
    RigidMotion motion;
    motion.angular_velocity = Vec3(0.0, 0.0, rate);
    motion.start = start;
    scene.obstacles.clear();
    scene.obstacles.push_back(MovingObstacle("box", make_box(Vec3(0.4, 0.4, 0.2)), place, motion, 30.0));
    scene.friction = Friction{{friction}};
    return ClothRun(std::move(scene), std::move(mesh));
}

/// Angle, rad, by which the cloth has turned about z from its material.
double turn_of(const ClothMesh& mesh)
{
    double along = 0.0, across = 0.0;
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const Vec2 X = mesh.material[v] - Vec2(0.25, 0.25);
        const Vec3& x = mesh.world[v];
        along += X.x() * x.x() + X.y() * x.y();
        across += X.x() * x.y() - X.y() * x.x();
    }
    return std::atan2(across, along);
}

/// Angular momentum about z over moment of inertia, rad/s, of vertices with equal mass.
double spin_of(const State& state)
{
    double momentum = 0.0, inertia = 0.0;
    for (std::size_t v = 0; v < state.velocity.size(); ++v) {
        const Vec3 &x = state.mesh.world[v], &w = state.velocity[v];
        momentum += x.x() * w.y() - x.y() * w.x();
        inertia += x.x() * x.x() + x.y() * x.y();
    }
    return momentum / inertia;
}

TEST(FrictionOnMovingObstacles, TurnsClothAroundCornersWithTheBoxOrLetsItSlip)
{
    constexpr double kRate = 2.0, kStart = 0.5, kSettled = 0.4;  // rad/s, s, s
    constexpr double kSpin = 5e-3, kRides = 2e-3;                // rad/s, rad: the sides still swing a little
    for (const double friction : {0.02, 0.8}) {
        ClothRun run = make_turning_box_run(friction, kRate, kStart);
        const auto watch = [&](const StepReport& report) { EXPECT_EQ(report.crossings, 0); };
        run.advance(kStart, kStep, watch);
        restart(run.state);  // the box jumps to its speed
        run.advance(0.2, kStep, watch);
        const auto corners = [&] {
            return std::count_if(run.state.eol.begin(), run.state.eol.end(),
                                 [](const EolVertex& eol) { return eol.on.is_corner(); });
        };
        EXPECT_EQ(audit(run.scene, run.state).obstacle, -1);
        if (friction < 0.1) {  // the box has turned by .4 rad; only its edges drag the sides along
            EXPECT_LT(spin_of(run.state), 0.5 * kRate);
            EXPECT_LT(turn_of(run.state.mesh), 0.1);
            continue;
        }
        EXPECT_NEAR(spin_of(run.state), kRate, 4.0 * kSpin);
        run.advance(kSettled - 0.2, kStep, watch);
        const double lag = kRate * kSettled - turn_of(run.state.mesh);
        run.advance(0.3, kStep, watch);
        EXPECT_EQ(corners(), 4);
        EXPECT_NEAR(spin_of(run.state), kRate, kSpin);
        EXPECT_NEAR(kRate * (kSettled + 0.3) - turn_of(run.state.mesh), lag, kRides);
        EXPECT_EQ(audit(run.scene, run.state).obstacle, -1);
    }
}

// On a table that jumps to w rad/s every point slips along its circle, so the sheet's spin grows by
// mu g integral r / integral r^2 until it is w. Pressure is a third of each face at its corners.
TEST(FrictionOnMovingObstacles, SpinsASheetUpByItsTorque)
{
    constexpr double kError = 5e-4;  // relative
    for (const double friction : {0.1, 0.3}) {
        RigidMotion motion;
        motion.angular_velocity = Vec3(0.0, 0.0, 3.0);
        ClothRun run = make_floor_run(friction, 0.0, GridPattern::Cross, motion, -0.2);
        double torque = 0.0, inertia = 0.0;  // over mass, g and mu
        for (const Face& face : run.state.mesh.faces) {
            Vec2 middle = Vec2::Zero();
            double squares = 0.0;
            for (const int v : face) {
                const Vec2 x = run.state.mesh.world[v].head<2>();
                torque += x.norm() / 3.0;
                middle += x;
                squares += x.squaredNorm();
            }
            inertia += (squares + middle.squaredNorm()) / 12.0;
        }
        constexpr double kDuration = 0.04;
        run.advance(kDuration, 0.5 * kStep);
        const double gained = friction * kG * torque / inertia * kDuration;
        EXPECT_NEAR(spin_of(run.state) / gained, 1.0, kError) << friction;
    }
}

}  // namespace
}  // namespace arris
