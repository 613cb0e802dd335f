// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/buckling_seed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/advance.h"
#include "solver/cloth_strain.h"
#include "solver/energy_balance.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/step.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kSide = 0.5;        // m, of the square sheet
constexpr double kStep = 0.005;      // s
constexpr double kGreatest = 2e-10;  // greatest seed of a step, relative to the longest edge at a vertex

const Mat3 kUpright = (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();  // u along x, v along z
const Mat3 kInclined = rotation_about(Vec3(1, 2, -0.5), 37.0);

Material cotton()
{
    return {0.15, 500.0, 0.3, 1e-5, 0.002, 1e-3};
}

ClothMesh make_sheet(const Mat3& turn, GridPattern pattern = GridPattern::Cross, int cells = 8)
{
    ClothGrid grid;
    grid.size = {kSide, kSide};
    grid.resolution = {cells, cells};
    grid.pattern = pattern;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x = turn * x;
    return mesh;
}

Pin pin_at(const Vec2& least, const Vec2& greatest, const Vec3& velocity = Vec3::Zero())
{
    Pin pin;
    pin.material = {least, greatest};
    pin.motion.velocity = velocity;
    return pin;
}

// --- One state: who gets a seed.

/// A state of a sheet that is `stretch` times as long along u, and its contacts.
struct Sheet {
    Scene scene;
    State state;
    std::vector<Contact> contacts;

    explicit Sheet(double stretch = 0.99, const Mat3& turn = kUpright,
                   GridPattern pattern = GridPattern::Cross)
    {
        scene.materials[0] = cotton();
        ClothMesh mesh = make_sheet(turn, pattern);
        for (std::size_t v = 0; v < mesh.world.size(); ++v)
            mesh.world[v] = turn * Vec3(stretch * mesh.material[v].x(), mesh.material[v].y(), 0.0);
        state = make_state(scene, mesh, Vec3::Zero());
    }

    /// An obstacle that pressed on every vertex in the last step.
    void press(const Vec3& along)
    {
        for (int v = 0; v < state.mesh.vertex_count(); ++v) {
            Contact contact;
            contact.vertices[0] = v;
            contact.weights[0] = 1.0;
            contact.kind = ContactKind::Vertex;
            contact.obstacle = 0;
            contact.normal = along;
            contact.last_multiplier = 1e-6;
            contacts.push_back(contact);
        }
    }

    /// Deviation that each vertex gets in a step, m.
    std::vector<Vec3> seeds() const
    {
        Workspace work;
        prepare(scene, state, work);
        Prediction prediction = predict(state, Integrator::Bdf2, kStep);
        seed_buckling(scene, state, work.mesh, contacts, prediction);
        std::vector<Vec3> seeds = prediction.velocity;
        for (std::size_t v = 0; v < seeds.size(); ++v)
            seeds[v] = prediction.gamma * (seeds[v] - state.velocity[v]);
        return seeds;
    }
};

struct StateCase {
    const char* name;
    bool is_seeded;
    std::function<Sheet()> make;
};

template <class Change>
std::function<Sheet()> changed(const Change& change, double stretch = 0.99)
{
    return [=] {
        Sheet sheet(stretch);
        change(sheet);
        return sheet;
    };
}

void move_each(Sheet& sheet, const std::function<Vec3(const Vec2&)>& way)
{
    for (int v = 0; v < sheet.state.mesh.vertex_count(); ++v)
        sheet.state.mesh.world[v] += way(sheet.state.mesh.material[v]);
}

void set_velocity(Sheet& sheet, const std::function<Vec3(const Vec2&)>& velocity)
{
    for (int v = 0; v < sheet.state.mesh.vertex_count(); ++v)
        sheet.state.velocity[v] = velocity(sheet.state.mesh.material[v]);
}

const StateCase kStates[] = {
    {"compressed", true, [] { return Sheet(); }},
    {"diagonal", true, [] { return Sheet(0.99, kUpright, GridPattern::Diagonal); }},
    {"alternating", true, [] { return Sheet(0.99, kUpright, GridPattern::Alternating); }},
    {"unstructured", true, [] { return Sheet(0.99, kUpright, GridPattern::Unstructured); }},
    {"inclined", true, [] { return Sheet(0.99, kInclined); }},
    {"gravity in the plane", true, changed([](Sheet& s) { s.scene.gravity = Gravity{}; })},
    {"moves across", true,
     changed([](Sheet& s) { set_velocity(s, [](const Vec2&) { return Vec3(0.1, -2.0, 0.3); }); })},
    {"turns out of its plane", true,
     changed([](Sheet& s) { set_velocity(s, [](const Vec2& X) { return Vec3(0, 3.0 * X.x(), 0); }); })},
    {"obstacle presses in the plane", true, changed([](Sheet& s) { s.press(-Vec3::UnitX()); })},

    {"at rest", false, [] { return Sheet(1.0); }},
    {"stretched", false, [] { return Sheet(1.1); }},
    {"contracts across a pull", false,
     changed([](Sheet& s) { move_each(s, [](const Vec2& X) { return Vec3(0, 0, -0.03 * X.y()); }); }, 1.1)},
    {"compressed by 0.05 %", false, [] { return Sheet(0.9995); }},
    {"gravity across", false, changed([](Sheet& s) { s.scene.gravity = Gravity{Vec3(0, -1e-3, -9.81)}; })},
    {"obstacle presses across", false, changed([](Sheet& s) { s.press(Vec3::UnitY()); })},
    {"obstacle presses from the other side", false, changed([](Sheet& s) { s.press(-Vec3::UnitY()); })},
    {"rounded by 1e-9 m", false, changed([](Sheet& s) {
         move_each(s, [](const Vec2& X) { return Vec3(0, 4e-9 * X.squaredNorm(), 0); });
     })},
    {"begins to round", false, changed([](Sheet& s) {
         set_velocity(s, [](const Vec2& X) { return Vec3(0, 1e-6 * X.squaredNorm(), 0); });
     })},
};

TEST(BucklingSeed, IsOnlyWhereClothIsCompressedExactlyPlaneAndUnloadedAcross)
{
    for (const StateCase& one : kStates) {
        SCOPED_TRACE(one.name);
        const Sheet sheet = one.make();
        const std::vector<Vec3> seeds = sheet.seeds();
        const auto count = std::count_if(seeds.begin(), seeds.end(),
                                         [](const Vec3& seed) { return seed.squaredNorm() > 0.0; });
        EXPECT_EQ(count, one.is_seeded ? sheet.state.mesh.vertex_count() : 0);
    }
}

TEST(BucklingSeed, IsTinyAcrossTheClothAndDiffersFromVertexToVertex)
{
    for (const Mat3& turn : {kUpright, kInclined}) {
        const Sheet sheet(0.99, turn);
        const double edge = kSide / 8;
        std::vector<double> heights;
        for (const Vec3& seed : sheet.seeds()) {
            EXPECT_LT(seed.norm(), kGreatest * edge);
            EXPECT_NEAR(std::abs(seed.dot(turn.col(2))), seed.norm(), 1e-6 * seed.norm());
            heights.push_back(seed.norm());
        }
        std::sort(heights.begin(), heights.end());
        EXPECT_EQ(std::adjacent_find(heights.begin(), heights.end()), heights.end());
        EXPECT_GT(heights.back(), 2.0 * heights.front());
    }
}

TEST(BucklingSeed, FollowsTheVertexsIdAndNotItsIndex)
{
    Sheet sheet;
    const std::vector<Vec3> seeds = sheet.seeds();
    for (std::uint32_t& id : sheet.state.ids) id += 1000;
    EXPECT_NE(sheet.seeds()[3], seeds[3]);
    for (std::uint32_t& id : sheet.state.ids) id -= 1000;
    EXPECT_EQ(sheet.seeds(), seeds);
}

TEST(BucklingSeed, LeavesAPlanePartBesideAFoldAlone)
{
    // The right half is bent by 60 degrees about the line u = kSide / 2.
    Sheet sheet;
    for (int v = 0; v < sheet.state.mesh.vertex_count(); ++v) {
        Vec3& x = sheet.state.mesh.world[v];
        const double beyond = x.x() - 0.99 * kSide / 2;
        if (beyond > 1e-9) x += Vec3(-0.5 * beyond, std::sqrt(0.75) * beyond, 0);
    }
    const std::vector<Vec3> seeds = sheet.seeds();
    for (int v = 0; v < sheet.state.mesh.vertex_count(); ++v) {
        const double away = std::abs(sheet.state.mesh.material[v].x() - kSide / 2);
        if (away < 0.9 * kSide / 8) {
            EXPECT_EQ(seeds[v], Vec3::Zero()) << away;
        } else if (away > 2.1 * kSide / 8) {
            EXPECT_GT(seeds[v].norm(), 0.0) << away;
        }
    }
}

// --- Runs.

struct RunCase {
    std::string name;
    std::function<Scene()> make_scene;
    Mat3 turn = kUpright;
    GridPattern pattern = GridPattern::Cross;
    Integrator integrator = Integrator::Bdf2;
    Vec3 velocity = Vec3::Zero();
};

struct ClothRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;

    explicit ClothRun(const RunCase& one) : scene(one.make_scene())
    {
        scene.materials[0] = cotton();
        settings.integrator = one.integrator;
        state = make_state(scene, make_sheet(one.turn, one.pattern), one.velocity);
        prepare(scene, state, work);
    }

    void advance_to(double end, const std::function<void()>& look = {})
    {
        while (state.time < end - 1e-9 && !::testing::Test::HasFailure()) {
            const auto accept = [&](const StepReport&, bool) {
                prepare(scene, state, work);
                if (look) look();
                return true;
            };
            EXPECT_FALSE(advance(scene, settings, state.time + kStep, state, work, accept).has_value());
        }
    }

    double spread_across(const Vec3& normal) const
    {
        std::vector<double> heights;
        for (const Vec3& x : state.mesh.world) heights.push_back(normal.dot(x));
        const auto [least, greatest] = std::minmax_element(heights.begin(), heights.end());
        return *greatest - *least;
    }
};

