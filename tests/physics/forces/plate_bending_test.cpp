// SPDX-License-Identifier: GPL-3.0-or-later
// The plate against the theory of plates. Forces by x and X are checked in eulerian_forces_test.cpp, strips
// in tests/validation/elastica_mesh_test.cpp.
#include "physics/forces/plate_bending.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "physics/forces/energies.h"
#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kStiffness = 1e-2;  // K, J

struct Sheet {
    ClothMesh mesh;
    MeshTopology topology;
    ClothElements elements;

    explicit Sheet(const ClothMesh& made)
        : mesh(made),
          topology(make_topology(made.vertex_count(), made.faces)),
          elements(make_elements(made, topology))
    {
    }

    std::vector<HingeMoment> moments(const PlateMaterial& plate) const
    {
        return find_hinge_moments({plate}, elements, mesh.world, nullptr);
    }

    double energy(const Terms& terms) const { return compute_energies(elements, terms, mesh.world).bending; }

    /// Both faces of a hinge and their neighbours are inside the sheet.
    bool is_inner(const HingeElement& hinge) const
    {
        return std::none_of(hinge.vertices.begin(), hinge.vertices.end(),
                            [&](int v) { return topology.is_border[v] != 0; });
    }
};

/// A 1 m sheet with vertices far from any pattern, of cells with `cells` a side.
ClothMesh irregular_mesh(int cells, unsigned seed)
{
    ClothGrid grid;
    grid.resolution = {cells, cells};
    grid.pattern = GridPattern::Unstructured;
    ClothMesh mesh = make_cloth_grid(grid);
    const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
    const VertexFaces faces_at(mesh.vertex_count(), mesh.faces);
    Generator random(seed);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2 move = random2(random, 0.3 / cells);
        if (is_border[v]) continue;
        mesh.material[v] += move;
        for (const int f : faces_at[v]) {
            const auto& [a, b, c] = mesh.faces[f];
            if (twice_area(mesh.material[a], mesh.material[b], mesh.material[c]) < 0.05 / (cells * cells)) {
                mesh.material[v] -= move;
                break;
            }
        }
    }
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.world[v] = Vec3(mesh.material[v].x(), mesh.material[v].y(), 0.0);
    return mesh;
}

/// Gives the sheet the height x . H x / 2.
void curve(const Mat2& H, ClothMesh& mesh)
{
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.world[v].z() = 0.5 * mesh.material[v].dot(H * mesh.material[v]);
}

Terms plate_terms(double poisson_ratio)
{
    Terms terms;
    terms.hinges.push_back(
        std::make_unique<PlateBending>(std::vector<PlateMaterial>{{kStiffness, poisson_ratio}}));
    return terms;
}

/// Bending moment tensor of a plate with the curvature H, N: D ((1 - nu) H + nu tr(H)), D = K / (1 - nu^2).
Mat2 moment_of(const Mat2& H, double nu)
{
    return kStiffness / (1.0 - nu * nu) * ((1.0 - nu) * H + nu * H.trace() * Mat2::Identity());
}

std::vector<Mat2> curvatures()
{
    std::vector<Mat2> all(4, Mat2::Zero());
    all[0](0, 0) = 1.0;                // a cylinder
    all[1] << 0.36, 0.48, 0.48, 0.64;  // an oblique cylinder
    all[2] = Mat2::Identity();         // a sphere
    all[3] << 0.0, 1.0, 1.0, 0.0;      // a saddle
    return all;
}

/// At rest in world coordinates, gamma = 1: rhs is the force, matrix the stiffness.
Linearization at_rest(const ClothMesh& mesh)
{
    Linearization at = linearization_at_rest(mesh, 1);
    at.damping = {0.0};
    at.flow.reset();
    at.basis.assign(mesh.world.size(), Mat3::Identity());
    at.has_basis.assign(mesh.world.size(), 0);
    return at;
}

