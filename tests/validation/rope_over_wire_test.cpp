// SPDX-License-Identifier: GPL-3.0-or-later
// A strip of cloth hangs over a wire and slides off without friction, like a rope over a pulley of radius 0.
// Its two sides hang straight down, except for the small angle between them.
//
//        o      y" = 2 g y / L,  y: how far the longer side is longer than half of the strip.
//       | |     It presses while its tension exceeds the flow of momentum around the wire, 2 rho y'^2.
//       | |
//         |
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth_run.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "ode.h"
#include "refinement.h"
#include "solver/contact/clearance.h"
#include "solver/eol/eol_features.h"
#include "tests/failures_since.h"

namespace arris {
namespace {

constexpr double kG = 9.81, kDensity = 0.1, kThickness = 1e-3;
constexpr double kLength = 1.0, kWidth = 0.2, kStart = 0.05;  // m
constexpr double kLiftOff = 0.598076;                         // s, when this rope lifts off
constexpr double kShare = 0.9;   // share of kLiftOff over which errors are measured
constexpr double kStep = 0.005;  // s
// Error of BDF2 at 5 ms, relative to y. The rate is sqrt(2) times that at a table's edge.
constexpr double kTimeError = 5e-4;
// Relative to y. The error is larger where the impact of the sides has crumpled the rope.
constexpr double kHeldError = 1.5e-3;
constexpr double kHangingError = 5e-4;  // error relative to the length of the longer side
constexpr double kLoss = 0.01;          // allowed loss, relative to the energy exchanged
constexpr double kClothError =
    3e-4;  // relative to y, beyond BDF2's error: the fold leans in its first cell (kOnWire)
constexpr double kMeshError = 2.5e-4;  // relative to y: fold planes keep an angle between the sides
constexpr double kRise = 1e-4;      // allowed rise of energy over its start, relative to the energy exchanged
constexpr double kClapRise = 0.05;  // allowed rise, as kRise, where the sides hit each other without damping
// Damping of the scenes, s. It dissipates nothing in a rope that does not stretch.
constexpr double kDamping = 2e-3;
constexpr double kAreaTolerance = 1e-12;  // round-off over some 100 faces, relative to the area
constexpr double kOnWire = 5e-5;          // m, for a stand-off of 1e-3: the fold leans by at most 0.05 rad

struct RopeCase {
    std::array<int, 2> cells = {8, 2};
    GridPattern pattern = GridPattern::Diagonal;
    double pattern_angle = 0.0;  ///< degrees
    Integrator integrator = Integrator::Bdf2;
    int segments = 1;  ///< number of wire segments
    std::array<double, 2> ends = {-1.0,
                                  1.0};  ///< y of the wire's ends, m; the rope's borders are at -.1 and .1
    bool is_loop = false;                ///< whether the wire goes on downward at its ends, to a closed frame
    /// Angle between the sides at the start: a little more than the fold planes require.
    double open_degrees = 0.6;
    double stiffness = 2e5;  ///< N/m
    double bending = 1e-7;   ///< J
    double damping = 0.0;    ///< s
    /// Whether the EOL vertices are given. Otherwise the first step must find them, as in a scene with
    /// `folds`.
    bool is_given = true;
    double height = 0.0;                      ///< m, of the fold above the place where it rests on the wire
    double beside = 0.0;                      ///< m, from the wire to the fold, across the wire
    double start = kStart;                    ///< m, y at the start
    double friction = 0.0;                    ///< coefficient
    double lean = 0.0;                        ///< rad, by which gravity leans along the wire
    double length = kLength, width = kWidth;  ///< m
};

std::string describe(const RopeCase& rope)
{
    return fmt::format(
        "{} x {} cells, pattern {}, turned by {}, {} segments, {} degrees open, {} N/m, {} s, {} m above, "
        "{} m beside",
        rope.cells[0], rope.cells[1], name_of(rope.pattern), rope.pattern_angle, rope.segments,
        rope.open_degrees, rope.stiffness, rope.damping, rope.height, rope.beside);
}

double displacement(double time)
{
    return kStart * std::cosh(time * std::sqrt(2.0 * kG / kLength));
}

/// Kinetic energy of the rope moving by displacement(), J.
double exchanged_energy(double time)
{
    const double rate = std::sqrt(2.0 * kG / kLength);
    return 0.5 * kDensity * kLength * kWidth * std::pow(kStart * rate * std::sinh(rate * time), 2);
}

/// Integrates y" = 2 g y / L alone, with the integrator and the steps of a run. The load is linear in y and
/// is evaluated at the position extrapolated by the last velocities, as in a run.
double integrated_displacement(Integrator integrator, double duration, double dt)
{
    const int steps = static_cast<int>(std::ceil(duration / dt - 1e-9));
    const double squared_rate = 2.0 * kG / kLength;
    std::vector<double> lengths(steps, duration / steps);
    if (integrator == Integrator::Bdf2) {  // the first step is split at one third
        lengths[0] *= 2.0 / 3.0;
        lengths.insert(lengths.begin(), 0.5 * lengths[0]);
    }
    double y = kStart, rate = 0.0, last_y = y, last_rate = rate, last_h = 0.0;
    for (const double h : lengths) {
        const bool has_history = integrator == Integrator::Bdf2 && last_h > 0.0;
        const double w = has_history ? h / last_h : 0.0;
        const double forward = w * w / (1.0 + 2.0 * w), gamma = h * (1.0 + w) / (1.0 + 2.0 * w);
        const double from = y + forward * (y - last_y);
        const double extrapolated = has_history ? from + gamma * (rate + w * (rate - last_rate)) : y;
        const double next = rate + forward * (rate - last_rate) + gamma * squared_rate * extrapolated;
        last_rate = std::exchange(rate, next);
        last_y = std::exchange(y, from + gamma * next);
        last_h = h;
    }
    return y;
}

ObstacleMesh make_wire_of(const RopeCase& rope)
{
    const auto [from, to] = rope.ends;
    std::vector<Vec3> points;
    for (int k = 0; k <= rope.segments; ++k)
        points.emplace_back(0.0, from + (to - from) * k / rope.segments, 0.0);
    if (rope.is_loop)
        for (const double y : {to, from}) points.emplace_back(0.0, y, -2.0);
    return make_wire(points, rope.is_loop);
}

/// A run with the rope folded over the wire, with EOL vertices on the wire where they are given.
ClothRun make_rope_run(const RopeCase& rope)
{
    const double fold = 0.5 * rope.length - rope.start;
    ClothGrid grid;
    grid.size = Vec2(rope.length, rope.width);
    grid.resolution = rope.cells;
    grid.pattern = rope.pattern;
    grid.pattern_angle = rope.pattern_angle;
    grid.folds = {{{Vec2(fold, 0.0), Vec2(fold, rope.width)}, 90.0}};
    ClothMesh mesh = make_cloth_grid(grid);
    const double half = 0.5 * rope.open_degrees * M_PI / 180.0;
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const double along = mesh.material[v].x() - fold;
        mesh.world[v] = {rope.beside + along * std::sin(half), mesh.material[v].y() - 0.5 * rope.width,
                         rope.height + kThickness - std::abs(along) * std::cos(half)};
    }
    Scene scene;
    scene.materials[0] = {kDensity, rope.stiffness, 0.0, rope.bending, rope.damping, kThickness};
    scene.gravity = Gravity{kG * Vec3(0.0, std::sin(rope.lean), -std::cos(rope.lean))};
    scene.obstacles.push_back(MovingObstacle("wire", make_wire_of(rope), {}, {}, 10.0));
    scene.eol = make_initial_target(mesh);
    if (rope.friction > 0.0) scene.friction = Friction{{rope.friction}};
    if (!rope.is_given) clear_stand_off(scene, mesh);
    ClothRun run(std::move(scene), std::move(mesh));
    run.settings.integrator = rope.integrator;
    if (!rope.is_given) return run;
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v)
        if (run.state.mesh.material[v].x() == fold)
            run.state.eol.push_back({run.state.ids[v], FeatureId::edge(0, 0), Vec3::UnitZ(), 0});
    follow_features(run.scene.obstacles, run.state);
    return run;
}

