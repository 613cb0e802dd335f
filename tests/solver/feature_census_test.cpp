// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/feature_census.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::kThickness;
using testing::lying;

/// A solved step reduced to its contacts.
struct Solved {
    EolCloth cloth = lying(0.0);
    Workspace work;
    std::vector<double> multiplier;

    Solved()
    {
        prepare(cloth.scene, cloth.state, work);
        work.carriers.obstacles.resize(1);
        work.carriers.obstacles[0].motion.begin = cloth.state.mesh.world;
    }

    int tip() const
    {
        const ObstacleFeatures& features = cloth.scene.obstacles[0].shape().features();
        return features.edges[testing::tip_of(cloth.scene.obstacles[0].shape())].edge;
    }

    Contact& add(ContactKind kind, std::array<int, 3> vertices, int element, bool was_active,
                 double pressing = 1.0)
    {
        Contact contact{};
        contact.kind = kind;
        std::copy(vertices.begin(), vertices.end(), contact.vertices.begin());
        contact.element = element;
        contact.local_normal = Vec3::UnitZ();
        contact.local_point = Vec3(0, 0.1, 0);
        contact.obstacle = 0;
        contact.normal = Vec3::UnitZ();
        contact.last_multiplier = was_active ? 1.0 : 0.0;
        contact.eol = -1;
        work.contacts.push_back(contact);
        multiplier.push_back(pressing);
        return work.contacts.back();
    }

    FeatureCensus take()
    {
        work.carriers.obstacles[0].obstacle = cloth.scene.obstacles[0].at(cloth.state.time).shape;
        return take_census(cloth.scene, cloth.state, work, multiplier);
    }
    int count(ConstraintCause cause) { return take().by_cause[static_cast<std::size_t>(cause)]; }
};

TEST(FeatureCensus, OfNothingThereIsNothing)
{
    Solved solved;
    EXPECT_EQ(solved.take().eol, 0);
    EXPECT_EQ(solved.take().rows, 0);
    solved.add(ContactKind::Edge, {3, 4, -1}, solved.tip(), true, 0.0);
    EXPECT_EQ(solved.take().rows, 0) << "it does not press";
}

TEST(FeatureCensus, ARowIsNewUntilItHasPressedTwice)
{
    Solved solved;
    solved.add(ContactKind::Edge, {3, 4, -1}, solved.tip(), false);
    solved.add(ContactKind::Edge, {4, 5, -1}, solved.tip(), true);
    EXPECT_EQ(solved.count(ConstraintCause::New), 1);
    EXPECT_EQ(solved.count(ConstraintCause::NotCrossing), 1)
        << "nothing has refused it: there was no place to put one";
    EXPECT_EQ(solved.take().rows, 2);
}

TEST(FeatureCensus, ARowHasTheCauseForWhichItWasRefused)
{
    Solved solved;
    solved.work.mesh.refused = {{{3, 4}, ContactKind::Edge, 0, solved.tip(), ConstraintCause::Guard},
                                {{4, 5}, ContactKind::Edge, 0, solved.tip() + 1, ConstraintCause::Guard},
                                {{5, 6}, ContactKind::Edge, 1, solved.tip(), ConstraintCause::Guard},
                                {{6, 7, 8}, ContactKind::Triangle, 0, 2, ConstraintCause::Quality},
                                {{9}, ContactKind::Vertex, 0, -1, ConstraintCause::Released}};
    solved.add(ContactKind::Edge, {3, 4, -1}, solved.tip(), true);
    solved.add(ContactKind::Edge, {4, 5, -1}, solved.tip(), true);  // refused at another edge of the obstacle
    solved.add(ContactKind::Edge, {5, 6, -1}, solved.tip(), true);  // refused at another obstacle
    solved.add(ContactKind::Triangle, {6, 7, 8}, 2, true);
    solved.add(ContactKind::Vertex, {9, -1, -1}, 1, true);
    EXPECT_EQ(solved.count(ConstraintCause::Guard), 1);
    EXPECT_EQ(solved.count(ConstraintCause::NotCrossing), 2);
    EXPECT_EQ(solved.count(ConstraintCause::Quality), 1);
    EXPECT_EQ(solved.count(ConstraintCause::Released), 1);
    solved.cloth.scene.eol.reset();
    EXPECT_EQ(solved.take().rows, 5);
    EXPECT_EQ(solved.count(ConstraintCause::Guard), 0) << "nothing is to be EOL";
}

