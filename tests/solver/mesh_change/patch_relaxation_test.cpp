// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/patch_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/contact/audit.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::elastic_energy_of;
using testing::EolCloth;
using testing::make_draped;

constexpr double kHeight = 1.0;  // m, height of the cloth above the obstacle

/// Flat cloth of 0.4 m, far from its obstacle; its inner vertices are displaced.
struct Setting {
    EolCloth cloth;
    RelaxedPatch patch;

    explicit Setting(double rough, ObstacleMesh obstacle = make_points({{9, 9, 9}}))
        : cloth(MovingObstacle("it", std::move(obstacle), {}, {}, 30.0), make_draped({8, 0.0, 180.0}))
    {
        std::mt19937 random(2);
        std::normal_distribution<double> shift(0.0, rough);
        State& state = cloth.state;
        patch.faces.resize(state.mesh.faces.size());
        std::iota(patch.faces.begin(), patch.faces.end(), 0);
        patch.normals.assign(state.ids.size(), Vec3::Zero());
        for (std::size_t v = 0; v < state.ids.size(); ++v) {
            const Vec2& X = state.mesh.material[v];
            const bool is_inner = (X - Vec2(0.2, 0.2)).cwiseAbs().maxCoeff() < 0.19;
            patch.is_free.push_back(is_inner);
            state.mesh.world[v].z() += kHeight;
            if (is_inner) state.mesh.world[v] += Vec3(shift(random), shift(random), shift(random));
            state.previous_world[v] = state.mesh.world[v] - Vec3(0.001, 0.002, 0.003);
            state.velocity[v] = Vec3(0.2, 0.4, 0.6);
        }
    }

    double energy() const { return elastic_energy_of(cloth.scene, cloth.state.mesh); }
    double relax() { return arris::relax(cloth.scene, {}, patch, cloth.state); }
};

TEST(PatchRelaxation, LowersTheEnergyAndReturnsWhatThereIs)
{
    for (const double stiffness : {50.0, 5e4})
        for (const double bending : {0.0, 1e-5, 1e-2})
            for (const double rough : {1e-6, 1e-3, 5e-3, 0.05}) {
                Setting setting(rough);
                setting.cloth.scene.materials[0].youngs_modulus = stiffness;
                setting.cloth.scene.materials[0].bending_stiffness = bending;
                const double before = setting.energy();
                const double after = setting.relax();
                EXPECT_NEAR(after, setting.energy(), 1e-12 * before);
                EXPECT_LT(after, rough < 1e-2 ? 0.1 * before : before) << stiffness << ", " << rough;
            }
}

TEST(PatchRelaxation, LowersTheEnergyOfAPlate)
{
    // The patch is the whole cloth, so its moments are those of the step.
    for (const double rough : {1e-6, 1e-3, 5e-3}) {
        Setting setting(rough);
        setting.cloth.scene.materials[0].bending_stiffness = 1e-2;
        setting.cloth.scene.materials[0].bending_model = BendingModel::Plate;
        const double before = setting.energy();
        const double after = setting.relax();
        EXPECT_NEAR(after, setting.energy(), 1e-9 * before);
        EXPECT_LT(after, 0.2 * before) << rough;
    }
}

TEST(PatchRelaxation, RelaxesUnderAGravityOfNothingAsWithout)
{
    Setting without(5e-3), nothing(5e-3);
    nothing.cloth.scene.gravity = Gravity{Vec3::Zero()};
    EXPECT_EQ(nothing.relax(), without.relax());
    EXPECT_EQ(nothing.cloth.state.mesh.world, without.cloth.state.mesh.world);
}

/// A square of 3 x 3 displaced free vertices, or for `count` 4 four equal squares that do not interact. With
/// `is_touching` every second vertex keeps its height.
Setting make_squares(int count, bool is_touching)
{
    Setting setting(0.0);
    setting.cloth.scene.gravity = Gravity{};
    setting.cloth.scene.materials[0].youngs_modulus = 5.0;     // so soft that relaxation takes several steps
    setting.cloth.scene.materials[0].bending_stiffness = 0.0;  // hinges would couple the squares
    std::mt19937 random(4);
    std::normal_distribution<double> shift(0.0, 5e-3);
    std::array<Vec3, 16> shifts;
    for (Vec3& s : shifts) s = Vec3(shift(random), shift(random), shift(random));
    State& state = setting.cloth.state;
    for (std::size_t v = 0; v < state.ids.size(); ++v) {
        const Vec2 cell = state.mesh.material[v] / 0.05;
        const int i = static_cast<int>(std::lround(cell.x())), j = static_cast<int>(std::lround(cell.y()));
        const bool is_free = i % 4 != 0 && j % 4 != 0 && (count == 4 || (i < 4 && j < 4));
        setting.patch.is_free[v] = is_free;
        if (!is_free) continue;
        state.mesh.world[v] += shifts[4 * (i % 4) + j % 4];
        if (is_touching && (i + j) % 2 == 0) setting.patch.normals[v] = Vec3(1, 2, 2) / 3.0;
    }
    return setting;
}