double measure_displacement(const ClothRun& run)
{
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v) {
        if (run.state.mesh.material[v].x() != kLength) continue;
        sum += kThickness - run.state.mesh.world[v].z() - 0.5 * kLength;
        ++count;
    }
    return sum / count;
}

/// y of a rope with friction that starts at rest, after `time`. With phi the angle by which the rope turns
/// and e = exp(mu phi), the tensions beyond rho y'^2 differ by the factor e: y" = g (l2 - e l1 + (e - 1) y'^2
/// / g) / (l2 + e l1), l1 = L/2 - y, l2 = L/2 + y.
double displacement_with_friction(const RopeCase& rope, double time)
{
    const double e = std::exp(rope.friction * (180.0 - rope.open_degrees) * M_PI / 180.0);
    const auto slope = [&](double, const Eigen::Vector2d& at) {
        const double longer = 0.5 * kLength + at[0], shorter = 0.5 * kLength - at[0];
        const double acceleration =
            (kG * (longer - e * shorter) + (e - 1.0) * at[1] * at[1]) / (longer + e * shorter);
        return Eigen::Vector2d(at[1], std::max(acceleration, 0.0));
    };
    return integrate_rk4(Eigen::Vector2d(rope.start, 0.0), 0.0, time, 4000, slope)[0];
}

