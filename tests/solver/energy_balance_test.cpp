// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/energy_balance.h"

#include <gtest/gtest.h>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kStep = 0.01;       // s
constexpr double kRoundOff = 1e-10;  // relative: the certificate's residual enters only linearly
const Vec3 kEverywhere(0, 0, 1e-3);  // m, the sheet's position: at its stand-off above z = 0

ClothMesh make_sheet(const Vec3& at = kEverywhere)
{
    ClothGrid grid;
    grid.size = {0.5, 0.4};
    grid.resolution = {5, 4};
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x += at;
    return mesh;
}

/// One step of implicit Euler of a sheet at rest, and the workspace after the step.
struct OneStep {
    Scene scene;
    Settings settings;
    State state, before;
    Workspace work;

    explicit OneStep(Scene a_scene, const Vec3& at = kEverywhere, double start = 0.0)
        : scene(std::move(a_scene))
    {
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        settings.integrator = Integrator::ImplicitEuler;
        state = make_state(scene, make_sheet(at), Vec3::Zero());
        state.time = start;
        before = state;
        EXPECT_EQ(step(scene, settings, start + kStep, state, work).status, StepStatus::Done);
        work.proposal.velocity = state.velocity;  // the commit has moved it into the state
        work.proposal.material_velocity = state.material_velocity;
    }

    std::vector<Vec3> end() const
    {
        return find_end(work.prediction, {work.proposal.velocity, work.proposal.material_velocity}).world;
    }

    double mass() const { return scene.materials[0].density * material_area(state.mesh); }
    void weigh()
    {
        work.proposal.world = end();
        measure_proposal_energy(scene, kStep, work);
    }
    bool does_push_out_strain_to(const std::vector<Vec3>& world)
    {
        work.proposal.world = world;
        measure_proposal_energy(scene, kStep, work);
        return does_push_out_strain(scene, kStep, work);
    }
    double driven() const { return compute_driven_work(before, work); }
};

/// A motion that starts at t = 1 s with `velocity` (m/s).
RigidMotion start_off(const Vec3& velocity)
{
    RigidMotion motion;
    motion.velocity = velocity;
    motion.start = 1.0;
    return motion;
}

// From rest to V in one step, the impulse m V acts over the distance h V / h. Its work m V^2 is twice the
// kinetic energy.

TEST(DrivenWork, OfPinsIsTheirImpulseTimesTheirWay)
{
    for (const std::array<bool, 3>& held : {std::array{true, true, true}, std::array{false, true, true}}) {
        Scene scene;
        Pin pin;
        pin.material = {Vec2(0, 0), Vec2(0.5, 0.4)};
        pin.held = held;
        pin.motion = start_off(Vec3(0, 0.4, -0.3));
        scene.pins = {pin};
        const OneStep one(scene, kEverywhere, 1.0);
        EXPECT_NEAR(one.driven() / (one.mass() * 0.25), 1.0, kRoundOff);
    }
}

TEST(DrivenWork, OfAnObstacleIsItsPressureTimesItsWay)
{
    Scene scene;
    ObstacleMesh slab = make_floor().shape().mesh();
    scene.obstacles.push_back(MovingObstacle("lift", slab, {}, start_off(Vec3(0.7, 0, 0.5)), 30.0));
    const OneStep one(scene, kEverywhere, 1.0);
    EXPECT_NEAR(one.driven() / (one.mass() * 0.25), 1.0, kRoundOff);
}

TEST(DrivenWork, OfATurningObstacleIsThatWhereTheClothIsWhereverItsPlaneIsNamed)
{
    Scene scene;
    RigidMotion motion = start_off(Vec3(0, 0, 0.5));
    motion.angular_velocity = Vec3(0, 0.5, 0);
    scene.obstacles.push_back(MovingObstacle("lift", make_floor().shape().mesh(), {}, motion, 30.0));
    OneStep one(scene, kEverywhere, 1.0);
    const double driven = one.driven();
    ASSERT_GT(driven, 0.0);
    for (Contact& contact : one.work.contacts) contact.local_point += Vec3(0.3, 0.0, 0.0);
    EXPECT_NEAR(one.driven() / driven, 1.0, kRoundOff);
}

TEST(DrivenWork, OfAPinAgainstAFixedObstacleIsThePinsAlone)
{
    Scene scene;
    scene.gravity = Gravity{};
    scene.obstacles.push_back(make_floor());
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0.5, 0.4)};
    pin.held = {true, false, false};
    pin.motion = start_off(Vec3(0.5, 0, 0));
    scene.pins = {pin};
    const OneStep one(scene, kEverywhere, 1.0);
    EXPECT_NEAR(one.driven() / (one.mass() * 0.25), 1.0, kRoundOff);
}

TEST(DrivenWork, OfAPullIsItsForceTimesTheWay)
{
    Scene scene;
    Pull pull;
    pull.material = {Vec2(0, 0), Vec2(0.5, 0.4)};
    pull.force = Vec3(0.02, 0.01, 0.0);
    scene.pulls = {pull};
    const OneStep one(scene);
    const double way = pull.force.norm() / one.mass() * kStep * kStep;
    EXPECT_NEAR(one.driven() / (pull.force.norm() * way), 1.0, kRoundOff);
}

