// SPDX-License-Identifier: GPL-3.0-or-later
// Sewn cloth: two halves of a sheet, sewn together along the line that parts them, are the sheet.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/sewing.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/elements/eulerian_element.h"
#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "solver/remesh/sizing_field.h"
#include "solver/step.h"
#include "tests/sewn_cloth.h"
#include "tests/validation/cloth_run.h"
#include "tests/validation/sliding_strip.h"

namespace arris {
namespace {

const Cut kSeam = {0, 0.5, 0.75};

ClothMesh part_and_sew(ClothMesh mesh)
{
    return part_and_sew(std::move(mesh), kSeam);
}

struct SewnCase {
    const char* name;
    BendingModel model;
    GridPattern pattern;
    bool is_two_pieces;  ///< of equal materials
};

void PrintTo(const SewnCase& one, std::ostream* out)
{
    *out << one.name;
}

class Sewn : public ::testing::TestWithParam<SewnCase> {
  protected:
    Scene make_scene(bool is_sewn) const
    {
        Scene scene;
        const Material material = {0.15, 500.0, 0.3, 1e-4, 0.001, 1e-3, GetParam().model};
        scene.materials = material;
        if (is_sewn && GetParam().is_two_pieces) scene.materials.add(kSeam.at + 0.5 * kSeam.apart, material);
        scene.gravity.emplace();
        return scene;
    }
    ClothMesh whole() const { return make_sheet({1.0, 0.6}, {10, 6}, GetParam().pattern); }
};

/// Greatest distance between the vertices of two states.
double distance(const State& a, const State& b)
{
    double greatest = 0.0;
    for (std::size_t v = 0; v < a.mesh.world.size(); ++v)
        greatest = std::max(greatest, (a.mesh.world[v] - b.mesh.world[v]).norm());
    return greatest;
}

TEST_P(Sewn, HasTheAreaAndEnergiesOfTheSheet)
{
    ClothMesh sheet = whole();
    for (Vec3& x : sheet.world)
        x = Vec3(1.05 * x.x(), x.y(), 0.1 * std::sin(7.0 * x.x()) * std::cos(3.0 * x.y()));
    const ClothMesh sewn = part_and_sew(sheet);
    ASSERT_EQ(validate(sewn), "");
    EXPECT_NEAR(material_area(sewn), material_area(sheet), 1e-15);
    const auto energies_of = [&](const ClothMesh& mesh, const Scene& scene) {
        const ClothElements elements = list_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces),
                                                     HingeUse::Terms, scene.materials);
        return compute_energies(elements, make_terms(scene.materials, scene.gravity, {}, {}), mesh.world);
    };
    const Energies one = energies_of(sheet, make_scene(false)), two = energies_of(sewn, make_scene(true));
    EXPECT_GT(one.bending, 1e-6);
    EXPECT_NEAR(two.bending, one.bending, 1e-11 * one.bending);
    EXPECT_NEAR(two.stretch, one.stretch, 1e-11 * one.stretch);
    EXPECT_NEAR(two.gravity, one.gravity, 1e-12 * std::abs(one.gravity) + 1e-15);
}

TEST_P(Sewn, MovesAsTheSheet)
{
    const auto run_of = [&](bool is_sewn) {
        Scene scene = make_scene(is_sewn);
        scene.pins.push_back({{{0.0, 0.0}, {0.0, 0.6}}, {}});
        return ClothRun(std::move(scene), is_sewn ? part_and_sew(whole()) : whole(), Vec3(0.0, 0.2, 0.1));
    };
    ClothRun sheet = run_of(false), sewn = run_of(true);
    sheet.advance(0.005);
    sewn.advance(0.005);
    EXPECT_LT(distance(sheet.state, sewn.state), 1e-13);
    for (int k = 1; k < 100; ++k) {
        sheet.advance(0.005);
        sewn.advance(0.005);
    }
    EXPECT_LT(distance(sheet.state, sewn.state), 1e-6);
    EXPECT_GT(distance(sheet.state, make_state(sheet.scene, whole(), Vec3::Zero())), 0.3);
}