void expect_sound(const State& state)
{
    EXPECT_EQ(validate(state.mesh), "");
    EXPECT_NEAR(material_area(state.mesh) / (kLength * kWidth), 1.0, kAreaTolerance);
    EXPECT_GE(state.eol.size(), 2u) << "at " << state.time << " s";
    for (const EolVertex& eol : state.eol) {
        const Vec3& x = state.mesh.world[state.index_of(eol.vertex_id)];
        EXPECT_LT(std::hypot(x.x(), x.z() - kThickness), kOnWire) << "at " << state.time << " s";
    }
}

struct Slide {
    double displacement = 0.0, error = 0.0, rise = 0.0, loss = 0.0;
    double cloth_error = 0.0;  ///< relative to integrated_displacement()
};

Slide slide(const RopeCase& rope, double dt)
{
    SCOPED_TRACE(describe(rope));
    const double duration = kShare * kLiftOff;
    ClothRun run = make_rope_run(rope);
    const EnergySpan energy = watch_energy(run, duration, dt, [&](const StepReport& report) {
        EXPECT_EQ(report.rewound, 0);
        EXPECT_EQ(report.crossings, 0);
        EXPECT_EQ(report.feature_rows, 0) << "at " << run.state.time << " s";
        expect_sound(run.state);
    });
    const double exchanged = exchanged_energy(duration);
    Slide found;
    found.displacement = measure_displacement(run);
    found.error = std::abs(found.displacement / displacement(duration) - 1.0);
    found.cloth_error =
        std::abs(found.displacement / integrated_displacement(rope.integrator, duration, dt) - 1.0);
    found.rise = (energy.greatest - energy.first) / exchanged;
    found.loss = (energy.first - energy.last) / exchanged;
    return found;
}

std::string percent(double share)
{
    return fmt::format("{:.4f} %", 100.0 * share);
}

TEST(RopeOverWire, ConvergesAtTheIntegratorsOrder)
{
    Table table("rope_order", {"integrator", "step", "error of y", "energy lost / exchanged"});
    for (const auto& [integrator, order] :
         {std::pair(Integrator::ImplicitEuler, 1.0), {Integrator::Bdf2, 2.0}}) {
        RopeCase rope;
        rope.integrator = integrator;
        const std::vector<double> steps = {0.01, 0.005, 0.0025};
        std::vector<double> errors;
        for (const double h : steps) {
            const Slide found = slide(rope, h);
            errors.push_back(found.error);
            EXPECT_LT(found.rise, kRise);
            EXPECT_LT(found.cloth_error, kClothError) << h;
            table.add({integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                       fmt::format("{:g} ms", 1e3 * h), percent(found.error),
                       fmt::format("{:.1e}", found.loss)});
        }
        EXPECT_NEAR(order_of(steps, errors), order, 0.15);
    }
}

