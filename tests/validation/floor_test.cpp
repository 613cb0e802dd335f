// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth on a plane: sliding down it without friction, and falling onto it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_import.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/forces/inertia.h"
#include "refinement.h"
#include "solver/advance.h"
#include "solver/energy_balance.h"
#include "tests/failures_since.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr std::array kIntegrators = {Integrator::ImplicitEuler, Integrator::Bdf2};
constexpr double kG = 9.81;
constexpr double kThickness = 1e-3;

constexpr double kOffset = 0.37;  // m

Vec3 normal_of(double angle)
{
    return {0.0, std::sin(angle), std::cos(angle)};
}

/// The obstacle under the cloth. Its upper plane leans by an angle about x and is kOffset from the origin.
enum class Ground { Slab, ImportedTable };

/// The ground's upper side is the plane. The imported table has triangles and legs, and its top is 0.6 m
/// wide.
MovingObstacle make_ground(Ground ground, const Vec3& normal)
{
    if (ground == Ground::Slab) return make_floor(normal, kOffset);
    const Mat3 lean = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    ObstacleFile table = import_obstacle(ARRIS_SOURCE_DIR "/data/meshes/table.obj", {}, {});
    double top = 0.0;  // 0.73 m, rounded to the file's single precision
    for (const Vec3& p : table.mesh.points) top = std::max(top, p.z());
    const Placement placement{lean, lean * Vec3(0.25, 0.25, kOffset - top)};
    return MovingObstacle("table", std::move(table.mesh), placement, {}, 30.0);
}

Scene make_scene(double angle, bool has_gravity, Ground ground = Ground::Slab)
{
    Scene scene;
    scene.materials[0] = {0.05, 200.0, 0.3, 1e-4, 0.0, kThickness};
    if (has_gravity) scene.gravity = Gravity{Vec3(0.0, 0.0, -kG)};
    scene.obstacles.push_back(make_ground(ground, normal_of(angle)));
    return scene;
}

/// A flat sheet parallel to the floor, `gap` above its stand-off.
ClothMesh place_above(const Vec3& normal, double gap)
{
    ClothMesh mesh = make_sheet(Vec2(0.5, 0.5), {5, 5}, GridPattern::Cross);
    const Eigen::Quaterniond lean = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal);
    for (Vec3& x : mesh.world) x = lean * x + (kOffset + kThickness + gap) * normal;
    return mesh;
}

TEST(Incline, AcceleratesByGTimesTheSine)
{
    Table table("incline", {"integrator", "angle", "from", "a / (g sin) - 1"});
    for (const Integrator integrator : kIntegrators)
        for (const double degrees : {5.0, 20.0, 45.0})
            for (const bool is_crumpled : {false, true}) {
                const double angle = degrees * std::numbers::pi / 180.0;
                const Scene scene = make_scene(angle, true);
                ClothMesh mesh = place_above(normal_of(angle), is_crumpled ? 0.03 : 0.0);
                if (is_crumpled) {  // the cloth falls, and contacts open and close
                    std::mt19937_64 random(9);
                    std::uniform_real_distribution<double> noise(-0.01, 0.01);
                    for (Vec3& x : mesh.world) x += Vec3(noise(random), noise(random), noise(random));
                }
                ClothRun run(scene, mesh);
                run.settings.integrator = integrator;
                const Vec3 down(0.0, std::cos(angle), -std::sin(angle));
                double most_contacts = 0.0;
                const double t = 0.5, h = 0.005;
                for (int k = 0; k < 100; ++k)
                    most_contacts = std::max<double>(most_contacts, run.advance(h).contacts);
                EXPECT_GT(most_contacts, 0.0);
                const double mass = 0.05 * 0.25;
                const double speed =
                    linear_momentum(Material{0.05}, run.work.mesh.elements, run.state.velocity).dot(down) /
                    mass;
                const double error = speed / (kG * std::sin(angle) * t) - 1.0;
                EXPECT_LT(std::abs(error), 1e-3);
                if (!is_crumpled) {  // compare the path, too, allowing for the integrator's lag on a parabola
                    const double lag = integrator == Integrator::Bdf2 ? kBdf2StartLag * h * h : 0.5 * h * t;
                    const double path = kG * std::sin(angle) * (0.5 * t * t + lag);
                    for (std::size_t v = 0; v < mesh.world.size(); ++v)
                        EXPECT_NEAR((run.state.mesh.world[v] - mesh.world[v]).dot(down) / path, 1.0, 1e-9);
                }
                table.add({integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                           fmt::format("{:g}", degrees), is_crumpled ? "crumpled, 3 cm above" : "rest",
                           fmt::format("{:.1e}", error)});
            }
}