TEST_P(Sewn, DrapesAsTheSheet)
{
    const auto run_of = [&](bool is_sewn) {
        Scene scene = make_scene(is_sewn);
        scene.friction =
            Friction{std::vector<double>(static_cast<std::size_t>(scene.materials.count()), 0.3), {}, {}};
        scene.self_contact = ClothContact{1e-3};
        ClothMesh mesh = whole();
        lay(mesh, {-0.3, -0.3, 0.22});
        const Mat3 turn = (Eigen::AngleAxisd(0.4, Vec3::UnitY()) * Eigen::AngleAxisd(0.2, Vec3::UnitX()))
                              .toRotationMatrix();
        for (Vec3& x : mesh.world) x = turn * x + Vec3(0.02, 0.01, 0.17);
        if (is_sewn) mesh = part_and_sew(mesh);
        scene.obstacles.push_back(MovingObstacle("table", make_box({0.4, 0.4, 0.4}), {}, {}, 30.0));
        return ClothRun(std::move(scene), std::move(mesh));
    };
    ClothRun sheet = run_of(false), sewn = run_of(true);
    for (int k = 0; k < 100; ++k) {
        sheet.advance(0.005);
        sewn.advance(0.005);
    }
    EXPECT_LT(distance(sheet.state, sewn.state), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Seams, Sewn,
    ::testing::Values(SewnCase{"hinges", BendingModel::Hinge, GridPattern::Diagonal, false},
                      SewnCase{"plate", BendingModel::Plate, GridPattern::Cross, false},
                      SewnCase{"hinges_of_two_pieces", BendingModel::Hinge, GridPattern::Cross, true},
                      SewnCase{"plate_of_two_pieces", BendingModel::Plate, GridPattern::Diagonal, true}),
    [](const auto& sewn) { return std::string(sewn.param.name); });

/// A hinge between two materials is two plates in series.
TEST(SeamHinge, BendsAsTwoPlatesInSeries)
{
    // Two triangles whose areas are 1 : 3, on a seam.
    ClothMesh mesh;
    mesh.material = {{0, 0}, {1, 0}, {0.5, 0.5}, {0.5, -1.5}, {9, 0}, {10, 0}};
    mesh.material[3] = {9.5, -1.5};
    mesh.world = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.45, 0.2}, {0.5, -1.5, 0}};
    mesh.faces = {{0, 1, 2}, {1, 0, 3}};
    mesh.face_points = {{0, 1, 2}, {5, 4, 3}};
    mesh.seam_vertices = {0, 1};
    ASSERT_EQ(validate(mesh), "");
    const auto bending_of = [&](double c, double d) {
        Materials materials(Material{0.1, 100.0, 0.3, c});
        materials.add(5.0, Material{0.1, 100.0, 0.3, d});
        const ClothElements elements =
            list_elements(mesh, make_topology(4, mesh.faces), HingeUse::Terms, materials);
        return compute_energies(elements, make_terms(materials, {}, {}, {}), mesh.world).bending;
    };
    const double equal = bending_of(1.0, 1.0);
    EXPECT_NEAR(bending_of(2.0, 6.0), equal * 4.0 / (1.0 / 2.0 + 3.0 / 6.0), 1e-12 * equal);
    EXPECT_EQ(bending_of(2.0, 0.0), 0.0);
}

