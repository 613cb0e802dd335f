// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of cloth on realistic obstacles: cloth never passes, sticks only where it should, and gains no
// energy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/check/penetration.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "physics/forces/inertia.h"
#include "solver/advance.h"
#include "solver/energy_balance.h"
#include "solver/step.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kStep = 0.005;  // s

ClothMesh make_sheet(double size, int cells, const Placement& place)
{
    ClothGrid grid;
    grid.size = {size, size};
    grid.resolution = {cells, cells};
    grid.pattern = GridPattern::Cross;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x = place(x - Vec3(0.5 * size, 0.5 * size, 0.0));
    return mesh;
}

MovingObstacle place(ObstacleMesh mesh, const Vec3& at = Vec3::Zero(), RigidMotion motion = {})
{
    return MovingObstacle("it", std::move(mesh), {Mat3::Identity(), at}, std::move(motion), 30.0);
}

/// A sphere with `rings` of faces from pole to pole, `around` faces in each.
ObstacleMesh make_sphere(double radius, int rings, int around)
{
    ObstacleMesh mesh;
    mesh.points.push_back({0, 0, radius});
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double polar = std::numbers::pi * i / rings, turn = 2.0 * std::numbers::pi * j / around;
            mesh.points.push_back(radius * Vec3(std::sin(polar) * std::cos(turn),
                                                std::sin(polar) * std::sin(turn), std::cos(polar)));
        }
    mesh.points.push_back({0, 0, -radius});
    const int last = static_cast<int>(mesh.points.size()) - 1;
    const auto at = [around](int i, int j) { return 1 + (i - 1) * around + j % around; };
    for (int j = 0; j < around; ++j) {
        mesh.faces.push_back({0, at(1, j), at(1, j + 1)});
        mesh.faces.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
        for (int i = 1; i < rings - 1; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// Cloth on obstacles. An independent penetration check follows each step.
struct ObstacleRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    int rewound = 0, yielded = 0, most_solves = 0;
    int solves = 0;             ///< of all steps
    double worst_gained = 0.0;  ///< J, greatest energy rise reported by an accepted part
    double driven = 0.0;        ///< J, work of moving obstacles and pins so far
    double worst_rise = -1.0;   ///< greatest energy rise of a part beyond that work, over the allowed rise

    ObstacleRun(std::vector<MovingObstacle> obstacles, ClothMesh mesh, const Vec3& velocity = Vec3::Zero(),
                bool has_gravity = true)
    {
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        if (has_gravity) scene.gravity = Gravity{};
        scene.obstacles = std::move(obstacles);
        state = make_state(scene, std::move(mesh), velocity);
    }

    StepStatus advance(double dt = kStep)
    {
        const auto accept = [this](const StepReport& report, bool) {
            weigh(report.dt);
            rewound += report.rewound;
            yielded += report.yielded;
            most_solves = std::max(most_solves, report.solves);
            solves += report.solves;
            worst_gained = std::max(worst_gained, report.energy_rise);
            for (const MovingObstacle& obstacle : scene.obstacles) expect_free(obstacle);
            return true;
        };
        prepare(scene, state, work);
        last_ = energy();
        const std::optional<StepReport> failed =
            arris::advance(scene, settings, state.time + dt, state, work, accept);
        return failed ? failed->status : StepStatus::Done;
    }

    void advance_all(int steps)
    {
        for (int k = 0; k < steps && !testing::Test::HasFailure(); ++k)
            ASSERT_EQ(advance(), StepStatus::Done) << "t = " << state.time;
    }

    void expect_free(const MovingObstacle& obstacle) const
    {
        std::vector<Vec3> positions;
        for (const Vec3& x : state.mesh.world)
            positions.push_back(obstacle.at(state.time).placement.inverse(x));
        const Penetration found = find_penetration(obstacle.shape(), positions, state.mesh.faces);
        EXPECT_FALSE(found.is_any()) << obstacle.name() << " in face " << found.face
                                     << " at t = " << state.time;
    }

    double kinetic() const { return kinetic_energy(scene.materials, work.mesh.elements, state.velocity); }
    ClothEnergy energy() const
    {
        return compute_cloth_energy(
            scene, work, {state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}});
    }
    double mass() const { return scene.materials[0].density * material_area(state.mesh); }
    Vec3 centre() const
    {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& x : state.mesh.world) sum += x;
        return sum / static_cast<double>(state.mesh.world.size());
    }

  private:
    /// Compares a part's energy rise with its allowance. The allowance is kShare of the kinetic and exchanged
    /// energy, plus kMean of the driving work, plus the energy of a push. The work counts a mean force as
    /// that at the end. A push moves cloth out to its stand-off at up to kPush.
    void weigh(double dt)
    {
        constexpr double kShare = 0.003, kMean = 0.25, kPush = 0.1;  // kPush in m/s
        State before = state;
        before.mesh.world = state.previous_world;
        work.proposal.velocity = state.velocity;
        const double drive = compute_driven_work(before, work), work_done = std::max(drive, 0.0);
        const ClothEnergy now = energy();
        const double exchanged = std::abs(now.kinetic - last_.kinetic) +
                                 std::abs(now.potential.gravity - last_.potential.gravity) +
                                 std::abs(now.potential.stretch - last_.potential.stretch) +
                                 std::abs(now.potential.bending - last_.potential.bending);
        const double pushed = mass() * (0.5 * kPush * kPush + 9.81 * kPush * dt);
        worst_rise = std::max(worst_rise,
                              (now.sum() - last_.sum() - work_done) /
                                  (kShare * (last_.kinetic + exchanged) + kMean * std::abs(drive) + pushed));
        driven += work_done;
        last_ = now;
    }

    ClothEnergy last_;
};

