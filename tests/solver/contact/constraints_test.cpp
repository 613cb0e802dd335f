// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/constraints.h"

#include <gtest/gtest.h>

#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kThickness = 1e-3;
constexpr double kRoundOff = 7e-17;  // of a unit normal across the way of a vertex

/// One vertex that moves only along x, as an EOL vertex at a corner does, and a contact of it. Returns its
/// row.
ConstraintRow row_of(const Vec3& normal, double gap)
{
    Prediction prediction;
    prediction.gamma = 0.002;
    prediction.position = {Vec3::Zero()};
    Linearization at;
    Mat3 basis = Mat3::Zero();
    basis(0, 0) = 1.0;
    at.basis = {basis};
    at.drift = {Vec3::Zero()};
    std::vector<Contact> contacts(1);
    Contact& contact = contacts[0];
    contact.local_point = Vec3::Zero();
    contact.local_normal = normal;
    contact.vertices[0] = 0;
    contact.weights[0] = 1.0;
    contact.kind = ContactKind::Vertex;
    contact.obstacle = 0;
    contact.least_gap = kThickness;
    contact.normal = normal;
    contact.gap = gap;
    VelocityProblem problem;
    append_rows(prediction, at, 0, contacts, problem);
    return problem.rows.at(0);
}

TEST(ContactRow, AcrossTheOnlyWayOfItsVertexAsksForNothing)
{
    // Round-off over round-off would ask for 120 m/s.
    const ConstraintRow row = row_of({kRoundOff, 0.0, 1.0}, -1.6e-17);
    EXPECT_EQ(row.lower, -kInfinity);
    EXPECT_EQ(row.coefficient[0], 0.0);
}

TEST(ContactRow, ThatNothingCanMoveAndThatIsViolatedIsKept)
{
    const ConstraintRow row = row_of({kRoundOff, 0.0, 1.0}, -0.1 * kThickness);
    EXPECT_NEAR(row.lower, 0.1 * kThickness / 0.002, 1e-12);
    EXPECT_EQ(row.coefficient[0], 0.0);
}

TEST(ContactRow, AlongTheWayOfItsVertexIsKept)
{
    const ConstraintRow row = row_of({0.6, 0.0, 0.8}, -1.6e-17);
    EXPECT_EQ(row.coefficient[0], 0.6);
    EXPECT_GT(row.lower, 0.0);
}

}  // namespace
}  // namespace arris
