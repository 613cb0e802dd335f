// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <set>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sewing.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/forces/inertia.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "solver/energy_balance.h"
#include "solver/sewing/closing.h"
#include "solver/sewing/seam_springs.h"
#include "solver/sewing/welding.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3, kCell = 0.05, kRoom = 1.0;  // m
constexpr std::array kCells = {4, 6};                           // along u and v
const Material kCloth = {0.15, 500.0, 0.3, 1e-5, 0.01, kThickness};

ClothMesh make_panel(const Vec3& corner, const Mat3& turn = Mat3::Identity())
{
    ClothGrid grid;
    grid.size = {kCells[0] * kCell, kCells[1] * kCell};
    grid.resolution = kCells;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x = corner + turn * x;
    return mesh;
}

/// Vertices of a panel at this u, by ascending v.
std::vector<int> side_at(const ClothMesh& mesh, double u)
{
    std::vector<int> side;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (std::abs(mesh.material[v].x() - u) < 1e-9) side.push_back(v);
    std::sort(side.begin(), side.end(),
              [&](int a, int b) { return mesh.material[a].y() < mesh.material[b].y(); });
    return side;
}

/// Panels that are to be sewn: of neighbours the right side of one to the left side of the next.
struct Garment {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;

    explicit Garment(const std::vector<ClothMesh>& panels, bool is_ring = false)
    {
        std::vector<ClothMesh> moved = panels;
        scene.materials = kCloth;
        std::vector<std::vector<int>> left, right;
        int first = 0;
        for (std::size_t p = 0; p < moved.size(); ++p) {
            const double shift = kRoom * static_cast<double>(p);
            if (p > 0) {
                scene.materials.add(shift - 0.5 * kRoom, kCloth);
                scene.pieces.push_back({"", shift, shift - 0.5 * kRoom});
            }
            for (const auto& [u, sides] : {std::pair(0.0, &left), std::pair(kCells[0] * kCell, &right)}) {
                sides->push_back(side_at(moved[p], u));
                for (int& v : sides->back()) v += first;
            }
            for (Vec2& X : moved[p].material) X.x() += shift;
            first += moved[p].vertex_count();
        }
        scene.self_contact = ClothContact{kThickness};
        scene.sewing.emplace();
        scene.sewing->speed = 0.5;
        settings.step = 0.005;
        settings.integrator = Integrator::ImplicitEuler;
        state = make_state(scene, join(moved), Vec3::Zero());
        const std::size_t seams = is_ring ? panels.size() : panels.size() - 1;
        for (std::size_t s = 0; s < seams; ++s) {
            scene.sewing->seams.push_back({"seam " + std::to_string(s)});
            for (std::size_t k = 0; k < right[s].size(); ++k)
                state.seam_pairs.push_back(
                    {{state.ids[right[s][k]], state.ids[left[(s + 1) % panels.size()][k]]},
                     static_cast<std::int32_t>(s),
                     0.0});
        }
    }

    /// Steps until all is sewn, or for `duration` (s).
    void run(double duration)
    {
        advance_sewing(scene, state);
        while (state.time < duration && !std::isfinite(state.sewn_at)) step();
    }
    void step()
    {
        const auto failed = advance(scene, settings, state.time + settings.step, state, work,
                                    [](const StepReport&, bool) { return true; });
        ASSERT_FALSE(failed);
        advance_sewing(scene, state);
    }

    ClothElements elements() const
    {
        return list_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces),
                             HingeUse::Terms, scene.materials);
    }
    Vec3 momentum() const { return linear_momentum(scene.materials, elements(), state.velocity); }
    Vec3 turning() const
    {
        return angular_momentum(scene.materials, elements(), state.mesh.world, state.velocity);
    }
    double total_energy()
    {
        prepare(scene, state, work);
        return find_energy(scene, state, work).sum() + state.sewn_energy;
    }
};

Vec3 beside(double gap)
{
    return {kCells[0] * kCell + gap, 0.0, 0.0};
}