TEST(PatchRelaxation, APartMovesAsWithOthersLikeIt)
{
    // One square has 27 unknowns and four have 108, which another solver handles.
    for (const bool is_touching : {false, true}) {
        Setting one = make_squares(1, is_touching), four = make_squares(4, is_touching);
        const double drop = 0.9 * one.energy();
        for (auto [setting, count] : {std::pair{&one, 1.0}, std::pair{&four, 4.0}}) {
            const Scene& scene = setting->cloth.scene;
            setting->patch.wanted = find_patch_energy(scene, {}, setting->cloth.state.mesh) - count * drop;
        }
        const std::vector<Vec3> begin = one.cloth.state.mesh.world;
        one.relax();
        four.relax();
        double farthest = 0.0;
        for (std::size_t v = 0; v < begin.size(); ++v) {
            if (one.patch.is_free[v] == 0) continue;
            const Vec3& there = one.cloth.state.mesh.world[v];
            EXPECT_LT((there - four.cloth.state.mesh.world[v]).norm(), 1e-8) << is_touching << ", " << v;
            farthest = std::max(farthest, (there - begin[v]).norm());
        }
        EXPECT_GT(farthest, 2e-3);
    }
}

TEST(PatchRelaxation, WhatIsHeldStaysAndHistoryMovesAlong)
{
    Setting setting(5e-3);
    const State before = setting.cloth.state;
    setting.relax();
    const State& after = setting.cloth.state;
    int moved = 0;
    for (std::size_t v = 0; v < before.ids.size(); ++v) {
        const Vec3 way = after.mesh.world[v] - before.mesh.world[v];
        if (setting.patch.is_free[v] == 0) {
            EXPECT_EQ(after.mesh.world[v], before.mesh.world[v]);
            EXPECT_EQ(after.previous_world[v], before.previous_world[v]);
        }
        moved += way.norm() > 1e-4 ? 1 : 0;
        EXPECT_LT((after.previous_world[v] - before.previous_world[v] - way).norm(), 1e-15);
        EXPECT_EQ(after.velocity[v], before.velocity[v]);
        EXPECT_EQ(after.mesh.material[v], before.mesh.material[v]);
        EXPECT_EQ(after.previous_material[v], before.previous_material[v]);
    }
    EXPECT_GT(moved, 30);
}

TEST(PatchRelaxation, OnlyThePatchMoves)
{
    Setting setting(5e-3);
    std::erase_if(setting.patch.faces, [&](int f) {
        for (const int v : setting.cloth.state.mesh.faces[f])
            if (setting.cloth.state.mesh.material[v].x() > 0.2 + 1e-9) return true;
        return false;
    });
    for (std::size_t v = 0; v < setting.patch.is_free.size(); ++v)
        if (setting.cloth.state.mesh.material[v].x() > 0.2 - 1e-9) setting.patch.is_free[v] = 0;
    const State before = setting.cloth.state;
    setting.relax();
    int moved = 0;
    for (std::size_t v = 0; v < before.ids.size(); ++v) {
        const bool is_same = setting.cloth.state.mesh.world[v] == before.mesh.world[v];
        moved += is_same ? 0 : 1;
        EXPECT_TRUE(is_same || setting.patch.is_free[v] != 0);
    }
    EXPECT_GT(moved, 10);
}