/// Two corners are drawn together along u, which `turn` takes to the world.
std::function<Scene()> draw_corners(const Mat3& turn, bool has_gravity, const Vec3& carry = Vec3::Zero())
{
    return [=] {
        Scene scene;
        if (has_gravity) scene.gravity = Gravity{};
        scene.pins = {pin_at({0, kSide}, {0, kSide}, carry),
                      pin_at({kSide, kSide}, {kSide, kSide}, carry - 0.3 * turn.col(0))};
        return scene;
    };
}

/// Two opposite borders are pushed together along u.
std::function<Scene()> push_borders(const Mat3& turn, std::array<bool, 3> held = {true, true, true})
{
    return [=] {
        Scene scene;
        scene.pins = {pin_at({0, 0}, {0, kSide}), pin_at({kSide, 0}, {kSide, kSide}, -0.2 * turn.col(0))};
        for (Pin& pin : scene.pins) pin.held = held;
        return scene;
    };
}

/// A thick box pushes the lower border of a hanging sheet upwards, edge-on.
Scene push_with_box()
{
    Scene scene;
    scene.gravity = Gravity{};
    scene.pins = {pin_at({0, kSide}, {kSide, kSide})};
    RigidMotion motion;
    motion.velocity = Vec3(0, 0, 0.3);
    scene.obstacles.push_back(MovingObstacle("box", make_box({1.0, 0.4, 0.1}),
                                             {Mat3::Identity(), Vec3(kSide / 2, 0, -0.06)}, motion, 30.0));
    return scene;
}