TEST(FeatureCensus, EolVerticesThatPressAreCountedAndWhatElseTheyTouch)
{
    Solved solved;
    EolCloth& cloth = solved.cloth;
    const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
    // Moves a row of vertices onto the ridge.
    for (Vec3& x : cloth.state.mesh.world) x.x() -= 0.5 * testing::kLyingCell;
    solved.work.carriers.obstacles[0].motion.begin = cloth.state.mesh.world;
    const auto near_ridge = [&](double y) {
        const auto& world = cloth.state.mesh.world;
        return static_cast<int>(std::min_element(world.begin(), world.end(),
                                                 [y](const Vec3& a, const Vec3& b) {
                                                     return (a - Vec3(0, y, kThickness)).norm() <
                                                            (b - Vec3(0, y, kThickness)).norm();
                                                 }) -
                                world.begin());
    };
    const int a = near_ridge(0.05), b = near_ridge(-0.05);
    ASSERT_NE(a, b);
    cloth.add_eol(a, false, tip);
    cloth.add_eol(b, false, tip);
    solved.add(ContactKind::Vertex, {a, -1, -1}, -1, true).eol = 0;
    solved.add(ContactKind::Vertex, {b, -1, -1}, -1, true, 0.0).eol = 1;
    EXPECT_EQ(solved.take().eol, 1);
    EXPECT_EQ(solved.take().rows, 0);

    solved.add(ContactKind::Vertex, {a, -1, -1}, 1000, true);
    EXPECT_EQ(solved.count(ConstraintCause::OtherFeature), 1);

    // An EOL vertex of upright cloth has no coordinates; its contact is a row with the cause EdgeOn.
    for (Vec3& x : cloth.state.mesh.world) x = Vec3(0.0, x.y(), kThickness + x.x());
    solved.work.carriers.obstacles[0].motion.begin = cloth.state.mesh.world;
    EXPECT_EQ(solved.count(ConstraintCause::EdgeOn), 1);
}

TEST(FeatureCensus, ARowAtTheEolVertexOfItsFeatureIsTheSameContact)
{
    const auto cause_at = [](double weight, bool is_other_eol) {
        Solved solved;
        const Obstacle& ridge = solved.cloth.scene.obstacles[0].shape();
        const int tip = testing::tip_of(ridge);
        const int v = solved.cloth.vertex_at(0.2, 0.2);
        const Vec2 middle = solved.cloth.state.mesh.material[v];
        const int w = solved.cloth.vertex_at(middle.x(), middle.y() + testing::kLyingCell);
        solved.cloth.add_eol(v, false, tip);
        if (is_other_eol) solved.cloth.add_eol(w, false, tip);
        Contact& contact = solved.add(ContactKind::Edge, {v, w, -1}, ridge.features().edges[tip].edge, true);
        contact.weights = {weight, 1.0 - weight, 0.0};
        for (const ConstraintCause cause : {ConstraintCause::AtEol, ConstraintCause::BesideEol})
            if (solved.count(cause) == 1) return cause;
        return ConstraintCause::New;
    };
    EXPECT_EQ(cause_at(0.96, false), ConstraintCause::AtEol);
    EXPECT_EQ(cause_at(0.94, false), ConstraintCause::BesideEol)
        << "it is 3.4 thicknesses away, and 6 % of the edge";
    EXPECT_EQ(cause_at(0.5, false), ConstraintCause::BesideEol);
    EXPECT_EQ(cause_at(0.5, true), ConstraintCause::AtEol) << "the edge is the trace";
}

/// The ridge with an additional mesh point in the middle of its tip, which is the last point.
MovingObstacle make_split_ridge()
{
    ObstacleMesh mesh = testing::make_ridge(60.0).shape().mesh();
    const int middle = static_cast<int>(mesh.points.size());
    const auto is_of_tip = [&](int p) { return p == middle || mesh.points[p].z() > -1e-9; };
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : std::vector<Vec3>(mesh.points)) sum += p.z() > -1e-9 ? p : Vec3(Vec3::Zero());
    mesh.points.push_back(0.5 * sum);
    for (std::size_t f = 0, n = mesh.faces.size(); f < n; ++f)
        for (int k = 0; k < 3; ++k) {
            const int from = mesh.faces[f][k], to = mesh.faces[f][(k + 1) % 3];
            if (from == middle || to == middle || !is_of_tip(from) || !is_of_tip(to)) continue;
            auto half = mesh.faces[f];
            half[k] = middle;
            mesh.faces[f][(k + 1) % 3] = middle;
            mesh.faces.push_back(half);
            break;
        }
    return MovingObstacle("ridge", std::move(mesh), {}, {}, 30.0);
}

