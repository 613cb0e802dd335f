// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth slides over a straight edge on EOL vertices. On any mesh it must move as a chain over a pulley.
#include "sliding_strip.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth_run.h"
#include "geometry/cloth/mesh_quality.h"
#include "grid_patterns.h"
#include "physics/system/feature_impulse.h"
#include "refinement.h"
#include "tests/failures_since.h"

namespace arris {
namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;
constexpr double kStep = 0.005;  // s
constexpr double kShare = 0.9;   // share of the time until lift-off over which errors are measured
// Error of BDF2 at 5 ms, relative to x. Measured at a table's edge: 3.4e-4.
constexpr double kTimeError = 5e-4;
constexpr double kMeshError =
    1e-5;  // allowed effect of the mesh, relative to x: K > 0 bends and finite E stretches the strip
constexpr double kRise = 1e-4;  // allowed rise of energy over its start, relative to the energy exchanged
constexpr double kLoss = 0.01;  // allowed loss by BDF2, relative to the energy exchanged
constexpr double kAreaTolerance = 1e-12;  // round-off over some 100 faces, relative to the area
constexpr double kOnEdge = 1e-6;          // m, 0.1 % of the stand-off: stretch lifts a vertex by less

std::string describe(const StripCase& strip)
{
    return fmt::format("{} x {} cells, {}, turned by {}; slopes {:.0f} and {:.0f}, E {:g}, K {:g}",
                       strip.cells[0], strip.cells[1], name_of(strip.pattern), strip.pattern_angle,
                       strip.slopes.before / kDegrees, strip.slopes.after / kDegrees, strip.youngs_modulus,
                       strip.bending_stiffness);
}

SlidingChain chain_of(const StripCase& strip)
{
    return SlidingChain(strip.slopes, strip.length, strip.start);
}

double most_of_the_way(const StripCase& strip)
{
    return kShare * chain_of(strip).lift_off();
}

bool has_edge(const ClothMesh& mesh, int a, int b)
{
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& face) {
        return std::count(face.begin(), face.end(), a) + std::count(face.begin(), face.end(), b) == 2;
    });
}

/// Checks that the faces are positive and cover the whole material. EOL vertices must lie along the whole
/// edge, joined by mesh edges.
void expect_sound(const StripCase& strip, const State& state)
{
    EXPECT_EQ(validate(state.mesh), "");
    EXPECT_NEAR(material_area(state.mesh) / (strip.length * strip.width), 1.0, kAreaTolerance);
    std::vector<std::pair<double, int>> trace;  // coordinate along the edge, vertex
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        trace.emplace_back(state.mesh.material[v].y(), v);
        EXPECT_LT(distance_from_bend(strip, state.time, state.mesh.world[v]), kOnEdge);
    }
    std::sort(trace.begin(), trace.end());
    ASSERT_GE(trace.size(), 2u) << "at " << state.time << " s";
    EXPECT_EQ(trace.front().first, 0.0);
    EXPECT_EQ(trace.back().first, strip.width);
    for (std::size_t k = 1; k < trace.size(); ++k)
        EXPECT_TRUE(has_edge(state.mesh, trace[k - 1].second, trace[k].second))
            << "at " << state.time << " s";
}

/// Result of one run.
struct Slide {
    double length = 0.0;  ///< x at the end, m
    double error = 0.0;   ///< of x, relative
    double rise = 0.0;    ///< greatest energy over its start, relative to the energy exchanged until the end
    double loss = 0.0;    ///< energy lost at the end, relative to the energy exchanged
};

Slide slide(const StripCase& strip, double duration, double dt)
{
    SCOPED_TRACE(describe(strip));
    ClothRun run = make_strip_run(strip);
    const EnergySpan energy = watch_energy(run, duration, dt, [&](const StepReport& report) {
        EXPECT_EQ(report.rewound, 0);
        if (!strip.has_eol) return;
        EXPECT_EQ(report.feature_rows, 0) << "at " << run.state.time << " s";
        expect_sound(strip, run.state);
    });
    const SlidingChain chain = chain_of(strip);
    const double exchanged = strip_mass(strip) * 0.5 * std::pow(chain.speed(duration), 2);
    Slide found;
    found.length = measure_length_after(strip, run);
    found.error = std::abs(found.length / chain.length_after(duration) - 1.0);
    found.rise = (energy.greatest - energy.first) / exchanged;
    found.loss = (energy.first - energy.last) / exchanged;
    return found;
}