TEST(RopeOverWire, IsARopeOnAnyMeshAndOverAnyWire)
{
    Table table("rope_meshes", {"pattern", "turned by", "cells", "segments", "error of y", "energy lost"});
    double least = 1.0, most = 0.0;
    for (const GridPattern pattern : kPatterns)
        for (const double angle : {0.0, 17.0, 45.0})
            for (const std::array<int, 2> cells : {std::array{4, 1}, {8, 2}, {16, 4}, {32, 8}, {64, 16}})
                for (const int segments : {1, 37}) {
                    const FailuresSince failures;
                    if (cells[0] > 16 && !is_deep()) continue;
                    if (pattern == GridPattern::Unstructured && angle > 0.0) continue;
                    if (segments > 1 && angle > 0.0) continue;
                    RopeCase rope;
                    rope.pattern = pattern;
                    rope.pattern_angle = angle;
                    rope.cells = cells;
                    rope.segments = segments;
                    // With the stiffness of the order test fine cells buckle: see the next test.
                    rope.stiffness = 2e4;
                    const Slide found = slide(rope, kStep);
                    if (failures.any()) {
                        ADD_FAILURE() << describe(rope);
                        continue;
                    }
                    EXPECT_LT(found.error, kTimeError) << describe(rope);
                    const double longer = 0.5 * kLength + found.displacement;
                    EXPECT_LT(found.error * found.displacement / longer, kHangingError) << describe(rope);
                    EXPECT_LT(found.cloth_error, kClothError) << describe(rope);
                    EXPECT_LT(found.rise, kRise) << describe(rope);
                    EXPECT_LT(found.loss, kLoss) << describe(rope);
                    least = std::min(least, found.displacement);
                    most = std::max(most, found.displacement);
                    table.add({name_of(pattern), fmt::format("{:g}", angle), fmt::format("{}", cells[0]),
                               std::to_string(segments), percent(found.error),
                               fmt::format("{:.1e}", found.loss)});
                }
    EXPECT_LT(most / least - 1.0, kMeshError);
}

// Nearly inextensible cloth with almost no bending stiffness buckles when its sides fall shut. With cells
// this short the buckles grow where the step is too long. This test measures which damping, stiffness or step
// prevents the growth.
TEST(RopeOverWire, OfFineCellsWantsShortStepsOrSomethingThatStillsIt)
{
    struct Case {
        double stiffness, bending, damping, step;
        bool is_held;
    };
    Table table("rope_fine", {"E, N/m", "K, J", "damping, s", "step", "meshes that hold", "worst of these"});
    for (const Case& fine : {Case{2e5, 1e-7, 0.0, kStep, false},
                             {2e5, 1e-5, 0.0, kStep, false},
                             {2e4, 1e-7, 0.0, kStep, false},
                             {2e5, 1e-7, 0.0, 0.5 * kStep, false},
                             {2e5, 1e-7, 1e-4, kStep, false},
                             {2e5, 1e-7, 1e-3, kStep, true},
                             {2e5, 1e-7, kDamping, kStep, true},
                             {2e5, 1e-5, kDamping, kStep, true}}) {
        int count = 0, held = 0;
        double worst = 0.0;
        for (const GridPattern pattern : kPatterns)
            for (const double angle : {0.0, 17.0, 45.0}) {
                const FailuresSince failures;
                if (pattern == GridPattern::Unstructured && angle > 0.0) continue;
                const bool is_one = pattern == GridPattern::Cross && angle == 17.0;
                if (!is_deep() && !(is_one && fine.is_held)) continue;
                RopeCase rope;
                rope.cells = {64, 16};
                rope.pattern = pattern;
                rope.pattern_angle = angle;
                rope.stiffness = fine.stiffness;
                rope.bending = fine.bending;
                rope.damping = fine.damping;
                ClothRun run = make_rope_run(rope);
                run.advance(kShare * kLiftOff, fine.step);
                if (failures.any()) {
                    ADD_FAILURE() << describe(rope);
                    continue;
                }
                EXPECT_EQ(run.state.crossings, 0) << describe(rope);
                const double error =
                    std::abs(measure_displacement(run) / displacement(kShare * kLiftOff) - 1.0);
                ++count;
                if (error < kHeldError) {
                    ++held;
                    worst = std::max(worst, error);
                }
            }
        if (fine.is_held) {
            EXPECT_EQ(held, count) << fine.stiffness << " N/m, " << fine.bending << " J, " << fine.damping
                                   << " s, steps of " << fine.step << " s";
        }
        table.add({fmt::format("{:g}", fine.stiffness), fmt::format("{:g}", fine.bending),
                   fmt::format("{:g}", fine.damping), fmt::format("{:g} ms", 1e3 * fine.step),
                   fmt::format("{} of {}", held, count), percent(worst)});
    }
}