TEST(PatchRelaxation, StopsAtWhatIsWanted)
{
    Setting relaxed(5e-3);
    const State before = relaxed.cloth.state;
    relaxed.patch.wanted = relaxed.energy();
    EXPECT_EQ(relaxed.relax(), relaxed.energy());
    EXPECT_EQ(relaxed.cloth.state.mesh.world, before.mesh.world) << "it is relaxed enough";

    // Relaxation stops at the wanted energy and keeps the strain that the cloth had before: too much
    // relaxation would push the cloth the other way.
    for (const double share : {0.99, 0.9, 0.5}) {
        Setting partly(5e-3);
        const double wanted = share * partly.energy();
        partly.patch.wanted = wanted;
        const double left = partly.relax();
        EXPECT_LE(left, (1.0 + 1e-9) * wanted);
        EXPECT_GT(left, 0.9 * wanted) << share;
    }
}

TEST(PatchRelaxation, CanRelaxByWhatItRelaxesBy)
{
    // Under gravity the steps are short, so soft cloth uses all of them.
    int yes = 0, no = 0;
    for (const double stiffness : {5.0, 50.0, 5e4})
        for (const double bending : {0.0, 1e-5, 1e-2})
            for (const double rough : {1e-3, 5e-3, 0.05})
                for (const double share : {0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.14, 1.2}) {
                    Setting setting(rough);
                    Scene& scene = setting.cloth.scene;
                    scene.gravity = Gravity{};
                    scene.materials[0].youngs_modulus = stiffness;
                    scene.materials[0].bending_stiffness = bending;
                    const RelaxedPatch& patch = setting.patch;
                    const LoosePatch loose{setting.cloth.state.mesh, patch.is_free, patch.normals, {}};
                    const double drop = share * setting.energy();
                    setting.patch.wanted = find_patch_energy(scene, {}, loose.mesh) - drop;
                    const bool does = setting.relax() <= setting.patch.wanted;
                    EXPECT_EQ(can_relax_by(scene, loose, drop), does)
                        << stiffness << ", " << bending << ", " << rough << ", " << share;
                    ++(does ? yes : no);
                }
    EXPECT_GT(yes, 50);
    EXPECT_GT(no, 50);
}

TEST(PatchRelaxation, KeepsTheHeightOfWhatTouches)
{
    // Motion along the normal over the total motion: the holding spring is stiffer by this factor.
    constexpr double kHeld = 1e-6;
    Setting setting(5e-3);
    for (std::size_t v = 0; v < setting.patch.normals.size(); ++v)
        if (v % 2 == 0) setting.patch.normals[v] = Vec3(1, 2, 2) / 3.0;
    const State before = setting.cloth.state;
    setting.relax();
    double along = 0.0, off = 0.0;
    for (std::size_t v = 0; v < before.ids.size(); ++v) {
        const Vec3 way = setting.cloth.state.mesh.world[v] - before.mesh.world[v];
        EXPECT_LT(std::abs(way.dot(setting.patch.normals[v])), 100.0 * kHeld * 5e-3);
        (v % 2 == 0 ? along : off) += way.norm();
    }
    EXPECT_GT(along, 0.01) << "it slides";
    EXPECT_GT(off, 0.01);
}

TEST(PatchRelaxation, NeverPassesAnObstacle)
{
    // A displaced vertex relaxes towards a nail, a wire and a box that are under it; the last box has a
    // corner beside its path.
    const Vec3 above(0, 0, kHeight + 0.02);
    int stopped = 0;
    for (int kind = 0; kind < 4; ++kind) {
        ObstacleMesh mesh = kind == 0 ? make_points({above})
                            : kind == 1
                                ? make_wire({above - Vec3(0, 0.01, 0), above + Vec3(0, 0.01, 0)}, false)
                                : make_box({0.01, 0.01, 0.01});
        if (kind > 1)
            for (Vec3& p : mesh.points) p += above + (kind == 3 ? Vec3(0.015, 0, 0) : Vec3(0, 0, 0));
        Setting setting(0.0, mesh);
        setting.cloth.scene.materials[0].youngs_modulus = 1e3;
        State& state = setting.cloth.state;
        const int middle = setting.cloth.vertex_at(0.2, 0.2);
        state.mesh.world[middle].z() += 0.06;
        ASSERT_EQ(audit(setting.cloth.scene, state.mesh, 0.0).obstacle, -1) << kind;
        const double before = setting.energy();
        const State begin = state;
        const double after = setting.relax();
        EXPECT_LE(after, before);
        EXPECT_NEAR(after, setting.energy(), 1e-12 * before);
        EXPECT_EQ(audit(setting.cloth.scene, state.mesh, 0.0).obstacle, -1) << kind;
        // The obstacle that was under the tent's top must still be there.
        EXPECT_GT(state.mesh.world[middle].z(), above.z()) << kind;
        stopped += state.mesh.world[middle].z() > kHeight + 0.005 ? 1 : 0;
    }
    EXPECT_EQ(stopped, 4);
}