std::string percent(double share)
{
    return fmt::format("{:.4f} %", 100.0 * share);
}

void expect_order(Integrator integrator, const std::vector<double>& steps, double least, double most,
                  Table& table)
{
    StripCase strip;
    strip.integrator = integrator;
    std::vector<double> errors;
    for (const double h : steps) {
        const Slide found = slide(strip, most_of_the_way(strip), h);
        errors.push_back(found.error);
        EXPECT_LT(found.rise, kRise);
        table.add({integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                   fmt::format("{:g} ms", 1e3 * h), percent(found.error), fmt::format("{:.1e}", found.loss)});
    }
    const double order = order_of(steps, errors);
    EXPECT_GT(order, least);
    EXPECT_LT(order, most);
}

TEST(SlidingStrip, ConvergesAtTheIntegratorsOrder)
{
    Table table("sliding_order", {"integrator", "step", "error of x", "energy lost / exchanged"});
    expect_order(Integrator::ImplicitEuler, {0.01, 0.005, 0.0025}, 0.95, 1.05, table);
    expect_order(Integrator::Bdf2, {0.01, 0.005, 0.0025, 0.00125}, 1.85, 2.1, table);
}

TEST(SlidingStrip, IsAChainOnAnyMesh)
{
    Table table("sliding_meshes", {"pattern", "turned by", "cells", "error of x", "energy lost / exchanged"});
    double least = 1.0, most = 0.0;  // range of x over all meshes
    for (const GridPattern pattern : kPatterns)
        for (const double angle : {0.0, 17.0, 45.0})
            for (const std::array<int, 2> cells : {std::array{4, 1}, {8, 2}, {16, 4}, {32, 8}, {64, 16}}) {
                const FailuresSince failures;
                if (cells[0] > 16 && !is_deep()) continue;
                // An unstructured mesh has no direction to turn.
                if (pattern == GridPattern::Unstructured && angle > 0.0) continue;
                StripCase strip;
                strip.pattern = pattern;
                strip.pattern_angle = angle;
                strip.cells = cells;
                const Slide found = slide(strip, most_of_the_way(strip), kStep);
                if (failures.any()) {
                    ADD_FAILURE() << describe(strip);
                    continue;
                }
                EXPECT_LT(found.error, kTimeError) << describe(strip);
                EXPECT_LT(found.rise, kRise) << describe(strip);
                EXPECT_LT(found.loss, kLoss) << describe(strip);
                least = std::min(least, found.length);
                most = std::max(most, found.length);
                table.add({name_of(pattern), fmt::format("{:g}", angle), fmt::format("{}", cells[0]),
                           percent(found.error), fmt::format("{:.1e}", found.loss)});
            }
    EXPECT_LT(most / least - 1.0, kMeshError);
}

TEST(SlidingStrip, TakesHalfACellInOneStepAndIsTheSame)
{
    constexpr double kLong = 0.0125;       // s
    constexpr double kLongError = 2.5e-3;  // error of BDF2, relative to x
    double lengths[2] = {};
    for (const int k : {0, 1}) {
        StripCase strip;
        strip.cells = k == 0 ? std::array{8, 2} : std::array{32, 8};
        SCOPED_TRACE(describe(strip));
        ClothRun run = make_strip_run(strip);
        const double duration = most_of_the_way(strip), steps = std::ceil(duration / kLong);
        const EnergySpan energy = watch_energy(run, duration, kLong, [&](const StepReport& report) {
            // BDF2 makes the last two thirds of the first step.
            const bool is_first = run.state.time < 1.5 * duration / steps;
            EXPECT_NEAR(report.dt, (is_first ? 2.0 / 3.0 : 1.0) * duration / steps, 1e-12)
                << "at " << run.state.time << " s";
            expect_sound(strip, run.state);
        });
        const SlidingChain chain = chain_of(strip);
        lengths[k] = measure_length_after(strip, run);
        EXPECT_LT(std::abs(lengths[k] / chain.length_after(duration) - 1.0), kLongError);
        EXPECT_LT(energy.greatest - energy.first,
                  kRise * strip_mass(strip) * 0.5 * std::pow(chain.speed(duration), 2));
        if (k == 0) continue;
        EXPECT_GT(chain.speed(duration) * duration / steps, 0.45 * strip.length / 32);
    }
    EXPECT_LT(std::abs(lengths[1] / lengths[0] - 1.0), 3.0 * kMeshError);
}