/// Displacement of a rope that first falls freely by `height` on the wire. The inextensible rope then keeps
/// only the difference of its sides' momenta.
double displacement_after_fall(double time, double height)
{
    const double fall = std::sqrt(2.0 * height / kG), rate = std::sqrt(2.0 * kG / kLength);
    const double speed = kG * fall * 2.0 * kStart / kLength;
    return kStart * std::cosh(rate * (time - fall)) + speed / rate * std::sinh(rate * (time - fall));
}

// In a scene, `folds` place the rope and nothing says where its EOL vertices are. The sides of the fold pass
// the wire within 5e-6 m.
TEST(RopeOverWire, SlidesWhereverTheSceneFoldsIt)
{
    struct Case {
        const char* name;
        std::array<int, 2> cells;
        GridPattern pattern;
        int segments;
        double height;  // m
    };
    // Relative to y. The fall ends within a step, of which kStep sqrt(2 g / L) / 4 may be missing after 15
    // mm.
    constexpr double kFoundError = 1e-3;
    for (const Case& c : {Case{"four cells", {4, 1}, GridPattern::Cross, 1, 0.0},
                          {"diagonal", {8, 2}, GridPattern::Diagonal, 1, 0.0},
                          {"many segments", {8, 2}, GridPattern::Alternating, 37, 0.0},
                          {"unstructured", {16, 4}, GridPattern::Unstructured, 1, 0.0},
                          {"fine", {32, 8}, GridPattern::Cross, 1, 0.0},
                          {"half a thickness above", {16, 4}, GridPattern::Cross, 1, 5e-4},
                          {"two thicknesses above", {8, 2}, GridPattern::Diagonal, 1, 2e-3},
                          {"five thicknesses above", {16, 4}, GridPattern::Unstructured, 1, 5e-3},
                          {"a quarter of a cell above", {16, 4}, GridPattern::Cross, 1, 0.015}}) {
        SCOPED_TRACE(c.name);
        RopeCase rope;
        rope.cells = c.cells;
        rope.pattern = c.pattern;
        rope.segments = c.segments;
        rope.height = c.height;
        rope.stiffness = 2e4;
        rope.damping = kDamping;
        rope.is_given = false;
        ClothRun run = make_rope_run(rope);
        const double duration = kShare * kLiftOff;
        run.advance(duration, kStep);
        EXPECT_EQ(run.state.crossings, 0);
        EXPECT_GE(run.state.eol.size(), 2u);
        EXPECT_NEAR(measure_displacement(run) / displacement_after_fall(duration, c.height), 1.0,
                    kFoundError);
    }
}