TEST(FeatureCensus, AFaceOnAPointInTheMiddleOfAnEdgeTouchesTheTraceThere)
{
    // `off`: offset of the face's third corner; `aside`: distance of the point from the trace, m.
    const MovingObstacle split = make_split_ridge();
    const Obstacle& ridge = split.shape();
    const auto cause_at = [&](int point, double off, bool has_trace, double aside = 0.0) {
        Solved solved;
        solved.cloth.scene.obstacles[0] = split;
        const int tip = testing::tip_of(ridge);
        const int v = solved.cloth.vertex_at(0.2, 0.2);
        const Vec2 middle = solved.cloth.state.mesh.material[v];
        const int w = solved.cloth.vertex_at(middle.x(), middle.y() + testing::kLyingCell);
        const int beside = solved.cloth.vertex_at(middle.x() + testing::kLyingCell, middle.y());
        solved.cloth.add_eol(v, false, tip);
        if (has_trace) solved.cloth.add_eol(w, false, tip);
        Contact& contact = solved.add(ContactKind::Triangle, {v, w, beside}, point, true);
        contact.weights = {0.6 - off, 0.4, off};
        contact.local_point = ridge.mesh().points[point];
        const Vec3 near = contact.local_point + Vec3(aside, 0.0, 1e-3);
        std::vector<Vec3>& begin = solved.work.carriers.obstacles[0].motion.begin;
        begin[v] = near - 0.4 * testing::kLyingCell * Vec3::UnitY();
        begin[w] = near + 0.6 * testing::kLyingCell * Vec3::UnitY();
        EXPECT_EQ(solved.take().rows, 1);
        return solved.count(ConstraintCause::AtEol) == 1;
    };
    const int middle = static_cast<int>(ridge.mesh().points.size()) - 1;
    ASSERT_EQ(ridge.features().corners.size(), testing::make_ridge(60.0).shape().features().corners.size());
    EXPECT_TRUE(cause_at(middle, 0.04, true));
    EXPECT_TRUE(cause_at(middle, 0.06, true, 1e-3)) << "a chord passes by it no farther than cloth is";
    EXPECT_FALSE(cause_at(middle, 0.06, true, 4e-3)) << "6 % of the face away, and farther";
    EXPECT_FALSE(cause_at(middle, 0.04, false)) << "no trace";
    const int end = ridge.features().corners[testing::end_of(ridge)].point;
    EXPECT_FALSE(cause_at(end, 0.04, true)) << "a corner has a vertex of its own";
}

TEST(FeatureCensus, ARowAtAnEolVertexWithoutCoordinatesSaysWhyThatHasNone)
{
    const auto count_at = [](double weight) {
        Solved solved;
        const Obstacle& ridge = solved.cloth.scene.obstacles[0].shape();
        const int tip = testing::tip_of(ridge), corner = solved.cloth.vertex_at(0.0, 0.0);
        ASSERT_EQ(corner, 0);
        solved.cloth.add_eol(corner, false, tip);
        Contact& contact = solved.add(ContactKind::Edge, {0, 1, -1}, ridge.features().edges[tip].edge, true);
        contact.weights = {weight, 1.0 - weight, 0.0};
        EXPECT_EQ(solved.count(ConstraintCause::ClothCorner), weight > 0.95 ? 1 : 0);
        EXPECT_EQ(solved.count(ConstraintCause::AtEol), 0);
    };
    count_at(0.97);
    count_at(0.6);
}

TEST(FeatureCensus, AFaceThatTouchesACornerBesideItsEolVertexIsAContactOfItsOwn)
{
    const auto cause_at = [](double weight) {
        Solved solved;
        const Obstacle& ridge = solved.cloth.scene.obstacles[0].shape();
        const int corner = testing::end_of(ridge), v = solved.cloth.vertex_at(0.2, 0.2);
        solved.cloth.add_eol(v, true, corner);
        Contact& contact = solved.add(ContactKind::Triangle, {v, v + 1, v + 2},
                                      ridge.features().corners[corner].point, true);
        contact.weights = {weight, 0.0, 1.0 - weight};
        return solved.count(ConstraintCause::AtEol) == 1 ? ConstraintCause::AtEol
                                                         : ConstraintCause::BesideEol;
    };
    EXPECT_EQ(cause_at(0.99), ConstraintCause::AtEol);
    EXPECT_EQ(cause_at(0.9), ConstraintCause::BesideEol);
}