std::vector<RunCase> compressed_runs()
{
    std::vector<RunCase> runs = {
        {"corners, inclined, no gravity", draw_corners(kInclined, false), kInclined},
        {"corners, carried across", draw_corners(kUpright, true, Vec3(0, 0.5, 0)), kUpright,
         GridPattern::Cross, Integrator::Bdf2, Vec3(0, 0.5, 0)},
        {"borders, no gravity", push_borders(kUpright)},
        {"borders, held in the plane only", push_borders(kUpright, {true, false, true})},
        {"borders, inclined", push_borders(kInclined), kInclined},
        {"box, edge-on", push_with_box},
        {"corners, implicit Euler", draw_corners(kUpright, true), kUpright, GridPattern::Cross,
         Integrator::ImplicitEuler},
    };
    for (const auto& [name, pattern] :
         {std::pair("diagonal", GridPattern::Diagonal), std::pair("alternating", GridPattern::Alternating),
          std::pair("cross", GridPattern::Cross), std::pair("unstructured", GridPattern::Unstructured)})
        runs.push_back({std::string("corners, ") + name, draw_corners(kUpright, true), kUpright, pattern});
    return runs;
}

TEST(BucklingSeed, LetsClothFoldThatIsCompressedInAPlane)
{
    for (const RunCase& one : compressed_runs()) {
        SCOPED_TRACE(one.name);
        ClothRun run(one);
        run.advance_to(0.4);
        // Folds of some centimetres. Without folds the greatest compression is 15 % or more.
        EXPECT_GT(run.spread_across(one.turn.col(2)), 0.03);
        const ClothStrain strain =
            measure_cloth_strain(run.scene.materials, find_stretches(run.state, run.work.mesh),
                                 run.state.mesh, run.work.mesh.stars.faces);
        EXPECT_GT(strain.in_plane.strain, -0.02);
        EXPECT_LT(compute_cloth_energy(run.scene, run.work,
                                       {run.state.mesh.world,
                                        run.state.mesh.material,
                                        {run.state.velocity, run.state.material_velocity}})
                      .potential.stretch,
                  0.05);
    }
}