struct Impact {
    double rebound = 0.0;      ///< greatest normal speed away from the floor after the first contact, over V
    double jump = 0.0;         ///< greatest distance from the stand-off after the first contact, m
    double penetration = 0.0;  ///< greatest of the whole run, m
    double energy_rise = 0.0;  ///< greatest rise in a step, over the initial kinetic energy
};

Impact drop(Integrator integrator, double speed, double phase, bool has_gravity, Ground ground)
{
    const double h = 0.005;
    const Scene scene = make_scene(0.3, has_gravity, ground);
    const Vec3 n = normal_of(0.3);
    ClothRun run(scene, place_above(n, (3.0 + phase) * h * speed), -speed * n);
    run.settings.integrator = integrator;
    const auto energy = [&] {
        return kinetic_energy(Material{0.05}, run.work.mesh.elements, run.state.velocity);
    };
    const double first = energy();
    Impact impact;
    bool has_met = false;
    double before = first;
    for (int k = 0; k < 40; ++k) {
        has_met = run.advance(h).contacts > 0 || has_met;
        if (run.failures.any()) break;
        for (int v = 0; v < run.state.mesh.vertex_count(); ++v) {
            const double gap = n.dot(run.state.mesh.world[v]) - kOffset - kThickness;
            // Checked before round-off is corrected, too: the contact's bound must close the gap exactly.
            const Vec3 proposed =
                run.work.prediction.position[v] + run.work.prediction.gamma * run.state.velocity[v];
            const double proposed_gap = n.dot(proposed) - kOffset - kThickness;
            impact.penetration = std::max({impact.penetration, -gap, -proposed_gap});
            if (!has_met) continue;
            impact.jump = std::max(impact.jump, std::abs(gap));
            impact.rebound = std::max(impact.rebound, n.dot(run.state.velocity[v]) / speed);
        }
        impact.energy_rise = std::max(impact.energy_rise, (energy() - before) / first);
        before = energy();
    }
    EXPECT_TRUE(has_met);
    return impact;
}

void expect_no_rebound(Ground ground, const std::string& name)
{
    Table table(name, {"integrator", "V", "gravity", "rebound / V", "off the stand-off", "penetration",
                       "rise of kinetic energy"});
    constexpr double kRoundOff = 1e-13;  // m, for positions of about 1 m
    constexpr double kGive = 1e-5;       // share of the way of a step by which rows give way
    for (const Integrator integrator : kIntegrators)
        for (const bool has_gravity : {false, true})
            for (const double speed : {0.1, 1.0, 5.0}) {
                Impact worst;
                for (int k = 0; k < 20; ++k) {
                    const FailuresSince failures;
                    const Impact impact = drop(integrator, speed, k / 20.0, has_gravity, ground);
                    if (failures.any()) {
                        ADD_FAILURE() << "phase " << k;
                        continue;
                    }
                    worst.rebound = std::max(worst.rebound, impact.rebound);
                    worst.jump = std::max(worst.jump, impact.jump);
                    worst.penetration = std::max(worst.penetration, impact.penetration);
                    worst.energy_rise = std::max(worst.energy_rise, impact.energy_rise);
                }
                EXPECT_LT(worst.rebound, 0.01);
                // On an imported mesh edges and faces touch, too; their contacts are rows.
                const double give = ground == Ground::ImportedTable ? kGive * speed * 0.005 : 0.0;
                EXPECT_LT(worst.penetration, kRoundOff + give);
                EXPECT_LT(worst.jump, kRoundOff + give);
                if (!has_gravity) {
                    EXPECT_LT(worst.energy_rise, 1e-12);
                }
                table.add({integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                           fmt::format("{:g} m/s", speed), has_gravity ? "yes" : "no",
                           fmt::format("{:.1e}", worst.rebound), fmt::format("{:.1e} m", worst.jump),
                           fmt::format("{:.1e} m", worst.penetration),
                           has_gravity ? "" : fmt::format("{:.1e}", worst.energy_rise)});
            }
}