TEST(DrivenWork, OfWindIsItsForceAtTheNewVelocityTimesTheWay)
{
    Scene scene;
    scene.wind = Wind{Vec3(0, 0, 4.0), 1.2, 1.0, std::nullopt};
    const OneStep one(scene);
    const double c = 0.5 * 1.2 * 0.2, w = 4.0;  // f = c w^2 - 2 c w v,   v = h f / m
    const double force = c * w * w / (1.0 + 2.0 * c * w * kStep / one.mass());
    const double way = force / one.mass() * kStep * kStep;
    EXPECT_NEAR(one.driven() / (force * way), 1.0, kRoundOff);
}

TEST(DrivenWork, OfAFeatureIsThatOfAllThatHoldsTheClothThere)
{
    // A knife starts to move under cloth that has three times as much material on one side, optionally
    // stretched there. That side pulls the fold across, with or against the knife's motion. The step from
    // rest is so short that strain hardly changes. Then R . (q' - q) is the gain of potential energy plus
    // v'^T M v'.
    constexpr double kShort = 1e-5;  // s
    for (const double stretch : {1.0, 1.03}) {
        for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.8, 0, 0.6), Vec3(-0.8, 0, 0.6)}) {
            testing::EolCloth cloth(testing::make_ridge(5.0), testing::make_draped({8, 0.0, 80.0}));
            MovingObstacle& knife = cloth.scene.obstacles[0];
            knife = MovingObstacle("knife", knife.shape().mesh(), {}, start_off(1e-3 * direction), 30.0);
            State& state = cloth.state;
            const double half = 40.0 * M_PI / 180.0;
            for (int v = 0; v < state.mesh.vertex_count(); ++v) {
                const Vec2& X = state.mesh.material[v];
                const double across = (X.x() > 0.1 ? stretch : 1.0) * (X.x() - 0.1);
                state.mesh.world[v] << across * std::sin(half), X.y() - 0.2,
                    testing::kThickness - std::abs(across) * std::cos(half);
                if (std::abs(across) < 1e-9) cloth.add_eol(v, false, testing::tip_of(knife.shape()));
            }
            state.time = 1.0;
            state.step = 1;  // so that no contact counts as pressing in an earlier step
            cloth.scene.materials[0].bending_stiffness = 0.0;
            const State before = state;
            Settings settings;
            settings.integrator = Integrator::ImplicitEuler;
            Workspace work;
            ASSERT_EQ(step(cloth.scene, settings, 1.0 + kShort, state, work).status, StepStatus::Done);
            ASSERT_EQ(state.mesh.faces, before.mesh.faces);
            work.proposal.velocity = state.velocity;
            work.proposal.material_velocity = state.material_velocity;
            const double kinetic = testing::kinetic_energy_of(cloth.scene, state);
            const double stored = testing::elastic_energy_of(cloth.scene, state.mesh) -
                                  testing::elastic_energy_of(cloth.scene, before.mesh);
            EXPECT_NEAR(compute_driven_work(before, work), 2.0 * kinetic + stored, 1e-2 * kinetic)
                << stretch << ", " << direction.transpose() << ": " << kinetic << ", " << stored;
        }
    }
}

TEST(DrivenWork, OfWhatDoesNotMoveIsNothing)
{
    Scene scene;
    scene.gravity = Gravity{};
    scene.obstacles.push_back(make_floor());
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 0.4)};
    scene.pins = {pin};
    EXPECT_EQ(OneStep(scene).driven(), 0.0);
}

TEST(EnergyRise, IsWhatNothingHasDriven)
{
    OneStep one{Scene()};
    one.weigh();
    EXPECT_EQ(find_energy_rise(one.scene, one.before, one.work), 0.0);
    for (Vec3& v : one.work.proposal.velocity) v = Vec3(0.3, 0, 0.4);
    one.weigh();
    EXPECT_NEAR(find_energy_rise(one.scene, one.before, one.work) / (0.125 * one.mass()), 1.0, kRoundOff);
}

TEST(EnergyRise, IsNoRoundOffOfASheetThatHangsFarAway)
{
    Scene scene;
    scene.gravity = Gravity{};
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0.5, 0.4)};
    scene.pins = {pin};
    for (const double far : {1.0, 1e3, 1e6}) {
        OneStep one(scene, Vec3(far, -far, far));
        std::vector<Vec3>& v = one.work.proposal.velocity;  // with round-off of coordinates of this size
        for (std::size_t i = 0; i < v.size(); ++i) v[i].z() = 1e-16 * far / kStep;
        one.weigh();
        EXPECT_EQ(find_energy_rise(one.scene, one.before, one.work), 0.0) << far;
    }
}