// The cloth's border is nearer to a table than its stand-off, and the middle would relax to the border's
// height.
TEST(PatchRelaxation, ComesNoNearerToAnObstacleThanItsStandOff)
{
    ObstacleMesh table = make_box({2.0, 2.0, 0.1});
    const double top = kHeight - 0.4 * testing::kThickness;
    for (Vec3& p : table.points) p.z() += top - 0.05;
    Setting setting(0.0, table);
    State& state = setting.cloth.state;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> up(0.0, 5e-3);
    for (std::size_t v = 0; v < state.ids.size(); ++v)
        if (setting.patch.is_free[v]) state.mesh.world[v].z() += up(random);
    const std::vector<Vec3> begin = state.mesh.world;
    const double before = setting.energy();
    EXPECT_LT(setting.relax(), 0.9 * before);
    for (std::size_t v = 0; v < begin.size(); ++v) {
        const double least = std::min(begin[v].z() - top, testing::kThickness);
        EXPECT_GE(state.mesh.world[v].z() - top, (1.0 - 2e-3) * least) << v;
    }
}

/// Sets cloth hanging at rest from y = 0.4, stretched by its own weight with nu = 0. Its displacement at s
/// below the edge is u(s) = rho g (L s - s^2 / 2) / E. Its border is held. Returns the greatest displacement
/// relative to the border, m.
double hang(Setting& setting)
{
    constexpr double kLength = 0.4;
    Scene& scene = setting.cloth.scene;
    scene.gravity = Gravity{};
    scene.materials[0].poisson_ratio = 0.0;
    State& state = setting.cloth.state;
    const double rate = scene.materials[0].density * 9.81 / scene.materials[0].youngs_modulus;
    for (std::size_t v = 0; v < state.ids.size(); ++v) {
        const Vec2& X = state.mesh.material[v];
        const double s = kLength - X.y();
        state.mesh.world[v] = {X.x(), 0.0, kHeight - s - rate * (kLength * s - 0.5 * s * s)};
    }
    // Sag of the middle relative to the borders.
    return 0.125 * rate * kLength * kLength;
}

TEST(PatchRelaxation, DoesNotLiftWhatHangsFromAnEdge)
{
    for (const double stiffness : {50.0, 2e3, 2e5})
        for (const double rough : {0.0, 0.02}) {  // noise over the depth
            Setting setting(0.0);
            setting.cloth.scene.materials[0].youngs_modulus = stiffness;
            const double depth = hang(setting);
            const State hanging = setting.cloth.state;
            const double at_rest = find_patch_energy(setting.cloth.scene, {}, hanging.mesh);
            std::mt19937 random(3);
            std::normal_distribution<double> shift(0.0, std::max(rough * depth, 1e-300));
            for (std::size_t v = 0; v < hanging.ids.size(); ++v)
                if (setting.patch.is_free[v] != 0) setting.cloth.state.mesh.world[v].z() += shift(random);
            const double begun = find_patch_energy(setting.cloth.scene, {}, setting.cloth.state.mesh);
            // An unreachable energy, so that the cloth relaxes as far as it can.
            setting.patch.wanted = at_rest - setting.energy();
            const double reached = setting.relax();
            EXPECT_LE(reached, begun) << stiffness;
            // Lumping and the mesh's diagonals cause errors of a few per cent. Without gravity in the
            // relaxation the whole depth would be lifted.
            constexpr double kLift = 0.1;
            for (std::size_t v = 0; v < hanging.ids.size(); ++v)
                EXPECT_LT(setting.cloth.state.mesh.world[v].z() - hanging.mesh.world[v].z(), kLift * depth)
                    << stiffness << ", " << rough;
        }
}

