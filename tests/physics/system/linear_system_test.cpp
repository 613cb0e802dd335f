// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/linear_system.h"
#include "physics/forces/make_terms.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Dense>
#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/forces/inertia.h"

namespace arris {
namespace {

struct Sheet {
    ClothMesh mesh;
    ClothElements elements;
    Terms terms;
    Linearization at;
    LinearSystem system;
};

/// A crumpled, moving sheet under every effect.
Sheet make_sheet(std::array<int, 2> resolution, GridPattern pattern)
{
    Sheet sheet;
    ClothGrid grid;
    grid.resolution = resolution;
    grid.pattern = pattern;
    sheet.mesh = make_cloth_grid(grid);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> noise(-0.3 / resolution[0], 0.3 / resolution[0]);
    for (Vec3& x : sheet.mesh.world) x += Vec3(noise(random), noise(random), noise(random));
    const int n = sheet.mesh.vertex_count();
    sheet.elements = make_elements(sheet.mesh, make_topology(n, sheet.mesh.faces));
    Material material{0.15, 500.0, 0.3, 1e-4, 0.01, 1e-3};
    sheet.terms = make_terms(material, Gravity{}, Wind{Vec3(1, 2, 3), 1.2, 1.0, {}},
                             {Pull{{Vec2(0, 0), Vec2(0.5, 1)}, Vec3(1, 0, 0)}});
    Linearization& at = sheet.at;
    at.time = at.gamma = 0.005;
    at.damping = {0.01};
    at.position = sheet.mesh.world;
    at.v_last.resize(n);
    for (Vec3& v : at.v_last) v = Vec3(noise(random), noise(random), noise(random));
    at.v_predicted = at.v_expansion = at.v_last;
    at.drift.assign(n, Vec3::Zero());
    at.basis.assign(n, Mat3::Identity());
    at.has_basis.assign(n, 0);
    sheet.system.make_pattern(sheet.elements);
    return sheet;
}

Eigen::MatrixXd dense(const LinearSystem& system)
{
    const Eigen::MatrixXd lower = system.matrix();
    return lower.selfadjointView<Eigen::Lower>();
}

TEST(LinearSystem, IsTheSumOfItsElements)
{
    Sheet sheet = make_sheet({4, 3}, GridPattern::Cross);
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    const int n = sheet.mesh.vertex_count();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(3 * n);
    const auto add = [&](const auto& vertices, const auto& local) {
        for (int i = 0; i < static_cast<int>(vertices.size()); ++i) {
            rhs.segment<3>(3 * vertices[i]) += local.rhs(i);
            for (int j = 0; j <= i; ++j) {
                matrix.block<3, 3>(3 * vertices[i], 3 * vertices[j]) += local.matrix(i, j);
                if (i != j)
                    matrix.block<3, 3>(3 * vertices[j], 3 * vertices[i]) += local.matrix(i, j).transpose();
            }
        }
    };
    for (const FaceElement& face : sheet.elements.faces) {
        FaceSystem local(sheet.at, face.vertices);
        for (const auto& term : sheet.terms.faces) term->add(FaceState(face, sheet.at.position), local);
        add(face.vertices, local);
    }
    for (const HingeElement& hinge : sheet.elements.hinges) {
        HingeSystem local(sheet.at, hinge.vertices);
        for (const auto& term : sheet.terms.hinges) term->add(HingeState(hinge, sheet.at.position), local);
        add(hinge.vertices, local);
    }
    for (const LoadShare& share : spread_over_box(sheet.mesh, {Vec2(0, 0), Vec2(0.5, 1)}))
        rhs[3 * share.vertex] += sheet.at.gamma * share.weight;
    EXPECT_LT((dense(sheet.system) - matrix).norm(), 1e-13 * matrix.norm());
    EXPECT_LT((sheet.system.rhs() - rhs).norm(), 1e-13 * rhs.norm());
}

TEST(LinearSystem, IsPositiveDefinite)
{
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross}) {
        Sheet sheet = make_sheet({5, 5}, pattern);
        sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
        EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(dense(sheet.system)).info(), Eigen::Success);
    }
}

TEST(LinearSystem, IsReducedByTheVerticesBases)
{
    Sheet sheet = make_sheet({3, 3}, GridPattern::Diagonal);
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    const Eigen::MatrixXd matrix = dense(sheet.system);
    const Eigen::VectorXd rhs = sheet.system.rhs();

    // Every second vertex gets an oblique basis: A -> B^T A B, b -> B^T b.
    const int n = sheet.mesh.vertex_count();
    Eigen::MatrixXd B = Eigen::MatrixXd::Identity(3 * n, 3 * n);
    for (int v = 0; v < n; v += 2) {
        sheet.at.has_basis[v] = 1;
        sheet.at.basis[v] << 1, 0.2, 0, -0.3, 1, 0.1, 0, 0.4, 0.9;
        B.block<3, 3>(3 * v, 3 * v) = sheet.at.basis[v];
    }
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    EXPECT_LT((dense(sheet.system) - B.transpose() * matrix * B).norm(), 1e-13 * matrix.norm());
    EXPECT_LT((sheet.system.rhs() - B.transpose() * rhs).norm(), 1e-13 * rhs.norm());
}