/// Material that flows at a seam's hinge: along the seam at its ends, freely at the two other vertices.
TEST(SeamHinge, ForceOnFlowingMaterialIsTheSlopeOfTheEnergy)
{
    // The second face lies turned in the material, and is larger by a quarter.
    ClothMesh mesh = make_sheet({1.0, 1.0}, {1, 1}, GridPattern::Diagonal);
    mesh.world[0].z() = 0.3;
    mesh.world[3].z() = 0.2;
    const MeshTopology flat = make_topology(mesh.vertex_count(), mesh.faces);
    ASSERT_EQ(flat.hinges.size(), 1u);
    const Hinge whole = flat.hinges[0];
    const Mat2 turn = 1.25 * Eigen::Rotation2Dd(0.7).toRotationMatrix();
    mesh.face_points = mesh.faces;
    for (const int end : {whole.a, whole.b}) {
        std::replace(mesh.face_points[whole.face_d].begin(), mesh.face_points[whole.face_d].end(), end,
                     static_cast<int>(mesh.material.size()));
        mesh.material.push_back(Vec2(5.0, 0.0) + turn * mesh.material[end]);
        mesh.seam_vertices.push_back(end);
    }
    mesh.material[whole.d] = Vec2(5.0, 0.0) + turn * mesh.material[whole.d];
    ASSERT_EQ(validate(mesh), "");
    for (const BendingModel model : {BendingModel::Hinge, BendingModel::Plate}) {
        Materials materials(Material{0.1, 100.0, 0.3, 0.2, 0.0, 1e-3, model});
        materials.add(3.0, Material{0.1, 100.0, 0.3, 0.7, 0.0, 1e-3, model});
        const Terms terms = make_terms(materials, {}, {}, {});
        const auto elements_of = [&](const ClothMesh& at) {
            return list_elements(at, make_topology(at.vertex_count(), at.faces), HingeUse::Terms, materials);
        };
        const ClothElements elements = elements_of(mesh);
        const HingeElement& hinge = elements.hinges[0];
        Linearization at;
        at.gamma = 1.0;
        at.damping = {0.0, 0.0};
        at.position = mesh.world;
        at.v_predicted = at.v_expansion = at.v_last = at.drift = std::vector<Vec3>(4, Vec3::Zero());
        MaterialFlow& flow = at.flow.emplace();
        flow.is_eulerian.assign(4, 1);
        flow.position = mesh.material;
        flow.v_predicted = flow.v_expansion = flow.v_last = std::vector<Vec2>(6, Vec2::Zero());
        const HingeStates states(elements, terms, at);
        HingeSystem system = eulerian_hinge(hinge, states.moment(0), elements, terms, at);
        Mat23 both = Mat23::Zero();
        both.leftCols<2>().setIdentity();
        const Mat3 none = Mat3::Zero();
        system.reduce_eulerian({&none, &none, &none, &none}, {&both, &both, &both, &both});
        const auto slope = [&](int i, const Vec2& way) {
            constexpr double kStep = 1e-6;
            const auto energy = [&](double step) {
                ClothMesh moved = mesh;
                const int v = hinge.vertices[static_cast<std::size_t>(i)];
                moved.material[v] += step * way;
                for (int p = 4; p < 6; ++p)
                    if (mesh.vertex_of(p) == v) moved.material[p] += step * (turn * way);
                return compute_energies(elements_of(moved), terms, mesh.world).bending;
            };
            return (energy(kStep) - energy(-kStep)) / (2.0 * kStep);
        };
        const Vec2 along = mesh.material[hinge.vertices[1]] - mesh.material[hinge.vertices[0]];
        for (int i = 0; i < 2; ++i)
            EXPECT_NEAR(system.rhs(i).head<2>().dot(along), -slope(i, along), 1e-8) << i;
        for (int i = 2; i < 4; ++i)
            for (const Vec2& way : {Vec2(Vec2::UnitX()), Vec2(Vec2::UnitY())})
                EXPECT_NEAR(system.rhs(i).head<2>().dot(way), -slope(i, way), 1e-8) << i;
        EXPECT_GT(std::abs(slope(0, along)), 1e-3);
    }
}