TEST(Impact, NeverReboundsOrJumpsAtAnyPhaseOfTheStep)
{
    expect_no_rebound(Ground::Slab, "impact");
}

TEST(Impact, HoldsOnAnImportedMesh)
{
    expect_no_rebound(Ground::ImportedTable, "impact_imported");
}

/// Stiff cloth is thrown at a toothed surface without gravity, so its energy may only fall.
struct Shock {
    double greatest = 0.0;  ///< kinetic, stretch and bending energy after the impact, over the initial energy
    double rise = 0.0;      ///< greatest rise in a step, over the initial energy
    double stretch = 0.0;   ///< greatest stretch energy, over the initial energy
    double solves = 0.0;    ///< mean number of solves in a step
};

Shock throw_at_teeth(Integrator integrator, double stiffness, double speed, double phase)
{
    const double h = 0.005;
    Scene scene;
    scene.materials[0] = {0.2, stiffness, 0.3, 1e-4, 0.0, kThickness};
    scene.obstacles.push_back(MovingObstacle("teeth", make_teeth({5, 0.1, 0.06, 0.6, 60.0}), {}, {}, 30.0));
    ClothMesh mesh = make_sheet(Vec2(0.6, 0.4), {18, 12}, GridPattern::Cross);
    for (Vec3& x : mesh.world) x += Vec3(-0.3, -0.2, 0.06 + kThickness + (3.0 + phase) * h * speed);
    ClothRun run(scene, mesh, Vec3(0.0, 0.0, -speed));
    run.settings.integrator = integrator;
    const auto energy = [&] {
        const State& state = run.state;
        return compute_cloth_energy(
            run.scene, run.work,
            {state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}});
    };
    const double first = energy().sum();
    double before = first;
    Shock shock;
    const auto accept = [&](const StepReport& report, bool) {
        const ClothEnergy now = energy();
        shock.rise = std::max(shock.rise, (now.sum() - before) / first);
        shock.stretch = std::max(shock.stretch, now.potential.stretch / first);
        shock.greatest = std::max(shock.greatest, now.sum() / first);
        shock.solves += report.solves;
        before = now.sum();
        return true;
    };
    constexpr int kSteps = 40;
    for (int k = 0; k < kSteps; ++k)
        EXPECT_FALSE(advance(run.scene, run.settings, run.state.time + h, run.state, run.work, accept));
    shock.solves /= kSteps;
    EXPECT_LT(before, 0.9 * first) << "it has met the teeth";
    return shock;
}

TEST(Impact, OfStiffClothOnTeethGainsNoEnergy)
{
    Table table("impact_stiff", {"integrator", "E", "V", "greatest energy / first", "rise in a step / first",
                                 "stretch / first", "solves a step"});
    // Allowed rise in a step, besides the energy of pushing cloth out to its stand-off at 0.1 m/s.
    constexpr double kRise = 0.003;
    const int phases = is_deep() ? 20 : 2;
    for (const Integrator integrator : kIntegrators)
        for (const double stiffness : {2e3, 1e6})
            for (const double speed : {1.0, 5.0}) {
                Shock worst;
                for (int k = 0; k < phases; ++k) {
                    const Shock shock =
                        throw_at_teeth(integrator, stiffness, speed, k / static_cast<double>(phases));
                    worst.greatest = std::max(worst.greatest, shock.greatest);
                    worst.rise = std::max(worst.rise, shock.rise);
                    worst.stretch = std::max(worst.stretch, shock.stretch);
                    worst.solves = std::max(worst.solves, shock.solves);
                }
                EXPECT_LT(worst.greatest, 1.0 + kRise);
                EXPECT_LT(worst.rise, kRise + 0.01 / (speed * speed));
                table.add({integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                           fmt::format("{:g} N/m", stiffness), fmt::format("{:g} m/s", speed),
                           fmt::format("{:.4f}", worst.greatest), fmt::format("{:.1e}", worst.rise),
                           fmt::format("{:.2f}", worst.stretch), fmt::format("{:.2f}", worst.solves)});
            }
}

}  // namespace
}  // namespace arris