TEST(Sewing, TwoFreePanelsBecomeOneAtTheBoundedSpeed)
{
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.2))});
    advance_sewing(cloth.scene, cloth.state);
    EXPECT_NEAR(cloth.state.closing.end, 0.6, 1e-12) << "0.2 m at up to 0.5 m/s";
    double last = 0.2;
    while (cloth.state.time < 0.58) {
        cloth.step();
        const double gap = find_open_seams(cloth.scene, cloth.state)[0].widest;
        EXPECT_LT(last - gap, 0.5 * 0.005 * 1.1) << cloth.state.time;
        last = gap;
    }
    cloth.run(2.0);
    ASSERT_TRUE(std::isfinite(cloth.state.sewn_at));
    EXPECT_LT(cloth.state.sewn_at, 0.7);
    EXPECT_TRUE(cloth.state.seam_pairs.empty());
    EXPECT_EQ(validate(cloth.state.mesh), "");
    EXPECT_EQ(cloth.state.mesh.seam_vertices.size(), 7U);
    EXPECT_EQ(find_self_crossings(cloth.scene, cloth.state.mesh).count, 0);
}

TEST(Sewing, KeepsMomentumAndAngularMomentum)
{
    // Panels in planes of their own, so that sewing turns them.
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.08) + Vec3(0.0, 0.01, 0.05), turn)});
    for (Vec3& v : cloth.state.velocity) v = Vec3(0.1, -0.2, 0.3);
    const Vec3 before = cloth.momentum();
    double lost = 0.0;
    bool is_welded = false;
    advance_sewing(cloth.scene, cloth.state);
    while (cloth.state.time < 1.0 && !is_welded) {
        const auto failed = advance(cloth.scene, cloth.settings, cloth.state.time + 0.005, cloth.state,
                                    cloth.work, [](const StepReport&, bool) { return true; });
        ASSERT_FALSE(failed);
        const Vec3 momentum = cloth.momentum(), turning = cloth.turning();
        const double energy = cloth.total_energy();
        advance_sewing(cloth.scene, cloth.state);
        is_welded = cloth.state.seam_pairs.empty();
        EXPECT_LT((cloth.momentum() - momentum).norm(), 1e-12 * before.norm());
        EXPECT_LT((cloth.turning() - turning).norm(), 1e-12);
        EXPECT_NEAR(cloth.total_energy(), energy, 1e-12) << "sewn_energy says what welding takes";
        lost = cloth.state.sewn_energy;
    }
    EXPECT_TRUE(is_welded);
    // A hundred steps' solves leave up to 2e-11 (measured with three BLAS kernels).
    EXPECT_LT((cloth.momentum() - before).norm(), 1e-9 * before.norm());
    EXPECT_NE(lost, 0.0);
}

TEST(Sewing, AStretchedSeamStaysOpenByAFiftiethOfItsStrainOfACell)
{
    // One panel held at its far side, the other pulled: a tie, which is not welded.
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.0))});
    cloth.scene.sewing->seams[0].is_tie = true;
    cloth.scene.self_contact.reset();
    cloth.scene.materials[0].poisson_ratio = cloth.scene.materials[1].poisson_ratio = 0.0;
    const double tension = 5.0;  // N/m: 1 % of the cloth's stiffness
    const double end = kRoom + kCells[0] * kCell;
    cloth.scene.pulls.push_back(
        {{{end, 0.0}, {end, kCells[1] * kCell}}, Vec3(tension * kCells[1] * kCell, 0.0, 0.0)});
    Pin pin;
    pin.material = MaterialRegion(Vec2(0.0, -1.0), Vec2(0.0, 1.0));
    cloth.scene.pins.push_back(pin);
    attach_pins(cloth.scene, cloth.state);
    cloth.scene.materials[0].damping = cloth.scene.materials[1].damping = 0.5;
    advance_sewing(cloth.scene, cloth.state);
    cloth.settings.step = 0.02;
    for (int k = 0; k < 200; ++k) cloth.step();
    // The force of a cell's width on each of its springs, but half of that at both ends.
    const std::vector<SpringElement> springs = list_springs(cloth.scene, cloth.state);
    double force = 0.0;
    for (const SpringElement& spring : springs) {
        const double gap =
            (cloth.state.mesh.world[spring.vertices[0]] - cloth.state.mesh.world[spring.vertices[1]]).norm();
        EXPECT_NEAR(gap, 0.01 * kCell / 50.0, 0.6 * 0.01 * kCell / 50.0);
        force += spring.stiffness * gap;
    }
    EXPECT_NEAR(force, tension * kCells[1] * kCell, 1e-6);
    ASSERT_EQ(springs.size(), 7U);
    const auto gap_of = [&](int k) {
        return (cloth.state.mesh.world[springs[k].vertices[0]] -
                cloth.state.mesh.world[springs[k].vertices[1]])
            .norm();
    };
    EXPECT_NEAR(gap_of(3), 0.01 * kCell / 50.0, 0.05 * 0.01 * kCell / 50.0) << "eps h / 50";
}