// Wider folds have no closed form, as their sides swing shut. Their reference is the rope with given EOL
// vertices.
TEST(RopeOverWire, SlidesHoweverWideTheSceneFoldsIt)
{
    struct Case {
        double open_degrees, beside;
        std::array<int, 2> cells;
        double allowed;  // relative to the reference's y; more where the fold starts beside the wire
    };
    for (const Case& c : {Case{2.0, 0.0, {8, 2}, 1e-3},
                          {10.0, 0.0, {16, 4}, 1e-3},
                          {30.0, 0.0, {8, 2}, 1e-3},
                          {60.0, 0.0, {16, 4}, 1e-3},
                          {90.0, 0.0, {16, 4}, 1e-3},
                          {10.0, 7e-5, {8, 2}, 5e-3},
                          {30.0, 1e-4, {16, 4}, 1e-2},
                          {90.0, 3e-4, {16, 4}, 2e-2}}) {
        RopeCase rope;
        rope.open_degrees = c.open_degrees;
        rope.cells = c.cells;
        rope.pattern = GridPattern::Cross;
        rope.stiffness = 2e4;
        rope.damping = kDamping;
        ClothRun given = make_rope_run(rope);
        rope.is_given = false;
        rope.beside = c.beside;
        ClothRun found = make_rope_run(rope);
        SCOPED_TRACE(describe(rope));
        for (ClothRun* run : {&given, &found}) run->advance(kShare * kLiftOff, kStep);
        EXPECT_EQ(found.state.crossings, 0);
        EXPECT_NEAR(measure_displacement(found) / measure_displacement(given), 1.0, c.allowed);
    }
}

// A wire may end with the rope's borders or before them. The rope's sides are stiff in their planes, so that
// its fold stays straight past the wire's end, and the rope slides as on a longer wire.
TEST(RopeOverWire, SlidesOnAWireThatEndsWithItsBordersOrBeforeThem)
{
    struct Case {
        const char* name;
        std::array<double, 2> ends;  // m
        std::array<int, 2> cells;
        GridPattern pattern;
        bool is_loop = false;
        double share = kShare;  ///< of kLiftOff
    };
    constexpr double kEndError = 1e-3;  // relative to y
    for (const Case& c :
         {Case{"flush", {-0.1, 0.1}, {8, 2}, GridPattern::Diagonal},
          {"flush, one cell", {-0.1, 0.1}, {1, 1}, GridPattern::Diagonal},
          {"flush, more cells", {-0.1, 0.1}, {20, 4}, GridPattern::Cross},
          {"flush with a frame's corners", {-0.1, 0.1}, {8, 2}, GridPattern::Diagonal, true, 0.8},
          {"flush at one end", {-0.1, 1.0}, {16, 4}, GridPattern::Unstructured},
          {"a thickness inside", {-0.099, 0.099}, {8, 2}, GridPattern::Diagonal},
          {"less than a cell inside", {-0.07, 0.06}, {8, 2}, GridPattern::Diagonal},
          {"less than a cell inside, more cells", {-0.07, 0.06}, {20, 4}, GridPattern::Cross},
          {"inside at one end", {-1.0, 0.06}, {16, 4}, GridPattern::Unstructured},
          {"a cell inside", {-0.05, 0.05}, {20, 4}, GridPattern::Cross},
          {"more than a cell inside", {-0.07, 0.06}, {40, 8}, GridPattern::Cross}}) {
        SCOPED_TRACE(c.name);
        RopeCase rope;
        rope.cells = c.cells;
        rope.pattern = c.pattern;
        rope.ends = c.ends;
        rope.is_loop = c.is_loop;
        rope.stiffness = 2e4;
        rope.damping = kDamping;
        rope.is_given = false;
        ClothRun run = make_rope_run(rope);
        const double duration = c.share * kLiftOff;
        run.advance(duration, kStep);
        EXPECT_EQ(run.state.crossings, 0);
        EXPECT_NEAR(measure_displacement(run) / displacement(duration), 1.0, kEndError);
    }
}