TEST(PlateBending, ExactMomentsOfAConstantCurvatureSolveTheEquationsOnAnyMesh)
{
    // y = L^2 n . M n solves B y = s / L at each hinge whose faces have moments on all edges.
    constexpr double kSmall = 1e-6;      // curvature, 1/m: s is linear in the heights
    constexpr double kTolerance = 1e-6;  // of s, round-off of heights of 1e-6 m
    for (const unsigned seed : {1u, 2u, 3u})
        for (const double nu : {0.0, 0.3, -0.5})
            for (const Mat2& H : curvatures()) {
                ClothMesh mesh = irregular_mesh(8, seed);
                curve(kSmall * H, mesh);
                const Sheet sheet(mesh);
                const PlateMaterial plate{kStiffness, nu};
                const Mat2 M = moment_of(kSmall * H, nu);
                std::vector<double> q(sheet.elements.hinges.size(), 0.0);
                int checked = 0;
                for (std::size_t h = 0; h < q.size(); ++h) {
                    const HingeElement& hinge = sheet.elements.hinges[h];
                    if (!sheet.is_inner(hinge)) continue;
                    for (const int f : hinge.faces) {
                        const Face& face = mesh.faces[f];
                        Vec3 y;
                        int own = -1;
                        for (int i = 0; i < 3; ++i) {
                            const Vec2 e =
                                mesh.material[face[(i + 2) % 3]] - mesh.material[face[(i + 1) % 3]];
                            const Vec2 across(e.y(), -e.x());
                            y[i] = across.dot(M * across);
                            if (face[i] == hinge.vertices[2] || face[i] == hinge.vertices[3]) own = i;
                        }
                        q[h] += plate_compliance(plate, sheet.elements.faces[f]).row(own).dot(y);
                    }
                    std::array<Vec3, 4> x;
                    for (int i = 0; i < 4; ++i) x[i] = mesh.world[hinge.vertices[i]];
                    const auto& [a, b, c, d] = x;
                    const Vec3 e = b - a;
                    const double sine =
                        e.cross(c - a).normalized().cross((d - a).cross(e).normalized()).dot(e);
                    const double s_over_L = -sine / e.squaredNorm();  // theta > 0 bulges towards +z
                    EXPECT_NEAR(q[h], s_over_L, kTolerance * (std::abs(s_over_L) + kSmall));
                    ++checked;
                }
                EXPECT_GT(checked, 50);
            }
}

TEST(PlateBending, NoForceActsInsideASheetOfConstantCurvature)
{
    // The patch test. Moments that are absent at the border reach a few faces into the sheet.
    constexpr double kReached = 1e-4;
    for (const Mat2& H : curvatures()) {
        ClothMesh mesh = irregular_mesh(24, 4);
        curve(1e-4 * H, mesh);
        const Sheet sheet(mesh);
        const Terms terms = plate_terms(0.3);
        Linearization at = at_rest(mesh);
        LinearSystem whole;
        whole.make_pattern(sheet.elements);
        whole.assemble(mesh, sheet.elements, terms, at);
        double inside = 0.0, border = 0.0;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const double force = whole.rhs().segment<3>(3 * v).norm();
            if ((mesh.material[v] - Vec2(0.5, 0.5)).cwiseAbs().maxCoeff() < 0.15)
                inside = std::max(inside, force);
            if (sheet.topology.is_border[v]) border = std::max(border, force);
        }
        EXPECT_LT(inside, kReached * border);
    }
}

TEST(PlateBending, MomentOfALargeCylinderIsKTimesCurvatureInEachDirection)
{
    // A true cylinder of radius 1 m, rolled about an axis at an angle; nu = 0.
    for (const double degrees : {0.0, 20.0, 45.0, 90.0}) {
        std::array<double, 2> worst = {0.0, 0.0};
        for (const int fine : {0, 1}) {
            ClothMesh mesh = irregular_mesh(fine ? 32 : 16, 3);
            const double angle = degrees * M_PI / 180.0;
            const Vec2 across(std::cos(angle), std::sin(angle)), along(-across.y(), across.x());
            for (int v = 0; v < mesh.vertex_count(); ++v) {
                const double t = mesh.material[v].dot(across);
                const Vec2 flat = std::sin(t) * across + mesh.material[v].dot(along) * along;
                mesh.world[v] = Vec3(flat.x(), flat.y(), 1.0 - std::cos(t));
            }
            const Sheet sheet(mesh);
            const std::vector<HingeMoment> moments = sheet.moments({kStiffness, 0.0});
            for (std::size_t h = 0; h < moments.size(); ++h) {
                const HingeElement& hinge = sheet.elements.hinges[h];
                const Vec2 a = mesh.material[hinge.vertices[0]], b = mesh.material[hinge.vertices[1]];
                if ((a - Vec2(0.5, 0.5)).cwiseAbs().maxCoeff() > 0.2) continue;
                const double exact = -kStiffness * std::pow(along.dot(b - a), 2) / (b - a).norm();
                worst[fine] = std::max(worst[fine], std::abs(moments[h].moment - exact) / (b - a).norm());
            }
        }
        EXPECT_LT(worst[0], 0.01 * kStiffness) << degrees;
        EXPECT_LT(worst[1], 0.002 * kStiffness) << degrees;
    }
}