TEST(SlidingStrip, FollowsAnyTwoSlopes)
{
    Table table("sliding_slopes", {"before", "after", "pattern", "until", "error of x"});
    for (const auto& [before, after] : {std::pair{20.0, 65.0},
                                        {0.0, 30.0},
                                        {30.0, 60.0},
                                        {-20.0, 45.0},
                                        {-10.0, 10.0},
                                        {-30.0, 90.0},
                                        {-60.0, 60.0}})
        for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross}) {
            const FailuresSince failures;
            StripCase strip;
            strip.slopes = {before * kDegrees, after * kDegrees};
            strip.pattern = pattern;
            strip.start = std::max(chain_of(strip).balance(), 0.0) + 0.1;
            const double end = most_of_the_way(strip);
            const Slide found = slide(strip, end, kStep);
            if (failures.any()) {
                ADD_FAILURE() << describe(strip);
                continue;
            }
            // In a short run the lag of BDF2's first step is a noticeable part of x.
            const SlidingChain chain = chain_of(strip);
            const double ahead =
                kBdf2StartLag * kStep * kStep * chain.acceleration(0.0) / chain.length_after(end);
            EXPECT_LT(found.error, kTimeError + ahead) << describe(strip);
            EXPECT_LT(found.rise, kRise) << describe(strip);
            EXPECT_LT(found.loss, kLoss) << describe(strip);
            table.add({fmt::format("{:g}", before), fmt::format("{:g}", after), name_of(pattern),
                       fmt::format("{:.3f} s", end), percent(found.error)});
        }
}

TEST(SlidingStrip, IsTheSameWhereverAndHoweverFastItIsCarried)
{
    // Relative to x. Round-off at 1 km, 2e-13 m, accumulates over the steps.
    constexpr double kCarriedTolerance = 1e-8;
    const StripCase strip;
    const double end = most_of_the_way(strip);
    const double length = slide(strip, end, kStep).length;
    StripCase placed = strip;
    placed.place.rotation = rotation_about(Vec3(1.0, 2.0, 3.0), 77.0);
    placed.place.translation = Vec3(1000.0, -300.0, 50.0);
    EXPECT_NEAR(slide(placed, end, kStep).length / length, 1.0, kCarriedTolerance);
    StripCase carried = strip;
    carried.carried = Vec3(3.0, -2.0, 5.0);
    EXPECT_NEAR(slide(carried, end, kStep).length / length, 1.0, kCarriedTolerance);
}

/// Impulse on the table's side from the EOL vertices in the last step, N s: tension less the flow of
/// momentum. The table's top bears the other component, which includes the weight of the half cell on it.
double push_of_side(const ClothRun& run)
{
    const Vec3 outward = Vec3::UnitX();  // normal of the table's side
    ClothMesh begin = run.state.mesh;
    begin.world = run.state.previous_world;
    double sum = 0.0;
    for (const Vec3& impulse : compute_feature_impulses(begin, run.work.mesh.elements, run.work.mesh.terms,
                                                        run.work.linearization, run.work.solution.velocity))
        sum += outward.dot(impulse);
    return sum;
}

/// Last times, s, at which the EOL vertices on the edge pressed at all, and pressed on the table's side.
struct LastPress {
    double at_all = 0.0, on_side = 0.0;
};