/// A tube of `n` sides about z, sewn to itself along a line; from z = 0 down to -length in `m` rows.
ClothMesh make_tube(int n, int m, double radius, double length)
{
    ClothMesh mesh;
    std::vector<int> vertex_of;
    const double side = 2.0 * radius * std::sin(std::numbers::pi / n);
    for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= n; ++i) {
            const double angle = 2.0 * std::numbers::pi * (i % n) / n;
            mesh.material.push_back({side * i, length * j / m});
            mesh.world.push_back({radius * std::cos(angle), -radius * std::sin(angle), -length * j / m});
            vertex_of.push_back(j * n + i % n);
        }
    const auto at = [&](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < n; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return sew(mesh, vertex_of);
}

/// A frustum of a cone about z, of `sides` flat sides, from slant height `first` to `last` below its tip,
/// which is at (0, 0, tip). `half_angle`: of its sides, rad.
struct Cone {
    int sides;
    double half_angle, tip;

    /// Along an edge between two sides at unit slant height along the sides' middles.
    Vec3 edge(int k) const
    {
        const double turn = 2.0 * std::numbers::pi * k / sides;
        const double radius = std::sin(half_angle) / std::cos(std::numbers::pi / sides);
        return {radius * std::cos(turn), radius * std::sin(turn), -std::cos(half_angle)};
    }
    /// Half the angle of a side at the tip, in its plane, rad.
    double half_side() const { return std::atan(std::tan(std::numbers::pi / sides) * std::sin(half_angle)); }
};

ObstacleMesh make_cone_obstacle(const Cone& cone, double first, double last)
{
    ObstacleMesh mesh;
    for (const double s : {first, last})
        for (int k = 0; k < cone.sides; ++k) mesh.points.push_back(Vec3(0, 0, cone.tip) + s * cone.edge(k));
    const int n = cone.sides, top = 2 * n, bottom = 2 * n + 1;
    mesh.points.push_back(Vec3(0, 0, cone.tip - first * std::cos(cone.half_angle)));
    mesh.points.push_back(Vec3(0, 0, cone.tip - last * std::cos(cone.half_angle)));
    for (int k = 0; k < n; ++k) {
        const int l = (k + 1) % n;
        mesh.faces.push_back({k, n + k, l});
        mesh.faces.push_back({l, n + k, n + l});
        mesh.faces.push_back({top, k, l});
        mesh.faces.push_back({bottom, n + l, n + k});
    }
    return mesh;
}

/// A sector, sewn to itself: it lies on the cone without strain. Rows are at equal steps of slant height.
ClothMesh make_cone_cloth(const Cone& cone, int rows, double first, double last)
{
    ClothMesh mesh;
    std::vector<int> vertex_of;
    const double step = 2.0 * cone.half_side(), stretch = 1.0 / std::cos(cone.half_side());
    for (int j = 0; j <= rows; ++j) {
        const double s = first + (last - first) * j / rows;
        for (int k = 0; k <= cone.sides; ++k) {
            mesh.material.push_back(s * stretch * Vec2(std::cos(k * step), std::sin(k * step)));
            mesh.world.push_back(Vec3(0, 0, cone.tip) + s * cone.edge(k % cone.sides));
            vertex_of.push_back(j * cone.sides + k % cone.sides);
        }
    }
    const auto at = [&](int k, int j) { return j * (cone.sides + 1) + k; };
    for (int j = 0; j < rows; ++j)
        for (int k = 0; k < cone.sides; ++k) {
            const int a = at(k, j), b = at(k, j + 1), c = at(k + 1, j + 1), d = at(k + 1, j);
            const bool is_even =
                (k + j) % 2 == 0;  // diagonals alternate: all in one sense would twist the cloth
            mesh.faces.push_back(is_even ? Face{a, b, c} : Face{a, b, d});
            mesh.faces.push_back(is_even ? Face{a, c, d} : Face{b, c, d});
        }
    return sew(mesh, vertex_of);
}