TEST(PlateBending, StiffnessIsAtLeastTheHessianOfTheEnergy)
{
    for (const double nu : {0.0, 0.3}) {
        ClothMesh mesh = irregular_mesh(4, 2);
        const Sheet sheet(mesh);
        const Terms terms = plate_terms(nu);
        Linearization at = at_rest(mesh);
        const int n = mesh.vertex_count();
        LinearSystem system;
        system.make_pattern(sheet.elements);
        const auto heights_of = [&](const Eigen::VectorXd& all) {
            return Eigen::VectorXd(
                Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<3>>(all.data() + 2, n));
        };
        Eigen::MatrixXd hessian(n, n), stiffness(n, n);
        constexpr double kHeight = 1e-6;
        for (int v = 0; v < n; ++v) {
            at.position = mesh.world;
            at.position[v].z() = kHeight;
            system.assemble(mesh, sheet.elements, terms, at);
            hessian.col(v) = -heights_of(system.rhs()) / kHeight;
        }
        at.position = mesh.world;
        system.assemble(mesh, sheet.elements, terms, at);
        const Eigen::MatrixXd lower = system.matrix();
        const Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
        for (int v = 0; v < n; ++v)
            for (int w = 0; w < n; ++w) stiffness(v, w) = whole(3 * v + 2, 3 * w + 2);
        const Eigen::MatrixXd excess = stiffness - 0.5 * (hessian + hessian.transpose());
        const double size = stiffness.norm();
        EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-6 * size);
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(excess).eigenvalues()[0], -1e-6 * size);
        // Nor is it far above: a curved sheet's energy is at most three times the true one.
        for (const Mat2& H : curvatures()) {
            ClothMesh curved = mesh;
            curve(H, curved);
            Eigen::VectorXd z(n);
            for (int v = 0; v < n; ++v) z[v] = curved.world[v].z();
            EXPECT_LT(z.dot(stiffness * z), (nu > 0.0 ? 6.0 : 4.0) * z.dot(hessian * z));
        }
    }
}

TEST(PlateBending, RigidMotionChangesNothing)
{
    ClothMesh mesh = crumpled_sheet({5, 5}, GridPattern::Alternating, 3);
    const Terms terms = plate_terms(0.3);
    const double before = Sheet(mesh).energy(terms);
    const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    for (Vec3& x : mesh.world) x = rotation * x + Vec3(3, -2, 1);
    EXPECT_NEAR(Sheet(mesh).energy(terms), before, 1e-9 * before);
    for (Vec2& X : mesh.material) X = Eigen::Rotation2Dd(0.4) * X + Vec2(1, -5);
    EXPECT_NEAR(Sheet(mesh).energy(terms), before, 1e-9 * before);
}