TEST(Sewing, SewnHalvesAreTheSheet)
{
    // Panels that lie side by side are welded at the first try, into a sheet of the same mesh.
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.0))});
    advance_sewing(cloth.scene, cloth.state);
    advance_sewing(cloth.scene, cloth.state);
    ASSERT_TRUE(cloth.state.seam_pairs.empty());
    EXPECT_EQ(cloth.state.sewn_at, 0.0);
    ClothGrid grid;
    grid.size = {2.0 * kCells[0] * kCell, kCells[1] * kCell};
    grid.resolution = {2 * kCells[0], kCells[1]};
    Scene scene;
    scene.materials = kCloth;
    State sheet = make_state(scene, make_cloth_grid(grid), Vec3::Zero());
    EXPECT_EQ(cloth.state.mesh.vertex_count(), sheet.mesh.vertex_count());
    std::set<std::array<long, 3>> places;
    for (const Vec3& x : sheet.mesh.world)
        places.insert({std::lround(1e6 * x.x()), std::lround(1e6 * x.y()), std::lround(1e6 * x.z())});
    for (const Vec3& x : cloth.state.mesh.world)
        EXPECT_TRUE(
            places.contains({std::lround(1e6 * x.x()), std::lround(1e6 * x.y()), std::lround(1e6 * x.z())}));
}

TEST(Sewing, WhatIsBumpedComesToRest)
{
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.03))});
    cloth.state.velocity.assign(cloth.state.velocity.size(), Vec3(1.0, -2.0, 0.5));
    slow_down(0.03, cloth.state);
    slow_down(0.07, cloth.state);
    for (const Vec3& velocity : cloth.state.velocity)
        EXPECT_LT((velocity - std::exp(-1.0) * Vec3(1.0, -2.0, 0.5)).norm(), 1e-15);
}

TEST(Sewing, SeamsOfALowerOrderCloseFirst)
{
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.03)), make_panel(2.0 * beside(0.05))});
    cloth.scene.sewing->seams[0].order = 7;
    cloth.scene.sewing->seams[1].order = -2;
    advance_sewing(cloth.scene, cloth.state);
    EXPECT_EQ(cloth.state.closing.order, -2);
    const std::vector<SpringElement> springs = list_springs(cloth.scene, cloth.state);
    for (std::size_t s = 0; s < springs.size(); ++s)
        EXPECT_EQ(springs[s].stiffness > 0.0, cloth.state.seam_pairs[s].seam == 1);
    cloth.run(2.0);
    ASSERT_TRUE(std::isfinite(cloth.state.sewn_at));
    EXPECT_EQ(cloth.state.closing.order, 7);
    EXPECT_EQ(cloth.state.mesh.seam_vertices.size(), 14U);
    EXPECT_EQ(validate(cloth.state.mesh), "");
    EXPECT_TRUE(std::is_sorted(cloth.state.ids.begin(), cloth.state.ids.end()));
    EXPECT_TRUE(std::is_sorted(cloth.state.seam_ids.begin(), cloth.state.seam_ids.end()));
    std::set<std::uint32_t> all(cloth.state.ids.begin(), cloth.state.ids.end());
    all.insert(cloth.state.seam_ids.begin(), cloth.state.seam_ids.end());
    EXPECT_EQ(all.size(), cloth.state.mesh.material.size());
}