TEST(PatchRelaxation, WhatFallsIsNotPaidByFallingForItsStrain)
{
    Setting setting(0.0);
    Scene& scene = setting.cloth.scene;
    scene.gravity = Gravity{};
    scene.materials[0].bending_stiffness = 0.0;  // so that no bending supports a single vertex
    const State before = setting.cloth.state;
    const double weight = scene.materials[0].density * 0.16 * 9.81;
    // The energy after a fall by 5 cm.
    setting.patch.wanted = find_patch_energy(scene, {}, before.mesh) - 0.05 * weight;
    setting.relax();
    // The factor 2: with a consistent mass, a vertex with held neighbours has an inertia of half its weight.
    const double most = 2.0 * 0.01 * scene.eol->mean_lengths[0];
    double fallen = 0.0;
    for (std::size_t v = 0; v < before.ids.size(); ++v)
        fallen = std::max(fallen, before.mesh.world[v].z() - setting.cloth.state.mesh.world[v].z());
    EXPECT_LE(fallen, most);
    EXPECT_GT(fallen, 0.1 * most) << "nothing holds it";
}

TEST(PatchRelaxation, APatchHasTheEnergyThatTheStepFinds)
{
    EolCloth cloth(testing::make_ridge(90.0), make_draped({}));
    cloth.scene.gravity = Gravity{};
    cloth.scene.materials[0].bending_stiffness = 1e-4;
    const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
    for (int k = 0; k < 4; ++k) cloth.add_eol(cloth.vertex_at(0.2, 0.1 + 0.05 * k), false, tip);
    Workspace work;
    prepare(cloth.scene, cloth.state, work);
    const State& state = cloth.state;
    const double truth = compute_energies(work.mesh.elements, work.mesh.terms, state.mesh.world).sum();
    const Creases creases = find_creases(cloth.scene, state, cloth.stars());
    ASSERT_EQ(creases.edges.size(), 3u);
    constexpr double kRoundOff = 1e-12;
    EXPECT_NEAR(find_patch_energy(cloth.scene, creases, state.mesh), truth, kRoundOff);
    // The energy must not depend on the order of faces and vertices.
    std::vector<int> faces(state.mesh.faces.size());
    std::iota(faces.begin(), faces.end(), 0);
    std::reverse(faces.begin(), faces.end());
    EXPECT_NEAR(find_patch_energy(cloth.scene, creases, state.mesh, faces), truth, kRoundOff);
    EXPECT_GT(std::abs(find_patch_energy(cloth.scene, {}, state.mesh) - truth), 1e-6) << "they matter";
}

TEST(PatchRelaxation, FoldsItsCreasesAsTheStepDoes)
{
    // Half of the cloth is held, and the faces have different sizes.
    Setting setting(5e-3);
    Scene& scene = setting.cloth.scene;
    scene.materials[0].youngs_modulus = 5.0;
    scene.materials[0].bending_stiffness = 1e-2;
    State& state = setting.cloth.state;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.01, 0.01);
    for (std::size_t v = 0; v < state.ids.size(); ++v) {
        if (setting.patch.is_free[v] != 0) state.mesh.material[v] += Vec2(shift(random), shift(random));
        if (state.mesh.material[v].x() < 0.2) setting.patch.is_free[v] = 0;
    }
    Creases creases{{0.03}, {}};
    for (int k = 1; k < 7; ++k) {
        const int a = setting.cloth.vertex_at(0.25, 0.05 * k),
                  b = setting.cloth.vertex_at(0.25, 0.05 * (k + 1));
        creases.edges.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(creases.edges.begin(), creases.edges.end());
    const double before = find_patch_energy(scene, creases, state.mesh);
    ASSERT_GT(std::abs(find_patch_energy(scene, {}, state.mesh) - before), 1e-2 * before) << "they matter";
    const double after = arris::relax(scene, creases, setting.patch, state);
    EXPECT_LT(after, 0.9 * before);
    EXPECT_NEAR(after, find_patch_energy(scene, creases, state.mesh), 1e-12 * before);
}

TEST(PatchRelaxation, OfNothingFreeOrOfNothingAtAllDoesNothing)
{
    Setting held(5e-3);
    std::fill(held.patch.is_free.begin(), held.patch.is_free.end(), 0);
    const State before = held.cloth.state;
    EXPECT_NEAR(held.relax(), held.energy(), 1e-12);
    EXPECT_EQ(held.cloth.state.mesh.world, before.mesh.world);

    Setting flat(0.0);
    const State rest = flat.cloth.state;
    flat.relax();
    for (std::size_t v = 0; v < rest.ids.size(); ++v)
        EXPECT_LT((flat.cloth.state.mesh.world[v] - rest.mesh.world[v]).norm(), 1e-15) << "rounding";
}

}  // namespace
}  // namespace arris