TEST(PlateBending, ACreaseHasTheEnergyOfBendingAndTakesNoPartInThePlate)
{
    // Two halves of a sheet, folded along a line of creases: the plate is flat on both sides.
    ClothGrid grid;
    grid.resolution = {4, 4};
    grid.pattern = GridPattern::Alternating;
    ClothMesh mesh = make_cloth_grid(grid);
    for (std::size_t v = 0; v < mesh.world.size(); ++v)
        if (const double far = mesh.material[v].x() - 0.5; far > 0.0)
            mesh.world[v] = Vec3(0.5 + 0.8 * far, mesh.material[v].y(), -0.6 * far);
    Sheet sheet(mesh);
    Terms hinges;
    hinges.hinges.push_back(std::make_unique<Bending>(std::vector<double>{kStiffness}));
    const Terms plate = plate_terms(0.3);
    EXPECT_GT(sheet.energy(plate), 0.0);
    for (HingeElement& hinge : sheet.elements.hinges)
        if (mesh.material[hinge.vertices[0]].x() == 0.5 && mesh.material[hinge.vertices[1]].x() == 0.5)
            hinge.crease_width = 0.2;
    update_elements(mesh, std::vector<char>(mesh.world.size(), 1), sheet.elements);
    EXPECT_GT(sheet.energy(plate), 0.0);
    EXPECT_DOUBLE_EQ(sheet.energy(plate), sheet.energy(hinges));
}

TEST(PlateBending, SliversAreSolvedToo)
{
    // Needles of 1e-3 and less: the least energy is still found. A maximum of V over the moments has V = m s
    // / 2.
    ClothMesh mesh = irregular_mesh(6, 5);
    for (Vec2& X : mesh.material) X.y() *= 1e-3;
    for (std::size_t v = 0; v < mesh.world.size(); ++v)
        mesh.world[v] = Vec3(mesh.material[v].x(), mesh.material[v].y(), 0.0);
    Mat2 H = Mat2::Zero();
    H(0, 0) = 1e-3;
    curve(H, mesh);
    // A strip so narrow bends as a beam: K k^2 / 2 per area, less what the free ends of one cell lack.
    const double exact = 0.5 * kStiffness * 1e-6 * 1e-3;
    const double energy = Sheet(mesh).energy(plate_terms(0.3));
    EXPECT_GT(energy, 0.6 * exact);
    EXPECT_LT(energy, 1.001 * exact);
}

/// On a flat plate, where the force is linear: damping's force is the time of damping times the force's rate.
TEST(PlateBending, DampsByTheRateOfItsForce)
{
    constexpr double kDamping = 0.3, kStep = 1e-6;
    const ClothMesh mesh = irregular_mesh(6, 4);
    const Sheet sheet(mesh);
    const Terms terms = plate_terms(0.3);
    std::vector<Vec3> velocity(mesh.world.size(), Vec3::Zero());
    for (std::size_t v = 0; v < velocity.size(); ++v)
        velocity[v] =
            Vec3(0.0, 0.0, std::sin(3.0 * mesh.material[v].x()) * std::cos(5.0 * mesh.material[v].y()));
    const auto system_of = [&](const Linearization& at, LinearSystem& system) {
        system.make_pattern(sheet.elements, std::vector<std::array<int, 2>>());
        system.assemble(mesh, sheet.elements, terms, at);
    };
    const auto force_at = [&](double step) {
        Linearization at = at_rest(mesh);
        for (std::size_t v = 0; v < velocity.size(); ++v) at.position[v] += step * velocity[v];
        LinearSystem system;
        system_of(at, system);
        return Eigen::VectorXd(system.rhs());
    };
    const Eigen::VectorXd rate = (force_at(kStep) - force_at(-kStep)) / (2.0 * kStep);
    // b - A v' at a velocity that does not change, with damping and without.
    const auto residual_with = [&](double damping) {
        Linearization at = at_rest(mesh);
        at.damping = {damping};
        at.v_last = at.v_expansion = at.v_predicted = velocity;
        LinearSystem system;
        system_of(at, system);
        Eigen::VectorXd v(3 * velocity.size());
        for (std::size_t i = 0; i < velocity.size(); ++i) v.segment<3>(3 * static_cast<int>(i)) = velocity[i];
        const Eigen::SparseMatrix<double>& A = system.matrix();
        return Eigen::VectorXd(system.rhs() - A.selfadjointView<Eigen::Lower>() * v);
    };
    const Eigen::VectorXd damping = residual_with(kDamping) - residual_with(0.0);
    EXPECT_GT(rate.norm(), 0.01);
    EXPECT_LT((damping - kDamping * rate).norm(), 1e-3 * damping.norm())
        << "the rates' own tolerance is 1e-4";
}

}  // namespace
}  // namespace arris