LastPress last_press(const StripCase& strip, double duration, double dt)
{
    SCOPED_TRACE(describe(strip));
    ClothRun run = make_strip_run(strip);
    LastPress last;
    const int steps = static_cast<int>(std::ceil(duration / dt - 1e-9));
    for (int k = 1; k <= steps; ++k) {
        run.advance(k * dt - run.state.time);
        const bool presses =
            std::any_of(run.state.active.begin(), run.state.active.end(), [&](const ActiveContact& contact) {
                return run.state.eol_entry(contact.vertex_ids[0]) >= 0 && contact.multiplier > 0.0;
            });
        if (presses) last.at_all = run.state.time;
        if (presses && push_of_side(run) > 0.0) last.on_side = run.state.time;
    }
    return last;
}

// The strip lifts off when turning its material around the edge takes all its tension. From then on the
// table's side bears no impulse. The EOL vertices stay a little longer, because they also carry the weight of
// the half cell on the table.
TEST(SlidingStrip, LiftsOffWhenTurningItsMaterialTakesAllTension)
{
    constexpr double kWatched = 1.06;  // over the time until lift-off: 4 cells lift off at 1.04
    Table table("sliding_lift_off", {"cells", "step", "side bears last at", "last presses at", "lift-off"});
    for (const double dt : {kStep, 0.001})
        for (const int cells : {4, 8, 16, 32, 64}) {
            if (cells > 32 && !is_deep()) continue;
            StripCase strip;
            strip.cells = {cells, std::max(cells / 4, 1)};
            const SlidingChain chain = chain_of(strip);
            const double exact = chain.lift_off();
            const LastPress last = last_press(strip, kWatched * exact, dt);
            EXPECT_NEAR(last.on_side, exact, dt) << describe(strip);
            EXPECT_GT(last.at_all, exact - dt) << describe(strip);
            EXPECT_LT(last.at_all, chain.lift_off(0.25 / cells) + dt) << describe(strip);
            table.add({fmt::format("{}", cells), fmt::format("{:g} ms", 1e3 * dt),
                       fmt::format("{:.4f} s", last.on_side), fmt::format("{:.4f} s", last.at_all),
                       fmt::format("{:.4f} s", exact)});
        }
}

TEST(SlidingStrip, SnagsWithoutEolVertices)
{
    for (const std::array<int, 2> cells : {std::array{4, 1}, {16, 4}}) {
        StripCase strip;
        strip.has_eol = false;
        strip.cells = cells;
        EXPECT_GT(slide(strip, most_of_the_way(strip), kStep).error, 100.0 * kTimeError);
    }
}

/// Greatest distance, m, that a strip slides in 1 s from its equilibrium over a ridge.
double creep(StripCase strip)
{
    SCOPED_TRACE(describe(strip));
    ClothRun run = make_strip_run(strip);
    const double first = measure_length_after(strip, run);
    double most = 0.0;
    for (int k = 1; k <= 200 && !run.failures.any(); ++k) {
        EXPECT_EQ(run.advance(k * kStep - run.state.time).feature_rows, 0);
        expect_sound(strip, run.state);
        most = std::max(most, std::abs(measure_length_after(strip, run) - first));
    }
    return most;
}

// The equilibrium is unstable: a displacement grows about e^3.2-fold in 1 s. The allowed slip is the
// displacement rho g L^2 / (2 E) by which the strip stretches as it settles.
TEST(SlidingStrip, DoesNotCreepInBalance)
{
    Table table("sliding_creep", {"E", "K", "pattern", "turned by", "cells", "slip in 1 s"});
    for (const double modulus : {2e4, 2e5})
        for (const double stiffness : {1e-7, 1e-4})
            for (const GridPattern pattern : kPatterns)
                for (const double angle : {0.0, 17.0})
                    for (const int cells : {4, 7, 16}) {
                        StripCase strip;
                        strip.slopes = {-20.0 * kDegrees, 45.0 * kDegrees};
                        strip.start = chain_of(strip).balance();
                        strip.youngs_modulus = modulus;
                        strip.bending_stiffness = stiffness;
                        strip.pattern = pattern;
                        strip.pattern_angle = angle;
                        strip.cells = {cells, std::max(cells / 4, 1)};
                        const double slip = creep(strip);
                        const double settling = 2e-5 * 2e4 / modulus;  // m
                        EXPECT_LT(slip, settling) << describe(strip);
                        table.add({fmt::format("{:g}", modulus), fmt::format("{:g}", stiffness),
                                   name_of(pattern), fmt::format("{:g}", angle), fmt::format("{}", cells),
                                   fmt::format("{:.1e} m", slip)});
                    }
}