/// Cloth is thrown down on a small or thin obstacle, with a vertex, an edge or a face above its middle.
class Fall : public testing::TestWithParam<double> {};

TEST_P(Fall, OnAThinPlateStopsAboveIt)
{
    for (const double offset : {0.0, 0.013}) {
        ObstacleRun run({place(make_box({0.8, 0.8, 1e-3}))},
                        make_sheet(0.6, 12, {rotation_about(Vec3::UnitZ(), 20), Vec3(offset, 0, 0.07)}),
                        Vec3(0, 0, -GetParam()));
        run.advance_all(30);
        for (const Vec3& x : run.state.mesh.world) EXPECT_GT(x.z(), 0.0);
        EXPECT_EQ(run.rewound, 0);
    }
}

TEST_P(Fall, OnAWireHangsOnIt)
{
    for (const double offset : {0.0, 0.011}) {
        ObstacleRun run({place(make_wire({{0, -1, 0}, {0, 1, 0}}, false))},
                        make_sheet(0.6, 12, {rotation_about(Vec3::UnitZ(), 20), Vec3(offset, 0, 0.07)}),
                        Vec3(0, 0, -GetParam()));
        run.advance_all(25);
        // The cloth still lies over the whole wire; otherwise it would be far below.
        for (const double y : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
            double highest = -1e9;
            for (const Vec3& x : run.state.mesh.world)
                if (std::abs(x.y() - y) < 0.05) highest = std::max(highest, x.z());
            EXPECT_GT(highest, -0.02) << "at y = " << y;
        }
        EXPECT_EQ(run.rewound, 0);
    }
}