// The wire is beside the fold's sides, not between them: nothing carries the rope, though it touches the
// wire.
TEST(RopeOverWire, FallsBesideAWireThatItsFoldDoesNotHangOn)
{
    struct Case {
        double open_degrees, beside, height;  // m
        std::array<int, 2> cells;
    };
    constexpr double kFallError = 5e-3;  // relative to the fall: the wire pushes the rope aside at first
    for (const Case& c : {Case{0.6, 1e-5, 0.0, {8, 2}},
                          {0.6, 5e-5, 0.0, {8, 2}},
                          {0.6, 2e-4, 0.0, {8, 2}},
                          {0.6, -1e-5, 0.0, {8, 2}},
                          {0.6, -2e-4, 0.0, {8, 2}},
                          {0.6, 2e-4, 1e-3, {8, 2}},
                          {0.6, 2e-4, 0.0, {20, 4}},
                          {2.0, 5e-5, 0.0, {8, 2}},
                          {2.0, -2e-4, 0.0, {8, 2}}}) {
        for (const double damping : {0.0, kDamping}) {
            RopeCase rope;
            rope.open_degrees = c.open_degrees;
            rope.beside = c.beside;
            rope.height = c.height;
            rope.cells = c.cells;
            rope.damping = damping;
            rope.is_given = false;
            SCOPED_TRACE(describe(rope));
            ClothRun run = make_rope_run(rope);
            constexpr double kDuration = 0.2;  // s
            const double start = measure_displacement(run);
            run.advance(kDuration, kStep);
            EXPECT_EQ(run.state.crossings, 0);
            const double fall = 0.5 * kG * kDuration * kDuration;
            EXPECT_NEAR((measure_displacement(run) - start) / fall, 1.0, kFallError);
        }
    }
}

// A hard case: the open sides swing shut and hit each other, faster than they slide. The impact dissipates
// some of their energy. Without damping the sides crumple, which slows the rope further.
TEST(RopeOverWire, SlidesOffThoughItsSidesClap)
{
    Table table("rope_clap", {"degrees open", "damping, s", "pattern", "turned by", "cells", "y over cosh",
                              "energy gained / exchanged"});
    const double duration = kShare * kLiftOff, exchanged = exchanged_energy(duration);
    for (const auto& [open, least] : {std::pair(2.0, 0.995), {10.0, 0.99}, {40.0, 0.95}})
        for (const double damping : {0.0, kDamping})
            for (const auto& [pattern, angle] : {std::pair(GridPattern::Diagonal, 0.0),
                                                 {GridPattern::Diagonal, 17.0},
                                                 {GridPattern::Cross, 17.0},
                                                 {GridPattern::Unstructured, 0.0}})
                for (const std::array<int, 2> cells : {std::array{8, 2}, {16, 4}, {32, 8}}) {
                    const FailuresSince failures;
                    const bool is_diagonal = pattern == GridPattern::Diagonal,
                               is_first = is_diagonal && angle == 0.0;
                    const bool is_quick = is_first ? cells[0] <= 16 : !is_diagonal && cells[0] == 32;
                    if (!is_deep() && !is_quick) continue;
                    RopeCase rope;
                    rope.cells = cells;
                    rope.pattern = pattern;
                    rope.pattern_angle = angle;
                    rope.open_degrees = open;
                    rope.damping = damping;
                    ClothRun run = make_rope_run(rope);
                    const EnergySpan energy =
                        watch_energy(run, duration, kStep, [&](const StepReport& report) {
                            EXPECT_EQ(report.crossings, 0) << describe(rope);
                            EXPECT_EQ(validate(run.state.mesh), "") << describe(rope);
                        });
                    if (failures.any()) {
                        ADD_FAILURE() << describe(rope);
                        continue;
                    }
                    const double gained = (energy.greatest - energy.first) / exchanged;
                    const double share = measure_displacement(run) / displacement(duration);
                    EXPECT_LT(gained, damping > 0.0 ? kRise : kClapRise) << describe(rope);
                    EXPECT_LT(share, 1.002) << describe(rope);
                    if (damping > 0.0) {
                        EXPECT_GT(share, least) << describe(rope);
                    }
                    table.add({fmt::format("{:g}", open), fmt::format("{:g}", damping), name_of(pattern),
                               fmt::format("{:g}", angle), fmt::format("{}", cells[0]),
                               fmt::format("{:.3f}", share), fmt::format("{:.1e}", std::max(gained, 0.0))});
                }
}