void expect_identical(const State& a, const State& b)
{
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(a.next_id, b.next_id);
    EXPECT_EQ(a.previous_dt, b.previous_dt);
    EXPECT_TRUE(a.mesh.faces == b.mesh.faces);
    EXPECT_TRUE(a.mesh.world == b.mesh.world);
    EXPECT_TRUE(a.mesh.material == b.mesh.material);
    EXPECT_TRUE(a.velocity == b.velocity);
    EXPECT_TRUE(a.material_velocity == b.material_velocity);
    EXPECT_TRUE(a.previous_world == b.previous_world);
    EXPECT_TRUE(a.previous_velocity == b.previous_velocity);
    EXPECT_TRUE(a.previous_material == b.previous_material);
    EXPECT_TRUE(a.previous_material_velocity == b.previous_material_velocity);
    ASSERT_EQ(a.eol.size(), b.eol.size());
    for (std::size_t k = 0; k < a.eol.size(); ++k) {
        EXPECT_EQ(a.eol[k].vertex_id, b.eol[k].vertex_id);
        EXPECT_EQ(a.eol[k].outward, b.eol[k].outward);
        EXPECT_EQ(a.eol[k].idle, b.eol[k].idle);
    }
    ASSERT_EQ(a.active.size(), b.active.size());
    for (std::size_t k = 0; k < a.active.size(); ++k) {
        EXPECT_EQ(a.active[k].vertex_ids, b.active[k].vertex_ids);
        EXPECT_EQ(a.active[k].multiplier, b.active[k].multiplier);
    }
}

StripCase fine_strip()
{
    StripCase strip;
    strip.pattern = GridPattern::Unstructured;
    strip.cells = {16, 4};
    return strip;
}

TEST(SlidingStrip, IsAFunctionOfTheStateAlone)
{
    ClothRun run = make_strip_run(fine_strip()), cleared = make_strip_run(fine_strip());
    int changes = 0;
    for (int k = 1; k <= 130; ++k) {
        const int vertices = run.state.mesh.vertex_count();
        run.advance(k * kStep - run.state.time);
        cleared.work = Workspace();
        cleared.advance(k * kStep - cleared.state.time);
        ASSERT_NO_FATAL_FAILURE(expect_identical(run.state, cleared.state));
        ASSERT_FALSE(HasFailure()) << "at " << run.state.time << " s";
        changes += run.state.mesh.vertex_count() != vertices;
    }
    EXPECT_GT(changes, 5) << "the mesh gives way to the edge";
}

TEST(SlidingStrip, IsLeftAsItWasByAStepThatFails)
{
    ClothRun run = make_strip_run(fine_strip()), spared = make_strip_run(fine_strip());
    int overruns = 0;
    for (int k = 1; k <= 60; ++k) {
        const State before = run.state;
        // In 0.2 s more material would flow over the edge than the mesh has there.
        State tried = before;
        const StepReport report = step(run.scene, run.settings, run.state.time + 0.2, tried, run.work);
        if (report.status == StepStatus::Overrun) {
            ++overruns;
            ASSERT_NO_FATAL_FAILURE(expect_identical(before, tried));
        }
        // No solution meets a tolerance of zero.
        Settings strict = run.settings;
        strict.tolerance = 0.0;
        EXPECT_EQ(step(run.scene, strict, k * kStep, run.state, run.work).status, StepStatus::NotConverged);
        ASSERT_NO_FATAL_FAILURE(expect_identical(before, run.state));
        run.advance(k * kStep - run.state.time);
        spared.advance(k * kStep - spared.state.time);
        ASSERT_NO_FATAL_FAILURE(expect_identical(spared.state, run.state));
        ASSERT_FALSE(HasFailure()) << "at " << run.state.time << " s";
    }
    EXPECT_GT(overruns, 10);
}

}  // namespace
}  // namespace arris