TEST(FeatureCensus, AnEdgeThatEndsAtAnEolVertexOfItsFeatureIsBesideIt)
{
    const auto count_at = [](const std::array<int, 3>& vertices, bool is_tip) {
        Solved solved;
        const Obstacle& ridge = solved.cloth.scene.obstacles[0].shape();
        const int tip = testing::tip_of(ridge);
        solved.cloth.add_eol(4, false, tip);
        const int feature = is_tip ? tip : tip == 0 ? 1 : 0;
        solved.add(ContactKind::Edge, vertices, ridge.features().edges[feature].edge, true);
        return std::pair(solved.count(ConstraintCause::BesideEol),
                         solved.count(ConstraintCause::NotCrossing));
    };
    EXPECT_EQ(count_at({3, 4, -1}, true), std::pair(1, 0));
    EXPECT_EQ(count_at({2, 3, -1}, true), std::pair(0, 1)) << "no end is";
    EXPECT_EQ(count_at({3, 4, -1}, false), std::pair(0, 1)) << "it is on another feature";
}

TEST(FeatureCensus, AVertexTouchesAFeatureWhereItsPlaneIsNoFaces)
{
    const Obstacle box(make_box({1, 1, 1}), 30.0);
    const auto touches = [](const Obstacle& obstacle, const Vec3& point, const Vec3& normal, int element) {
        Contact contact;
        contact.vertices[0] = 0;
        contact.element = element;
        contact.local_point = point;
        contact.local_normal = normal.normalized();
        return touches_feature(obstacle, contact, kThickness);
    };
    const auto face_to = [&](const Vec3& normal) {
        const auto& normals = box.topology().face_normals;
        return static_cast<int>(std::find_if(normals.begin(), normals.end(),
                                             [&](const Vec3& n) { return n.dot(normal) > 0.99; }) -
                                normals.begin());
    };
    const int top = face_to(Vec3::UnitZ());
    EXPECT_FALSE(touches(box, {0.1, 0.2, 0.5}, Vec3::UnitZ(), top));
    EXPECT_FALSE(touches(box, {0.5, 0.2, 0.5}, Vec3::UnitZ(), top)) << "it lies on the top";
    EXPECT_TRUE(touches(box, {0.5, 0.2, 0.5}, {1, 0, 1}, top));
    EXPECT_TRUE(touches(box, {0.5, 0.2, 0.5}, {1e-3, 0, 1}, top));
    EXPECT_TRUE(touches(box, {0.5, 0.5, 0.5}, {1, 1, 1}, top)) << "a corner";
    const Obstacle wire(make_wire({{-1, 0, 0}, {1, 0, 0}}, false), 30.0);
    EXPECT_TRUE(touches(wire, {0, 0, 0}, {0, 0, 1}, 0));
    const Obstacle nail(make_points({{0.3, 0, 0}}), 30.0);
    EXPECT_TRUE(touches(nail, {0.3, 0, 0}, {0, 0, 1}, 0));
    EXPECT_TRUE(touches(nail, {0.3, 0, 0}, {0, 1, 1}, 7));

    // The edges of a smooth surface are no features; at this angle the box has no sharp edge.
    const Obstacle smooth(make_box({1, 1, 1}), 179.0);
    ASSERT_TRUE(smooth.features().edges.empty());
    EXPECT_FALSE(touches(smooth, {0.5, 0.2, 0.5}, {1, 0, 1}, top));
}

TEST(FeatureCensus, AnEdgeOrFaceOfTheClothTouchesAFeatureWhereItsPointIsOnOne)
{
    const Obstacle box(make_box({1, 1, 1}), 30.0);
    const Obstacle smooth(make_box({1, 1, 1}), 179.0);
    const auto touches = [](const Obstacle& obstacle, ContactKind kind, int element, const Vec3& point) {
        Contact contact;
        contact.kind = kind;
        contact.vertices = {0, 1, kind == ContactKind::Edge ? -1 : 2, -1};
        contact.element = element;
        contact.local_point = point;
        contact.local_normal = Vec3(1, 0, 1).normalized();
        return touches_feature(obstacle, contact, kThickness);
    };
    const auto& edges = box.topology().edges;
    int count = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const Vec3 &a = box.mesh().points[edges[e].points[0]], &b = box.mesh().points[edges[e].points[1]];
        const bool is_sharp = (b - a).norm() < 1.1;  // the others are diagonals of the box's sides
        EXPECT_EQ(touches(box, ContactKind::Edge, static_cast<int>(e), 0.7 * a + 0.3 * b), is_sharp) << e;
        EXPECT_TRUE(touches(box, ContactKind::Edge, static_cast<int>(e), a)) << e << ": a corner";
        EXPECT_FALSE(touches(smooth, ContactKind::Edge, static_cast<int>(e), 0.7 * a + 0.3 * b)) << e;
        count += is_sharp ? 1 : 0;
    }
    EXPECT_EQ(count, 12);
    EXPECT_TRUE(touches(box, ContactKind::Triangle, 3, box.mesh().points[3]));
}

}  // namespace
}  // namespace arris