TEST_P(Fall, OnANailIsHeldByIt)
{
    for (const Vec3& nail :
         {Vec3(0, 0, 0), Vec3(0.017, 0.0, 0), Vec3(0.012, 0.009, 0)}) {  // above a vertex, an edge, a face
        ObstacleRun run({place(make_points({nail}))},
                        make_sheet(0.6, 12, {Mat3::Identity(), Vec3(0, 0, 0.07)}), Vec3(0, 0, -GetParam()));
        run.advance_all(15);
        // The nail has not passed through the cloth: some cloth stays at its height.
        double highest = -1e9;
        for (const Vec3& x : run.state.mesh.world) highest = std::max(highest, x.z());
        EXPECT_GT(highest, -0.03);
        EXPECT_EQ(run.rewound, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, Fall, testing::Values(2.0, 5.0, 20.0));

TEST(ConvexEdge, ABorderAlongItCanBePulledBothWays)
{
    for (const double force : {-0.02, 0.02})
        for (const double height : {1e-3, 1.5e-3}) {
            // The cloth lies on the box's top; its border is exactly above the box's edge x = 0.
            ObstacleRun run({place(make_box({1, 1, 0.2}), {-0.5, 0, -0.1})},
                            make_sheet(0.4, 8, {Mat3::Identity(), Vec3(-0.2, 0, height)}), Vec3::Zero(),
                            false);
            Pull pull;
            pull.material = {Vec2(0, 0), Vec2(0.4, 0.4)};
            pull.force = Vec3(force, 0, 0);
            run.scene.pulls = {pull};
            run.settings.integrator = Integrator::ImplicitEuler;
            const double mass = 0.05 * 0.16, before = run.centre().x();
            run.advance_all(20);
            const double t = 20 * kStep;
            EXPECT_NEAR(run.centre().x() - before, 0.5 * force / mass * t * (t + kStep), 1e-9);
        }
}

TEST(Hollow, ClothInAClosedBoxStaysInIt)
{
    // Walls 5 cm thick: an outer shell and a cavity.
    ObstacleMesh hollow = make_box({0.6, 0.6, 0.6});
    const ObstacleMesh cavity = make_box({0.5, 0.5, 0.5});
    for (const Face& f : cavity.faces) hollow.faces.push_back({f[0] + 8, f[2] + 8, f[1] + 8});
    hollow.points.insert(hollow.points.end(), cavity.points.begin(), cavity.points.end());
    RigidMotion shake;
    shake.angular_velocity = Vec3(5, 0, 0);
    shake.velocity = Vec3(0.3, 0, 0);
    ObstacleRun run({place(hollow, Vec3::Zero(), shake)},
                    make_sheet(0.48, 8, {rotation_about(Vec3(1, 1, 0), 8), Vec3(0, 0, 0)}));
    run.advance_all(200);
    for (const Vec3& x : run.state.mesh.world)
        EXPECT_LT((run.scene.obstacles[0].at(run.state.time).placement.inverse(x)).cwiseAbs().maxCoeff(),
                  0.25);
}

TEST(Fin, ClothHangsOnBothSidesOfIt)
{
    ObstacleRun run({place(make_box({0.002, 1.0, 0.4}), {0, 0, -0.2})},
                    make_sheet(0.5, 10, {rotation_about(Vec3::UnitZ(), 15), Vec3(0.02, 0, 0.01)}));
    run.advance_all(80);
    double left = 0, right = 0;
    for (const Vec3& x : run.state.mesh.world) {
        left = std::min(left, x.x());
        right = std::max(right, x.x());
    }
    EXPECT_LT(run.centre().z(), -0.02);
    EXPECT_LT(left, -0.01);
    EXPECT_GT(right, 0.01);
}

TEST(Crush, AGapOfLessThanTwoStandOffsYields)
{
    // A lid comes down on cloth on a floor and stops 1.2 mm above it.
    RigidMotion down;
    down.velocity = Vec3(0, 0, -0.1);
    down.stop = 0.1;
    ObstacleRun run({make_floor(), place(make_box({0.5, 0.5, 0.1}), {0, 0, 0.0612}, down)},
                    make_sheet(0.3, 6, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    run.advance_all(40);
    for (const Vec3& x : run.state.mesh.world) {
        EXPECT_GT(x.z(), 0.0);
        EXPECT_LT(x.z(), 0.0012);
    }
}

TEST(Crush, AGapBelowZeroIsInfeasibleAndNamesAVertex)
{
    RigidMotion down;
    down.velocity = Vec3(0, 0, -0.1);
    ObstacleRun run({make_floor(), place(make_box({0.5, 0.5, 0.1}), {0, 0, 0.06}, down)},
                    make_sheet(0.3, 6, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    StepStatus status = StepStatus::Done;
    for (int k = 0; k < 40 && status == StepStatus::Done; ++k) status = run.advance();
    EXPECT_EQ(status, StepStatus::Infeasible);
    EXPECT_GT(run.state.time, 0.08) << "it yielded as far as there was room";
}

TEST(Crush, PinsDrivenIntoATableAreInfeasibleAndLeaveTheStateAsItWas)
{
    for (const double youngs_modulus : {50.0, 2e4}) {
        ObstacleRun run({make_floor()}, make_sheet(0.3, 6, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
        run.scene.materials[0].youngs_modulus = youngs_modulus;
        Pin pin;
        pin.material = {Vec2(0.3, 0.0), Vec2(0.3, 0.3)};
        pin.motion.velocity = Vec3(0, 0, -1.0);
        run.scene.pins = {pin};
        run.state = make_state(run.scene, run.state.mesh, Vec3::Zero());
        const ClothMesh first = run.state.mesh;
        StepStatus status = StepStatus::Done;
        for (int k = 0; k < 5 && status == StepStatus::Done; ++k) status = run.advance();
        EXPECT_EQ(status, StepStatus::Infeasible) << youngs_modulus;
        EXPECT_EQ(run.state.mesh.material, first.material);
        for (const Vec3& x : run.state.mesh.world) EXPECT_GE(x.z(), 0.0);
    }
}

TEST(MovingObstacle, CarriesClothWithoutPushingEnergyIn)
{
    // A box that rises, stops, and sinks more slowly than cloth falls.
    RigidMotion motion;
    motion.keyframes = {{0.0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                        {0.1, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                        {0.3, {0, 0, 0.2}, Eigen::Quaterniond::Identity()},
                        {0.5, {0, 0, 0.2}, Eigen::Quaterniond::Identity()},
                        {0.9, {0, 0, 0.1}, Eigen::Quaterniond::Identity()}};
    ObstacleMesh box = make_box({1, 1, 0.2});
    for (Vec3& p : box.points) p.z() -= 0.1;
    ObstacleRun run({MovingObstacle("lift", box, {}, motion, 30.0)},
                    make_sheet(0.4, 8, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    for (int k = 0; k < 200; ++k) {
        const double t = run.state.time;
        for (const double jump : motion.jumps())
            if (std::abs(t - jump) < 1e-9) restart(run.state);
        ASSERT_EQ(run.advance(), StepStatus::Done);
        const double top = motion.at(run.state.time).translation.z();
        for (const Vec3& x : run.state.mesh.world) {
            ASSERT_GT(x.z() - top, 1e-3 - 1e-12);
            ASSERT_TRUE(run.state.time > 0.2999 || x.z() - top < 1e-3 + 1e-9) << run.state.time;
        }
        const bool is_rising = run.state.time > 0.15 && run.state.time < 0.2999;
        ASSERT_TRUE(!is_rising || std::abs(run.kinetic() - 0.5 * 0.05 * 0.16) < 1e-9);
    }
}

TEST(MovingObstacle, PulledAwayFromUnderAFoldPushesNoEnergyIn)
{
    // The moving edge covers 2 cm a step and no longer presses on anything.
    RigidMotion motion;
    motion.velocity = Vec3(-4, 0, 0);
    motion.start = 0.1;
    ObstacleMesh table = make_box({2, 2, 1});
    for (Vec3& p : table.points) p -= Vec3(1, 0, 0.5);
    ClothGrid grid;
    grid.size = {0.5, 0.3};
    grid.resolution = {8, 5};
    grid.pattern = GridPattern::Diagonal;
    ClothMesh sheet = make_cloth_grid(grid);
    for (Vec3& x : sheet.world) x += Vec3(-0.3, -0.15, 0.004);
    ObstacleRun run({MovingObstacle("table", table, {}, motion, 30.0)}, std::move(sheet));
    run.scene.materials[0] = {0.1, 2e4, 0.3, 1e-6, 0.002, 1e-3};
    run.scene.eol = make_initial_target(run.state.mesh);
    int most_eol = 0;
    for (int k = 0; k < 60; ++k) {
        for (const double jump : motion.jumps())
            if (std::abs(run.state.time - jump) < 1e-9) restart(run.state);
        ASSERT_EQ(run.advance(), StepStatus::Done);
        most_eol = std::max(most_eol, static_cast<int>(run.state.eol.size()));
        ASSERT_EQ(run.worst_gained, 0.0) << run.state.time;
    }
    EXPECT_GT(most_eol, 3);
}

/// Stiff cloth is thrown at a surface that is not flat. The linear solve of a step cannot foresee the strain
/// there.
struct Shock {
    Integrator integrator;
    double stiffness, speed, dt;  ///< N/m, m/s, s
};

class StiffImpact : public testing::TestWithParam<Shock> {
  protected:
    void expect_no_gain(std::vector<MovingObstacle> obstacles, const Vec3& start, int resolution)
    {
        const auto [integrator, stiffness, speed, dt] = GetParam();
        ObstacleRun run(std::move(obstacles),
                        make_sheet(0.6, resolution, {rotation_about(Vec3::UnitZ(), 20), start}),
                        Vec3(0, 0, -speed));
        run.scene.materials[0] = {0.2, stiffness, 0.3, 1e-4, 0.0, 1e-3};
        run.settings.integrator = integrator;
        prepare(run.scene, run.state, run.work);
        const double first = run.energy().sum();
        const double scale = 0.5 * run.mass() * speed * speed + run.mass() * 9.81 * 0.2;
        for (int k = 0; k < static_cast<int>(0.2 / dt); ++k) {
            ASSERT_EQ(run.advance(dt), StepStatus::Done) << run.state.time;
            ASSERT_FALSE(HasFailure());
            ASSERT_LT(run.worst_rise, 1.0) << "in a step before " << run.state.time;
            ASSERT_LT(run.energy().sum() - first, 0.01 * scale) << run.state.time;
        }
        EXPECT_LT(run.energy().sum() - first, -0.1 * scale) << "it has met something";
    }
};

TEST_P(StiffImpact, OnTeethGainsNoEnergy)
{
    expect_no_gain({place(make_teeth({5, 0.1, 0.06, 0.6, 60}))}, Vec3(0, 0, 0.08), 12);
}

TEST_P(StiffImpact, OnATableThatIsSmallerGainsNoEnergy)
{
    expect_no_gain({place(make_box({0.3, 0.3, 0.1}), {0.02, 0.03, -0.05})}, Vec3(0, 0, 0.02), 12);
}

TEST_P(StiffImpact, OnASphereGainsNoEnergy)
{
    expect_no_gain({place(make_sphere(0.2, 12, 24))}, Vec3(0.03, 0.01, 0.22), 12);
}

INSTANTIATE_TEST_SUITE_P(Shocks, StiffImpact,
                         testing::Values(Shock{Integrator::Bdf2, 2000, 5, 0.005},
                                         Shock{Integrator::ImplicitEuler, 2000, 5, 0.005},
                                         Shock{Integrator::Bdf2, 1e5, 2, 0.005},
                                         Shock{Integrator::Bdf2, 1e6, 20, 0.005},
                                         Shock{Integrator::Bdf2, 1e4, 5, 0.02}));

TEST(StiffCloth, JerkedByAPinGainsNoMoreThanThePinDoes)
{
    for (const Integrator integrator : {Integrator::Bdf2, Integrator::ImplicitEuler})
        for (const double dt : {0.005, 0.02}) {
            // A slack sheet on a floor; one edge is pulled away at 2 m/s, sideways and up, and stopped.
            ObstacleRun run({make_floor()}, make_sheet(0.6, 12, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
            run.scene.materials[0] = {0.4, 5000.0, 0.3, 1e-4, 0.0, 1e-3};
            run.settings.integrator = integrator;
            Pin pin;
            pin.material = {Vec2(0.6, 0.0), Vec2(0.6, 0.6)};
            pin.motion.velocity = Vec3(1.0, 0.3, 1.7);
            pin.motion.start = 0.04;
            pin.motion.stop = 0.3;
            run.scene.pins = {pin};
            run.state = make_state(run.scene, run.state.mesh, Vec3::Zero());
            prepare(run.scene, run.state, run.work);
            const double first = run.energy().sum();
            for (int k = 0; k < static_cast<int>(0.4 / dt); ++k) {
                for (const double jump : input_jumps(run.scene))
                    if (std::abs(run.state.time - jump) < 1e-9) restart(run.state);
                ASSERT_EQ(run.advance(dt), StepStatus::Done) << run.state.time;
                ASSERT_LT(run.worst_rise, 1.0) << "in a step before " << run.state.time;
                ASSERT_LT(run.energy().sum() - first, 1.05 * run.driven + 1e-3 * run.mass())
                    << run.state.time;
            }
            EXPECT_GT(run.driven, 0.5 * run.mass());
            EXPECT_LT(run.driven, 10.0 * run.mass() * pin.motion.velocity.squaredNorm())
                << "what bounds the energy is bounded too";
        }
}

TEST(StiffCloth, MovedOutToItsStandOffIsNotStrained)
{
    // The cloth falls 1 cm onto a table and overhangs it. Vertices that the rim lets nearer than the
    // thickness are pushed out.
    ObstacleRun run({place(make_box({0.6, 0.6, 0.1}), {0.02, 0.03, -0.05})},
                    make_sheet(0.8, 16, {Mat3::Identity(), Vec3(0, 0, 0.011)}));
    run.scene.materials[0] = {0.2, 1e6, 0.3, 1e-3, 0.0, 1e-3};
    prepare(run.scene, run.state, run.work);
    const double first = run.energy().sum();
    for (int k = 0; k < 40; ++k) {
        ASSERT_EQ(run.advance(), StepStatus::Done);
        ASSERT_LT(run.energy().sum() - first, 0.01 * run.mass() * 9.81 * 0.01) << run.state.time;
    }
}

TEST(StiffCloth, ThatOnlyRingsIsLeftAlone)
{
    // The cloth is stretched by 20 % or bent, then released. BDF2's energy may only fall, by its numerical
    // damping.
    for (const double stretch : {0.2, 0.0}) {
        ObstacleRun run({}, make_sheet(0.5, 10, {Mat3::Identity(), Vec3::Zero()}), Vec3::Zero(), false);
        run.scene.materials[0].bending_stiffness = 1e-3;
        for (Vec3& x : run.state.mesh.world)
            x = Vec3((1.0 + stretch) * x.x(), x.y(), stretch > 0.0 ? 0.0 : 0.3 * x.x() * x.x());
        run.advance_all(300);
        EXPECT_LE(run.solves, 330) << "only its fastest steps linearise again";
        EXPECT_LT(run.worst_rise, 1.0);
    }
}

TEST(Pin, FollowsAnObstacle)
{
    RigidMotion turn;
    turn.angular_velocity = Vec3(0, 0, 3);
    turn.velocity = Vec3(0.2, 0, 0);
    Scene scene;
    scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
    scene.obstacles.push_back(place(make_box({0.1, 0.1, 0.1}), {0.3, 0.2, 0.1}, turn));
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 1)};
    pin.follows = 0;
    scene.pins = {pin};
    State state = make_state(scene, make_sheet(0.4, 4, {Mat3::Identity(), Vec3(0, 0, -0.3)}), Vec3::Zero());
    const ClothMesh first = state.mesh;
    Workspace work;
    for (int k = 1; k <= 60; ++k)
        ASSERT_FALSE(
            advance(scene, Settings(), kStep * k, state, work, [](const StepReport&, bool) { return true; }));
    const Placement moved =
        scene.obstacles[0].at(state.time).placement * scene.obstacles[0].at(0.0).placement.inverse();
    for (const int v : vertices_inside(first, pin.material))
        EXPECT_NEAR((state.mesh.world[v] - moved(first.world[v])).norm(), 0.0, 1e-13);
    EXPECT_EQ(input_jumps(scene), std::vector<double>()) << "it never starts or stops after time 0";
}

}  // namespace
}  // namespace arris