/// y at which a rope begins to slide, m.
double find_onset(double friction, double open_degrees)
{
    const double e = std::exp(friction * (180.0 - open_degrees) * M_PI / 180.0);
    return 0.5 * kLength * (e - 1.0) / (e + 1.0);
}

TEST(RopeOverWire, SlidesByTheCapstansLaw)
{
    constexpr double kDuration = 0.3;  // s
    constexpr double kError = 5e-3;    // relative to the way
    for (RopeCase rope : {RopeCase{.friction = 0.1}, RopeCase{.cells = {4, 2}, .friction = 0.3},
                          RopeCase{.friction = 0.3}, RopeCase{.cells = {16, 2}, .friction = 0.3},
                          RopeCase{.pattern = GridPattern::Cross, .segments = 37, .friction = 0.3},
                          RopeCase{.friction = 0.5}}) {
        rope.start = 1.1 * find_onset(rope.friction, rope.open_degrees);
        ClothRun run = make_rope_run(rope);
        run.advance(kDuration, kStep);
        const double way = displacement_with_friction(rope, kDuration) - rope.start;
        EXPECT_NEAR((measure_displacement(run) - rope.start) / way, 1.0, kError)
            << describe(rope) << ", friction " << rope.friction;
    }
}

TEST(RopeOverWire, RestsBelowTheOnsetOfTheCapstansLaw)
{
    constexpr double kElastic =
        1e-5;  // m: the rope stretches under its weight, and friction holds its stretch
    for (const double friction : {0.1, 0.3, 0.5}) {
        RopeCase rope{.friction = friction};
        rope.start = 0.98 * find_onset(friction, rope.open_degrees);
        ClothRun run = make_rope_run(rope);
        run.advance(0.6, kStep);
        EXPECT_NEAR(measure_displacement(run), rope.start, kElastic) << friction;
    }
}

/// Mean velocity of the rope along its wire, m/s.
double speed_along_wire(const ClothRun& run)
{
    double sum = 0.0;
    for (const Vec3& v : run.state.velocity) sum += v.y();
    return sum / static_cast<double>(run.state.velocity.size());
}

// Along the wire the pressure around the whole turn phi slip_contacts: phi / 2 times the sum of both
// tensions, while their resultant is only sin(phi / 2) times that sum. The short sides keep the rope tight on
// its whole width.
TEST(RopeOverWire, SlidesAlongItsWireByMuTimesHalfItsTurn)
{
    constexpr double kDuration = 0.2;  // s
    constexpr double kError = 5e-3;    // relative: the sides hang a little off the wire's plane
    for (const double friction : {0.1, 0.3, 0.5}) {
        RopeCase rope{.cells = {2, 6}, .start = 0.0, .friction = friction, .length = 0.2};
        const double share = 0.5 * friction * (180.0 - rope.open_degrees) * M_PI / 180.0;
        rope.lean = std::atan(share) + 0.05;
        ClothRun above = make_rope_run(rope);
        above.advance(kDuration, kStep);
        const double expected = kDuration * kG * (std::sin(rope.lean) - share * std::cos(rope.lean));
        EXPECT_NEAR(speed_along_wire(above) / expected, 1.0, kError) << friction;
        rope.lean = std::atan(share) - 0.01;
        ClothRun below = make_rope_run(rope);
        below.advance(kDuration, kStep);
        EXPECT_NEAR(speed_along_wire(below), 0.0, 1e-12) << friction;
    }
}

}  // namespace
}  // namespace arris