TEST(BucklingSeed, ContinuesToTheBitFromTheStateAlone)
{
    for (const RunCase& one : compressed_runs()) {
        SCOPED_TRACE(one.name);
        ClothRun through(one), resumed(one);
        through.advance_to(0.15);
        resumed.advance_to(0.05);
        resumed.work = Workspace();
        prepare(resumed.scene, resumed.state, resumed.work);
        resumed.advance_to(0.15);
        EXPECT_EQ(through.state.mesh.world, resumed.state.mesh.world);
        EXPECT_EQ(through.state.velocity, resumed.state.velocity);
    }
}

/// Runs in which plane cloth is in tension, or loaded across.
std::vector<RunCase> quiet_runs()
{
    const auto with = [](std::vector<Pin> pins, bool has_gravity = true) {
        return [=] {
            Scene scene;
            if (has_gravity) scene.gravity = Gravity{};
            scene.pins = pins;
            return scene;
        };
    };
    const auto on_floor = [](const Vec3& normal) {
        return [=] {
            Scene scene;
            scene.gravity = Gravity{};
            scene.obstacles.push_back(make_floor(normal, -0.002));
            return scene;
        };
    };
    const auto squeezed_on_floor = [] {
        Scene scene;
        scene.gravity = Gravity{};
        scene.obstacles.push_back(make_floor(Vec3::UnitZ(), -0.001));
        scene.pins = {pin_at({0, 0}, {0, kSide}), pin_at({kSide, 0}, {kSide, kSide}, Vec3(-0.1, 0, 0))};
        return scene;
    };
    const Vec3 lean = Vec3(0.3, 0.1, 1.0).normalized();
    const Mat3 along = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), lean).toRotationMatrix();
    return {
        {"strip hangs", with({pin_at({0, kSide}, {kSide, kSide})})},
        {"pendulum swings across", with({pin_at({0, kSide}, {kSide, kSide})}), kUpright, GridPattern::Cross,
         Integrator::Bdf2, Vec3(0, 0.5, 0)},
        {"borders are pulled apart",
         with({pin_at({0, 0}, {0, kSide}), pin_at({kSide, 0}, {kSide, kSide}, Vec3(0.1, 0, 0))}, false)},
        {"falls flat", on_floor(Vec3::UnitZ()), Mat3::Identity()},
        {"slides down a slope", on_floor(lean), along},
        {"flies", with({}, false), kInclined, GridPattern::Cross, Integrator::Bdf2, Vec3(1, 2, 3)},
        {"squeezed on a floor", squeezed_on_floor, Mat3::Identity()},
    };
}

TEST(BucklingSeed, ChangesNothingInTensionOrOnAFloor)
{
    for (const RunCase& one : quiet_runs()) {
        SCOPED_TRACE(one.name);
        ClothRun run(one);
        run.advance_to(0.2, [&] {
            Prediction prediction = predict(run.state, run.settings.integrator, kStep);
            const std::vector<Vec3> before = prediction.velocity;
            seed_buckling(run.scene, run.state, run.work.mesh, run.work.contacts, prediction);
            EXPECT_EQ(prediction.velocity, before) << run.state.time;
        });
    }
}

}  // namespace
}  // namespace arris