/// Greatest error of the way down the cone, relative to the greatest way. Held at slant height s_0, without
/// bending and with Poisson ratio 0, cloth on a frictionless cone comes down by u = a s + b / s - q s^2 / (3
/// E), q = rho g cos(half angle): u'' s + u' - u / s = -q s / E.
double measure_cone(int cells)
{
    constexpr double kFirst = 0.3, kLast = 0.8, kDensity = 0.2, kModulus = 2e2, kG = 9.81, kThickness = 1e-3;
    const double angle = std::numbers::pi / 6.0, q = kDensity * kG * std::cos(angle);
    Cone cone{cells, angle, 1.0};
    Scene scene;
    scene.materials = Material{kDensity, kModulus, 0.0, 0.0, 0.0, kThickness};
    scene.gravity.emplace();
    scene.obstacles.push_back(MovingObstacle("cone", make_cone_obstacle(cone, 0.2, 1.0), {}, {}, 150.0));
    cone.tip += kThickness / std::sin(angle);  // the cloth's, at its stand-off
    const ClothMesh cloth = make_cone_cloth(cone, cells / 2, kFirst, kLast);
    EXPECT_EQ(validate(cloth), "");
    for (const Vec2& X : cloth.material)
        if (X.norm() < kFirst / std::cos(cone.half_side()) + 1e-6)
            scene.pins.push_back({{X - Vec2(1e-6, 1e-6), X + Vec2(1e-6, 1e-6)}, {}});
    // On this ridge the cloth stays; elsewhere it may slip off the ridges, a little way to its sides.
    scene.pins.push_back({{{0.0, -1e-6}, {1.0, 1e-6}}, {}, {false, true, false}});
    ClothRun run(std::move(scene), cloth);
    settle(run);
    // u(s_0) = 0 and u'(s_1) = 0.
    Mat2 conditions;
    conditions << kFirst, 1.0 / kFirst, 1.0, -1.0 / (kLast * kLast);
    const Vec2 ab = conditions.inverse() *
                    Vec2(q * kFirst * kFirst / (3.0 * kModulus), 2.0 * q * kLast / (3.0 * kModulus));
    double worst = 0.0, greatest = 0.0;
    for (std::size_t v = 0; v < cloth.world.size(); v += static_cast<std::size_t>(cells)) {  // on that ridge
        const double s = (cone.tip - cloth.world[v].z()) / std::cos(angle);
        const double u = ab[0] * s + ab[1] / s - q * s * s / (3.0 * kModulus);
        const double way = (cloth.world[v].z() - run.state.mesh.world[v].z()) / std::cos(angle);
        worst = std::max(worst, std::abs(way - u));
        greatest = std::max(greatest, u);
    }
    EXPECT_GT(greatest, 1e-4);
    return worst / greatest;
}

TEST(SewnCone, HangsOnAConeAsTheClosedFormSays)
{
    const double coarse = measure_cone(16), fine = measure_cone(32);
    EXPECT_LT(fine, 0.005);
    EXPECT_GT(coarse / fine, 3.5) << "second order; " << coarse << ", " << fine;
}

/// Hung by its rim, a tube of Poisson ratio 0 stretches as a rope: u(z) = rho g (L z - z^2 / 2) / E, at
/// vertices exactly.
TEST(SewnTube, HangsAsARope)
{
    constexpr double kLength = 0.5, kDensity = 0.2, kModulus = 40.0, kG = 9.81;
    const ClothMesh tube = make_tube(12, 10, 0.1, kLength);
    ASSERT_EQ(validate(tube), "");
    Scene scene;
    scene.materials = Material{kDensity, kModulus, 0.0, 0.0};
    scene.gravity.emplace();
    scene.pins.push_back({{{0.0, 0.0}, {1.0, 0.0}}, {}});
    ClothRun run(std::move(scene), tube);
    settle(run);
    double worst = 0.0;
    for (std::size_t v = 0; v < tube.world.size(); ++v) {
        const double z = -tube.world[v].z();
        const double u = kDensity * kG * (kLength * z - 0.5 * z * z) / kModulus;
        worst = std::max(worst, (run.state.mesh.world[v] - (tube.world[v] - Vec3(0.0, 0.0, u))).norm());
    }
    EXPECT_LT(worst, 1e-6);
}