TEST(LinearSystem, DriftIsWhatAShiftOfTheUnknownWouldBe)
{
    // v' = drift + u: A (drift + u) = b for the plain system, so b_drift = b - A drift.
    Sheet sheet = make_sheet({3, 2}, GridPattern::Cross);
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    const Eigen::MatrixXd matrix = dense(sheet.system);
    const Eigen::VectorXd rhs = sheet.system.rhs();
    const int n = sheet.mesh.vertex_count();
    Eigen::VectorXd drift(3 * n);
    for (int v = 0; v < n; ++v) {
        sheet.at.drift[v] = Vec3(0.1 * v, -1.0, 2.0 - 0.3 * v);
        drift.segment<3>(3 * v) = sheet.at.drift[v];
    }
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    EXPECT_LT((sheet.system.rhs() - (rhs - matrix * drift)).norm(),
              1e-12 * (rhs.norm() + (matrix * drift).norm()));
}

TEST(LinearSystem, OfWhatIsNotHeldIsThatPartOfTheWhole)
{
    Sheet sheet = make_sheet({5, 4}, GridPattern::Cross);
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    const Eigen::MatrixXd whole = dense(sheet.system);
    const Eigen::VectorXd rhs = sheet.system.rhs();

    // Two of three vertices.
    std::vector<int> places(sheet.mesh.world.size(), -1), loose;
    for (int v = 0; v < sheet.mesh.vertex_count(); ++v) {
        if (v % 3 == 0) continue;
        places[v] = static_cast<int>(loose.size());
        loose.push_back(v);
    }
    sheet.system.make_pattern(sheet.elements, places);
    sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
    sheet.system.add_to_vertex(1, Vec3(1, 2, 3) * Vec3(1, 2, 3).transpose());
    Eigen::MatrixXd part = dense(sheet.system);
    part.block<3, 3>(3, 3) -= Vec3(1, 2, 3) * Vec3(1, 2, 3).transpose();
    ASSERT_EQ(part.rows(), static_cast<Eigen::Index>(3 * loose.size()));
    for (int i = 0; i < static_cast<int>(loose.size()); ++i) {
        const Vec3 of_part = sheet.system.rhs().segment<3>(3 * i), of_whole = rhs.segment<3>(3 * loose[i]);
        EXPECT_EQ(of_part, of_whole) << i;
        for (int j = 0; j < static_cast<int>(loose.size()); ++j) {
            const Mat3 difference =
                part.block<3, 3>(3 * i, 3 * j) - whole.block<3, 3>(3 * loose[i], 3 * loose[j]);
            EXPECT_LT(difference.norm(), 1e-15 * whole.norm()) << i << " " << j;
        }
    }
}

TEST(LinearSystem, IsBitIdenticalForAnyNumberOfThreads)
{
    Sheet sheet = make_sheet({40, 40}, GridPattern::Cross);
    std::vector<double> first;
    for (const int threads : {1, 2, 4, 2}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        sheet.system.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
        std::vector<double> values(sheet.system.matrix().valuePtr(),
                                   sheet.system.matrix().valuePtr() + sheet.system.matrix().nonZeros());
        values.insert(values.end(), sheet.system.rhs().begin(), sheet.system.rhs().end());
        if (first.empty()) first = values;
        EXPECT_EQ(values, first) << threads << " threads";
    }
}

TEST(ElementColors, NoTwoElementsOfAColorShareAVertex)
{
    // A fan of 200 faces around one vertex needs 200 colours.
    ClothMesh fan;
    const int spokes = 200;
    fan.material.push_back(Vec2::Zero());
    for (int k = 0; k < spokes; ++k)
        fan.material.push_back(Vec2(std::cos(2 * M_PI * k / spokes), std::sin(2 * M_PI * k / spokes)));
    for (int k = 0; k < spokes; ++k) fan.faces.push_back({0, 1 + k, 1 + (k + 1) % spokes});
    fan.world.resize(fan.material.size());
    for (const ClothMesh& mesh : {fan, make_sheet({7, 5}, GridPattern::Alternating).mesh}) {
        const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
        const auto check = [&](const ElementColors& colors, const auto& list) {
            std::vector<int> seen(mesh.vertex_count(), -1);
            EXPECT_EQ(colors.order.size(), list.size());
            for (int k = 0; k + 1 < static_cast<int>(colors.start.size()); ++k)
                for (int i = colors.start[k]; i < colors.start[k + 1]; ++i)
                    for (const int v : list[colors.order[i]].vertices) {
                        EXPECT_NE(seen[v], k) << "vertex " << v << " twice in colour " << k;
                        seen[v] = k;
                    }
        };
        check(elements.face_colors, elements.faces);
        check(elements.hinge_colors, elements.hinges);
    }
}

TEST(KineticEnergy, OfARigidTranslationIsHalfMassSpeedSquared)
{
    const Sheet sheet = make_sheet({6, 6}, GridPattern::Cross);
    const std::vector<Vec3> velocity(sheet.mesh.world.size(), Vec3(1.0, -2.0, 2.0));
    EXPECT_NEAR(kinetic_energy(Material{0.15}, sheet.elements, velocity), 0.5 * 0.15 * 9.0, 1e-14);
    EXPECT_LT((linear_momentum(Material{0.15}, sheet.elements, velocity) - 0.15 * velocity[0]).norm(), 1e-14);
}

}  // namespace
}  // namespace arris