// Half of the sheet moves straight out of its plane. Its strain is of second order in the displacement, its
// energy of fourth.
TEST(UnforeseenEnergy, IsTheStretchOfWhatMovesAcrossItself)
{
    OneStep one{Scene()};
    one.work.expansion.world.assign(one.before.velocity.size(), Vec3::Zero());
    one.work.expansion.material.assign(one.before.velocity.size(), Vec2::Zero());
    for (std::size_t v = 0; v < one.before.velocity.size(); ++v)
        one.work.proposal.velocity[v] = Vec3(0, 0, one.before.mesh.material[v].x() > 0.25 ? -1.0 : 0.0);
    one.weigh();
    const double stretch = one.work.energies.solved.potential.stretch;
    EXPECT_GT(stretch, 0.05 * one.work.energies.solved.kinetic);
    EXPECT_NEAR(find_unforeseen_energy(one.scene, one.before, one.work) / stretch, 1.0, 0.02);

    // With the expansion at the solution nothing is unforeseen.
    one.work.expansion.world = one.work.proposal.velocity;
    EXPECT_EQ(find_unforeseen_energy(one.scene, one.before, one.work), 0.0);
}

// The equations are linearised around cloth that is strained far more than the solution. Such equations may
// miss a solution of higher energy.
TEST(UnforeseenEnergy, IsTheExcessOfAnExpansionThatIsStrainedFarMore)
{
    // Stretch of the expansion over that of the solution; its energy is 4 and 9 times as large.
    for (const double times : {2.0, 3.0}) {
        OneStep one{Scene()};
        one.work.expansion.world.assign(one.before.velocity.size(), Vec3::Zero());
        one.work.expansion.material.assign(one.before.velocity.size(), Vec2::Zero());
        for (std::size_t v = 0; v < one.before.velocity.size(); ++v) {
            const double x = one.before.mesh.material[v].x();
            one.work.proposal.velocity[v] = Vec3(0.1 * x, 0, 0);
            one.work.expansion.world[v] = Vec3(0.1 * times * x, 0, 0);
        }
        one.weigh();
        const double stretch = one.work.energies.solved.potential.stretch;
        EXPECT_GT(stretch, 0.05 * one.work.energies.solved.kinetic);
        const double expected = times > 2.5 ? 4.0 * stretch : 0.0;  // 9 less the 5 that may be
        EXPECT_NEAR(find_unforeseen_energy(one.scene, one.before, one.work), expected, 1e-9 * stretch)
            << times;
    }
}

// The same sheet, strained at first, comes to rest flat: what it loses is as much unforeseen.
TEST(UnforeseenEnergy, IsWhatIsLostToo)
{
    OneStep one{Scene()};
    one.work.expansion.world.assign(one.before.velocity.size(), Vec3::Zero());
    one.work.expansion.material.assign(one.before.velocity.size(), Vec2::Zero());
    for (std::size_t v = 0; v < one.before.velocity.size(); ++v) {
        const Vec3 across(0, 0, one.before.mesh.material[v].x() > 0.25 ? -1.0 : 0.0);
        one.work.proposal.velocity[v] = across;
        one.work.expansion.world[v] = 1.4 * across;
    }
    one.weigh();
    const double stretch = one.work.energies.solved.potential.stretch;
    EXPECT_LT(stretch,
              compute_cloth_energy(one.scene, one.work, find_end(one.work.prediction, one.work.expansion))
                  .potential.stretch);
    EXPECT_GT(find_unforeseen_energy(one.scene, one.before, one.work), 0.1 * stretch);
}

TEST(UnforeseenEnergy, IsNoneOfAStretchInThePlane)
{
    OneStep one{Scene()};
    one.work.expansion.world.assign(one.before.velocity.size(), Vec3::Zero());
    one.work.expansion.material.assign(one.before.velocity.size(), Vec2::Zero());
    for (std::size_t v = 0; v < one.before.velocity.size(); ++v)
        one.work.proposal.velocity[v] = Vec3(0.1 * one.before.mesh.material[v].x(), 0, 0);
    one.weigh();
    EXPECT_GT(one.work.energies.solved.potential.stretch, one.work.energies.solved.kinetic);
    EXPECT_EQ(find_unforeseen_energy(one.scene, one.before, one.work), 0.0);
}

TEST(Push, IsCostlyWhereItStrainsAndFreeWhereItDoesNot)
{
    OneStep one{Scene()};
    const std::vector<Vec3> flat = one.end();
    EXPECT_FALSE(one.does_push_out_strain_to(flat)) << "nothing is moved";
    std::vector<Vec3> world = flat;
    for (Vec3& x : world) x.z() += 1e-3;
    EXPECT_FALSE(one.does_push_out_strain_to(world)) << "as a whole";
    world = flat;
    world[7].z() += 1e-4;
    EXPECT_FALSE(one.does_push_out_strain_to(world)) << "one vertex, out of the plane";
    world = flat;
    world[7].x() += 1e-3;
    EXPECT_TRUE(one.does_push_out_strain_to(world)) << "one vertex, in the plane";
    for (Vec3& v : one.work.proposal.velocity) v = Vec3(10, 0, 0);
    for (Vec3& x : world) x.x() += one.work.prediction.gamma * 10.0;
    EXPECT_FALSE(one.does_push_out_strain_to(world)) << "little beside what is in motion";
}

}  // namespace
}  // namespace arris