TEST(SewnTube, KeepsItsMomentumInFlight)
{
    Scene scene;
    scene.materials = Material{0.2, 300.0, 0.3, 1e-4};
    ClothRun run(std::move(scene), make_tube(9, 6, 0.1, 0.3), Vec3(1.0, -2.0, 3.0));
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v)
        run.state.velocity[v] += Vec3(std::sin(7.0 * v), std::cos(5.0 * v), std::sin(3.0 * v));
    const auto momentum = [&] {
        return linear_momentum(run.scene.materials, run.work.mesh.elements, run.state.velocity);
    };
    run.advance(0.002);
    const Vec3 before = momentum();
    for (int k = 0; k < 50; ++k) run.advance(0.002);
    EXPECT_LT((momentum() - before).norm(), 1e-12 * before.norm());
}

/// Remeshing changes both sides of the seam, and neither the material nor its momentum.
TEST(SewnTube, KeepsItsMomentumThroughRemeshing)
{
    Scene scene;
    scene.materials = Material{0.2, 300.0, 0.3, 1e-4};
    const ClothMesh tube = make_tube(12, 8, 0.1, 0.3);
    Remeshing remesh;
    remesh.shortest = 0.012;
    remesh.longest = 0.08;
    measure_first_mesh(tube, remesh);
    scene.remesh = remesh;
    ClothRun run(std::move(scene), tube, Vec3(1.0, -2.0, 3.0));
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v)
        run.state.velocity[v] += 2.0 * Vec3(std::sin(7.0 * v), std::cos(5.0 * v), std::sin(3.0 * v));
    const auto momentum = [&] {
        return linear_momentum(run.scene.materials, run.work.mesh.elements, run.state.velocity);
    };
    run.advance(0.002);
    const Vec3 before = momentum();
    int operations = 0;
    std::set<std::size_t> seams;  // numbers of further points
    for (int k = 0; k < 150; ++k) {
        operations += run.advance(0.002).remeshed;
        seams.insert(run.state.seam_ids.size());
    }
    EXPECT_GT(operations, 50);
    EXPECT_GT(seams.size(), 2u) << "the seam's edges change, too";
    EXPECT_LT((momentum() - before).norm(), 1e-11 * before.norm());
    EXPECT_EQ(validate(run.state.mesh), "");
    EXPECT_NEAR(material_area(run.state.mesh), material_area(tube), 1e-13);
}

/// Two fabrics in series, of Poisson ratio 0: each stretches by F / (E width) of its length.
TEST(SewnStrip, OfTwoFabricsStretchesAsTheyDoInSeries)
{
    constexpr double kWidth = 0.6, kFirst = 50.0, kSecond = 200.0, kForce = 1.2;
    const ClothMesh strip = part_and_sew(make_sheet({1.0, kWidth}, {10, 6}, GridPattern::Diagonal));
    Scene scene;
    scene.materials = Material{0.1, kFirst, 0.0, 1e-5};
    scene.materials.add(kSeam.at + 0.5 * kSeam.apart, Material{0.4, kSecond, 0.0, 1e-3});
    scene.pins.push_back({{{0.0, 0.0}, {0.0, kWidth}}, {}});
    scene.pulls.push_back({{{1.0 + kSeam.apart, 0.0}, {1.0 + kSeam.apart, kWidth}}, Vec3(kForce, 0.0, 0.0)});
    ClothRun run(std::move(scene), strip);
    settle(run);
    const double tension = kForce / kWidth;
    double worst = 0.0;
    for (std::size_t v = 0; v < strip.world.size(); ++v) {
        const double x = strip.world[v].x();
        const double u = tension * (std::min(x, kSeam.at) / kFirst + std::max(x - kSeam.at, 0.0) / kSecond);
        worst = std::max(worst, (run.state.mesh.world[v] - (strip.world[v] + Vec3(u, 0.0, 0.0))).norm());
    }
    EXPECT_LT(worst, 1e-9);
}

