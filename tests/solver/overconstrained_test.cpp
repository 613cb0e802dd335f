// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/overconstrained.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/contact/contact_plane.h"
#include "geometry/rigid_motion.h"
#include "solver/contact/constraints.h"

namespace arris {
namespace {

/// A solved step of an EOL vertex between two obstacles, with contact normals `angle` (degrees) apart. Both
/// contacts press with 1 N s. The first obstacle moves 1 mm along its normal; the second stays, or moves
/// along if `is_together`.
Workspace make_vise(double angle, bool is_together)
{
    Workspace work;
    work.prediction.gamma = 0.005;
    const double half = 0.5 * angle * M_PI / 180.0;
    const std::array<Vec3, 2> normals = {Vec3(std::cos(half), std::sin(half), 0.0),
                                         Vec3(std::cos(half), -std::sin(half), 0.0)};
    for (int o = 0; o < 2; ++o) {
        Carrier carrier;
        carrier.motion.begin.assign(8, Vec3::Zero());
        if (o == 0 || is_together) carrier.end.translation = 1e-3 * normals[0];
        work.carriers.obstacles.push_back(carrier);
        const ObstacleContact found = make_contact(ContactKind::Vertex, {{7, -1, -1}, {1.0, 0.0, 0.0}}, -1,
                                                   normals[o], Vec3::Zero(), 0.0);
        work.prediction.position.resize(8, Vec3::Zero());
        work.contacts.push_back(place_contact(found, o, 1e-3, work.carriers, work.prediction));
        work.contacts.back().row = o;
    }
    work.solution.row_multipliers = Eigen::VectorXd::Ones(2);
    const FeatureFrame frame{Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 1.0};
    work.eol = {{7, 0, frame, Vec3::Zero(), Mat3::Identity(), Mat23::Zero(), 1, Vec3::UnitX()}};
    work.energies.start.kinetic = 1e-3;
    work.energies.solved.kinetic = 0.2;
    return work;
}

TEST(OverconstrainedVertices, AreThoseWhoseContactsPushAgainstEachOther)
{
    EXPECT_EQ(find_overconstrained_by_work(make_vise(170.0, false)), std::vector{7});
    EXPECT_TRUE(find_overconstrained_by_work(make_vise(90.0, false)).empty()) << "a groove";
    EXPECT_TRUE(find_overconstrained_by_work(make_vise(170.0, true)).empty()) << "carried by both";
    Workspace resting = make_vise(170.0, false);
    resting.energies.solved.kinetic = resting.energies.start.kinetic;
    EXPECT_TRUE(find_overconstrained_by_work(resting).empty()) << "nothing is gained";
    Workspace ordinary = make_vise(170.0, false);
    ordinary.eol.clear();
    EXPECT_TRUE(find_overconstrained_by_work(ordinary).empty()) << "it may slip out";
}

TEST(OverconstrainedVertices, AreThoseWhoseContactIsAcrossTheirWay)
{
    // The vertex can move in one direction only, at the angle `lean` to the contact's normal.
    for (const double lean : {85.0, 20.0}) {
        Workspace work = make_vise(0.0, false);
        work.contacts.pop_back();
        work.eol[0].basis = Mat3::Zero();
        work.eol[0].basis.col(0) = rotation_about(Vec3::UnitZ(), lean) * Vec3::UnitX();
        EXPECT_EQ(find_overconstrained_by_work(work).empty(), lean < 60.0) << lean;
    }
}

TEST(OverconstrainingFoldPlanes, ArePlanesThatPressClothAgainstAnotherObstacle)
{
    const auto make_fold = [](double angle) {
        Workspace work = make_vise(angle, false);
        work.contacts[0].element = kFoldPlaneElement;
        return work;
    };
    EXPECT_EQ(find_overconstraining_fold_planes(make_fold(170.0)), std::vector{0});
    EXPECT_TRUE(find_overconstraining_fold_planes(make_fold(90.0)).empty()) << "it may slip out";
    EXPECT_TRUE(find_overconstraining_fold_planes(make_vise(170.0, false)).empty()) << "no fold";

    Workspace own = make_fold(170.0);
    own.contacts[1].obstacle = 0;
    EXPECT_TRUE(find_overconstraining_fold_planes(own).empty()) << "the wire that it is folded over";
    Workspace elsewhere = make_fold(170.0);
    elsewhere.contacts[1].vertices = {6, -1, -1, -1};
    EXPECT_TRUE(find_overconstraining_fold_planes(elsewhere).empty()) << "another vertex";
    Workspace edge = make_fold(170.0);
    edge.contacts[1].vertices = {6, 7, -1, -1};
    EXPECT_EQ(find_overconstraining_fold_planes(edge), std::vector{0})
        << "an edge of the cloth that ends there";
    for (const int c : {0, 1}) {
        Workspace open = make_fold(170.0);
        open.solution.row_multipliers[c] = 0.0;
        EXPECT_TRUE(find_overconstraining_fold_planes(open).empty()) << "one does not press: " << c;
    }
    Workspace both = make_fold(170.0);
    both.contacts[1].element = kFoldPlaneElement;
    EXPECT_TRUE(find_overconstraining_fold_planes(both).empty()) << "two planes";
}

TEST(OverconstrainedVertices, AreOfAnInfeasibleStepOnly)
{
    const Workspace work = make_vise(170.0, false);
    StepReport report;
    EXPECT_TRUE(find_overconstrained_vertices(State(), work, report).empty());
    report.status = StepStatus::Infeasible;
    EXPECT_EQ(find_overconstrained_vertices(State(), work, report), std::vector{7});
}

}  // namespace
}  // namespace arris