TEST(Sewing, ARingOfPanelsBecomesATube)
{
    std::vector<ClothMesh> panels;
    const double radius = 0.2;
    for (int k = 0; k < 4; ++k) {
        const Mat3 turn = Eigen::AngleAxisd(k * M_PI / 2.0, Vec3::UnitY()).toRotationMatrix();
        panels.push_back(make_panel(turn * Vec3(-0.5 * kCells[0] * kCell, 0.0, radius), turn));
    }
    Garment cloth(panels, true);
    cloth.run(3.0);
    ASSERT_TRUE(std::isfinite(cloth.state.sewn_at));
    EXPECT_EQ(validate(cloth.state.mesh), "");
    EXPECT_EQ(cloth.state.mesh.vertex_count() + 28, static_cast<int>(cloth.state.mesh.material.size()));
    EXPECT_EQ(find_self_crossings(cloth.scene, cloth.state.mesh).count, 0);
}

TEST(Sewing, AnObstacleBetweenKeepsASeamOpen)
{
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.1))});
    const Placement middle{Mat3::Identity(), Vec3(kCells[0] * kCell + 0.05, 0.15, 0.0)};
    cloth.scene.obstacles.emplace_back("wall", make_box(Vec3(0.02, 1.0, 1.0)), middle, RigidMotion{}, 14.0);
    cloth.run(1.0);
    EXPECT_FALSE(std::isfinite(cloth.state.sewn_at));
    const std::vector<SeamGap> open = find_open_seams(cloth.scene, cloth.state);
    ASSERT_EQ(open.size(), 1U);
    EXPECT_EQ(open[0].pairs, 7);
    EXPECT_GT(open[0].widest, 0.02);
    EXPECT_EQ(audit(cloth.scene, cloth.state).obstacle, -1) << "nothing was pulled through";
    const State before = cloth.state;
    EXPECT_FALSE(weld(cloth.scene, 0, cloth.state)) << "the way leads through the wall";
    EXPECT_EQ(before.mesh.world, cloth.state.mesh.world);
    EXPECT_EQ(before.mesh.faces, cloth.state.mesh.faces);
}

TEST(Sewing, WeldingRefusesWhatWouldCross)
{
    // The second panel lies folded back over the first one, a hair above it.
    const Mat3 turn = Eigen::AngleAxisd(M_PI, Vec3::UnitY()).toRotationMatrix();
    Garment cloth({make_panel(Vec3::Zero()), make_panel(Vec3(kCells[0] * kCell, 0.0, 1e-4), turn)});
    for (Vec3& x : cloth.state.mesh.world)  // both bulge, the lower one higher
        x.z() += (x.z() > 5e-5 ? 0.5 : 1.0) * 2e-4 * std::sin(M_PI * x.x() / (kCells[0] * kCell));
    EXPECT_FALSE(weld(cloth.scene, 0, cloth.state));
    EXPECT_EQ(cloth.state.seam_pairs.size(), 7U);
}

TEST(Sewing, ATieIsNeverWelded)
{
    Garment cloth({make_panel(Vec3::Zero()), make_panel(beside(0.05))});
    cloth.scene.sewing->seams[0].is_tie = true;
    cloth.run(2.0);
    ASSERT_TRUE(std::isfinite(cloth.state.sewn_at));
    EXPECT_EQ(cloth.state.seam_pairs.size(), 7U);
    EXPECT_FALSE(cloth.state.mesh.has_seams());
    EXPECT_TRUE(find_open_seams(cloth.scene, cloth.state).empty()) << "it is closed";
    // In a fall it holds together.
    cloth.scene.gravity.emplace();
    cloth.work = {};
    Pin pin;
    pin.material = MaterialRegion(Vec2(0.0, -1.0), Vec2(0.0, 1.0));
    cloth.scene.pins.push_back(pin);
    attach_pins(cloth.scene, cloth.state);
    for (int k = 0; k < 60; ++k) cloth.step();
    for (const SeamPair& pair : cloth.state.seam_pairs)
        EXPECT_LT((cloth.state.mesh.world[cloth.state.index_of(pair.vertex_ids[0])] -
                   cloth.state.mesh.world[cloth.state.index_of(pair.vertex_ids[1])])
                      .norm(),
                  2.0 * kThickness);
}

TEST(Sewing, WithoutSeamsNothingIsListed)
{
    Scene scene;
    const State state = make_state(scene, make_panel(Vec3::Zero()), Vec3::Zero());
    EXPECT_TRUE(list_springs(scene, state).empty());
    EXPECT_TRUE(number_joined(state).empty());
}

}  // namespace
}  // namespace arris