/// A strip clamped in its middle bends under its weight G = rho g L^3 / K, with a seam along it and one
/// across.
TEST(SewnStrip, BendsAsOneStripDoes)
{
    constexpr double kBending = 1e-2, kModulus = 1e4, kWidth = 0.25;
    const ClothMesh whole = make_sheet({2.0, kWidth}, {32, 4}, GridPattern::Alternating);
    for (const BendingModel model : {BendingModel::Hinge, BendingModel::Plate})
        for (const double weight : {5.0, 20.0}) {
            const auto settled = [&](const ClothMesh& mesh) {
                Scene scene;
                scene.materials = Material{1.0, kModulus, 0.0, kBending, 0.0, 1e-3, model};
                scene.gravity = Gravity{Vec3(0.0, 0.0, -weight * kBending)};
                scene.pins.push_back({{{1.0, 0.0}, {1.0, 2.0}}, {}});
                ClothRun run(std::move(scene), mesh);
                settle(run);
                return run.state;
            };
            const State sheet = settled(whole);
            EXPECT_LT(sheet.mesh.world[0].z(), -0.4);
            for (const Cut& cut : {Cut{.axis = 1, .at = 0.5 * kWidth, .apart = 0.5},
                                   Cut{.axis = 0, .at = 1.5, .apart = 0.75, .degrees = 40.0}})
                EXPECT_LT(distance(settled(part_and_sew(whole, cut)), sheet), 1e-8)
                    << "seam across axis " << cut.axis << ", G = " << weight;
        }
}

/// A strip that slides over a table's edge, sewn of two along a seam that crosses the edge.
TEST(SewnStrip, SlidesOverAnEdgeAsOneStripDoes)
{
    constexpr double kTimeError = 5e-4;  // of BDF2 at 5 ms, relative to the way: as that of one strip
    for (const int cells : {8, 16, 32})
        for (const double degrees : {0.0, 30.0}) {
            StripCase strip{.width = 0.5, .cells = {cells, cells / 2}};
            strip.seam = Cut{.axis = 1, .at = 0.25, .degrees = degrees};
            ClothRun run = make_strip_run(strip);
            const SlidingChain chain(strip.slopes, strip.length, strip.start);
            const double until = 0.9 * chain.lift_off();
            double worst = 0.0;
            int rows = 0;
            while (run.state.time < until && !run.failures.any()) {
                rows += run.advance(0.005).feature_rows;
                const double way = chain.length_after(run.state.time);
                worst = std::max(worst, std::abs(measure_length_after(strip, run) / way - 1.0));
            }
            EXPECT_LT(worst, kTimeError) << cells << " cells, turned by " << degrees;
            EXPECT_EQ(rows, 0) << cells << " cells, turned by " << degrees;
            EXPECT_EQ(run.state.eol.size(), static_cast<std::size_t>(cells / 2 + 1));
            EXPECT_EQ(validate(run.state.mesh), "");
        }
}

/// A seam along the edge: no vertex of a trace can be where the seam passes. The cloth loses its speed there.
TEST(SewnStrip, PassesAnEdgeWithASeamAlongIt)
{
    StripCase strip{.width = 0.5, .cells = {8, 4}};
    strip.seam = Cut{.axis = 0, .at = 0.75};
    ClothRun run = make_strip_run(strip);
    run.advance(0.9 * SlidingChain(strip.slopes, strip.length, strip.start).lift_off(), 0.005);
    EXPECT_GT(measure_length_after(strip, run), strip.length - strip.seam->at + 0.03);
    EXPECT_GE(run.state.eol.size(), 3u) << "the trace goes on beyond the seam";
}

}  // namespace
}  // namespace arris
