// SPDX-License-Identifier: GPL-3.0-or-later
// Operations of mesh surgery near nails, wires and corners of boxes. The oracle: when one vertex moves
// straight, a face sweeps the tetrahedron of its three old corners and the vertex's new place.
#include "geometry/surgery/surgery_clearance.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kClear = 1e-7;  // barycentric: the oracle does not judge points nearer to a side

using Tetrahedron = std::array<Vec3, 4>;

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// Whether the vertex moves within the face's plane, so that the tetrahedron has no volume.
bool is_flat(const Tetrahedron& t)
{
    constexpr double kFlat = 1e-12;  // relative to the cube of a cell of 0.25 m
    return std::abs(volume(t[0], t[1], t[2], t[3])) < kFlat;
}

/// Least barycentric coordinate of p: positive inside. Flat tetrahedra contain nothing: -1.
double depth(const Tetrahedron& t, const Vec3& p)
{
    if (is_flat(t)) return -1.0;
    const double whole = volume(t[0], t[1], t[2], t[3]);
    return std::min({volume(p, t[1], t[2], t[3]) / whole, volume(t[0], p, t[2], t[3]) / whole,
                     volume(t[0], t[1], p, t[3]) / whole, volume(t[0], t[1], t[2], p) / whole});
}

double depth(const std::vector<Tetrahedron>& swept, const Vec3& p)
{
    double deepest = -1.0;
    for (const Tetrahedron& t : swept) deepest = std::max(deepest, depth(t, p));
    return deepest;
}

/// Tetrahedra swept by the old faces at `vertex`, which moves to `end`.
std::vector<Tetrahedron> sweep(const SurgeryEvent& event, VertexId vertex, const Vec3& end)
{
    std::vector<Tetrahedron> swept;
    for (const PatchFace& face : event.before)
        for (int i = 0; i < 3; ++i)
            if (face.vertices[i] == vertex)
                swept.push_back({face.world[i], face.world[(i + 1) % 3], face.world[(i + 2) % 3], end});
    return swept;
}

std::vector<Tetrahedron> swept_by(const ClothSurgery& cloth, const SurgeryEvent& event)
{
    switch (event.operation) {
        case SurgeryOperation::Collapse:
            return sweep(event, event.edge[0], cloth.world(event.edge[1]));
        case SurgeryOperation::Move:
            return sweep(event, event.changes[0].vertex, event.changes[0].new_world);
        case SurgeryOperation::Flip:
            return {{cloth.world(event.edge[0]), cloth.world(event.edge[1]),
                     cloth.world(cloth.apex(event.edge[0], event.edge[1])),
                     cloth.world(cloth.apex(event.edge[1], event.edge[0]))}};
        default:
            return {};
    }
}

/// A cloth with folds as sharp as its cells, and operations of each kind on the cloth.
struct Setting {
    ClothSurgery cloth;
    std::vector<SurgeryEvent> events;

    explicit Setting(unsigned seed, double height = 0.1) : cloth(make(seed, height))
    {
        std::mt19937 random(seed);
        for (const VertexId v : {6u, 7u, 8u, 11u, 12u, 13u, 16u, 17u, 18u}) {
            for (const VertexId w : cloth.ring(v).vertices) {
                add(cloth.propose_collapse(v, w));
                if (v < w && !cloth.is_border_edge(v, w)) add(cloth.propose_flip(v, w));
            }
            std::uniform_real_distribution<double> shift(-0.08, 0.08);
            const Vec2 way(shift(random), shift(random));
            add(cloth.propose_moves({{v, cloth.material(v) + way}}));
        }
    }

    void add(const SurgeryProposal& proposal)
    {
        if (proposal.is_legal()) events.push_back(proposal.event);
    }

    static ClothSurgery make(unsigned seed, double height)
    {
        SurgeryCloth square = square_cloth(4, 0.15, seed);
        std::mt19937 random(seed + 100);
        std::uniform_real_distribution<double> z(-height, height);
        for (Vec3& x : square.mesh.world) x.z() = z(random);
        return square.surgery();
    }
};

Obstacle shape(ObstacleMesh mesh)
{
    return Obstacle(std::move(mesh), 30.0);
}

/// Whether a segment passes through an old face.
bool pierces(const SurgeryEvent& event, const Vec3& p, const Vec3& q)
{
    return std::any_of(event.before.begin(), event.before.end(), [&](const PatchFace& face) {
        const auto& [a, b, c] = face.world;
        if (volume(a, b, c, p) * volume(a, b, c, q) > 0.0) return false;
        const double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
        return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
    });
}

/// A random point: in one of the tetrahedra or, equally often, in their neighbourhood.
Vec3 some_point(const std::vector<Tetrahedron>& swept, std::mt19937& random)
{
    std::exponential_distribution<double> part(1.0);
    std::size_t chosen = random() % swept.size();
    while (is_flat(swept[chosen])) chosen = (chosen + 1) % swept.size();
    const Tetrahedron& t = swept[chosen];
    Eigen::Vector4d weights(part(random), part(random), part(random), part(random));
    weights /= weights.sum();
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 4; ++i) p += weights[i] * t[i];
    std::normal_distribution<double> off(0.0, 0.05);
    if (random() % 2 == 0) p += Vec3(off(random), off(random), off(random));
    return p;
}

int count_of(const Setting& setting, SurgeryOperation operation)
{
    return static_cast<int>(
        std::count_if(setting.events.begin(), setting.events.end(),
                      [&](const SurgeryEvent& event) { return event.operation == operation; }));
}

TEST(SurgeryClearance, ANailIsInTheWayExactlyWhereItIsInWhatTheFacesSweep)
{
    int in_way = 0, beside = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Setting setting(seed);
        ASSERT_GT(count_of(setting, SurgeryOperation::Collapse), 3);
        ASSERT_GT(count_of(setting, SurgeryOperation::Flip), 3);
        ASSERT_GT(count_of(setting, SurgeryOperation::Move), 3);
        std::mt19937 random(seed);
        for (const SurgeryEvent& event : setting.events) {
            const std::vector<Tetrahedron> swept = swept_by(setting.cloth, event);
            for (int k = 0; k < 12; ++k) {
                const Vec3 nail = some_point(swept, random);
                const double depth_of_nail = depth(swept, nail);
                if (std::abs(depth_of_nail) < kClear) continue;
                const bool is_in_way = depth_of_nail > 0.0;
                EXPECT_EQ(is_free(event, shape(make_points({nail})), {}, kThickness), !is_in_way)
                    << "seed " << seed << " operation " << static_cast<int>(event.operation) << " depth "
                    << depth_of_nail;
                (is_in_way ? in_way : beside) += 1;
            }
        }
    }
    EXPECT_GT(in_way, 500);
    EXPECT_GT(beside, 500);
}

TEST(SurgeryClearance, AWireIsInTheWayWhereAnyPointOfItIs)
{
    int in_way = 0, beside = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Setting setting(seed);
        std::mt19937 random(seed + 7);
        for (const SurgeryEvent& event : setting.events) {
            const std::vector<Tetrahedron> swept = swept_by(setting.cloth, event);
            for (int k = 0; k < 8; ++k) {
                const Vec3 middle = some_point(swept, random);
                std::normal_distribution<double> normal;
                const Vec3 half = 0.05 * Vec3(normal(random), normal(random), normal(random));
                constexpr int kSamples = 4000;
                // Barycentric: a shallower passage of a wire may be missed by the samples.
                constexpr double kBetween = 2e-3;
                double deepest = -1.0;
                for (int i = 0; i <= kSamples; ++i)
                    deepest = std::max(deepest, depth(swept, middle + (2.0 * i / kSamples - 1.0) * half));
                const bool is_through = pierces(event, middle - half, middle + half);
                if (!is_through && deepest < kClear && deepest > -kBetween) continue;
                const bool is_in_way = is_through || deepest > 0.0;
                const Obstacle wire = shape(make_wire({middle - half, middle + half}, false));
                EXPECT_EQ(is_free(event, wire, {}, kThickness), !is_in_way)
                    << "seed " << seed << " operation " << static_cast<int>(event.operation) << " deepest "
                    << deepest;
                (is_in_way ? in_way : beside) += 1;
            }
        }
    }
    EXPECT_GT(in_way, 200);
    EXPECT_GT(beside, 100);
}

TEST(SurgeryClearance, ABoxIsInTheWayWhereItsCornerIs)
{
    int in_way = 0, beside = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Setting setting(seed);
        std::mt19937 random(seed + 9);
        for (const SurgeryEvent& event : setting.events) {
            const std::vector<Tetrahedron> swept = swept_by(setting.cloth, event);
            const Vec3 corner = some_point(swept, random);
            const double depth_of_corner = depth(swept, corner);
            const Mat3 turn = rotation_about(Vec3(1, 2, 3), 360.0 * seed);
            constexpr double kSide = 1e-5;  // m: so small that only the corner matters
            const Obstacle box = shape(make_box({kSide, kSide, kSide}));
            const Placement place{turn, corner - turn * Vec3::Constant(0.5 * kSide)};
            if (std::abs(depth_of_corner) < 1e-2) continue;
            EXPECT_EQ(is_free(event, box, place, kThickness), depth_of_corner < 0.0);
            (depth_of_corner > 0.0 ? in_way : beside) += 1;
        }
    }
    EXPECT_GT(in_way, 20);
    EXPECT_GT(beside, 20);
}

TEST(SurgeryClearance, NothingAroundIsFree)
{
    const Setting setting(1);
    for (const SurgeryEvent& event : setting.events) {
        EXPECT_TRUE(is_free(event, shape(make_box({1, 1, 1})), {Mat3::Identity(), {0, 0, 5}}, kThickness));
        EXPECT_TRUE(is_free(event, shape(make_wire({{9, 0, 0}, {9, 1, 0}}, false)), {}, kThickness));
    }
}

TEST(SurgeryClearance, OnlyWhatIsPassedCountsNotWhatIsNearerThanTheThickness)
{
    // Operations on flat cloth sweep nothing. A nail 1 micrometre above the cloth is free, although the
    // thickness is 1 mm. A nail in the cloth is not free.
    const Setting setting(2, 0.0);
    for (const SurgeryEvent& event : setting.events) {
        const Vec3 middle = (event.after[0].world[0] + event.after[0].world[1] + event.after[0].world[2]) / 3;
        for (const double height : {-1e-6, 1e-6})
            EXPECT_TRUE(is_free(event, shape(make_points({middle + Vec3(0, 0, height)})), {}, kThickness));
        EXPECT_FALSE(is_free(event, shape(make_points({middle})), {}, kThickness));
    }
}

TEST(SurgeryClearance, AnswersAlikeWhereverThePairIs)
{
    // The obstacle's placement and the cloth are moved together, far from the origin.
    const Placement away = {rotation_about(Vec3(3, -1, 2), 77.0), Vec3(-800, 300, 1e3)};
    int in_way = 0, beside = 0;
    for (unsigned seed = 5; seed <= 6; ++seed) {
        const Setting setting(seed);
        std::mt19937 random(seed);
        for (const SurgeryEvent& event : setting.events) {
            SurgeryEvent moved = event;
            for (std::vector<PatchFace>* faces : {&moved.before, &moved.after})
                for (PatchFace& face : *faces)
                    for (Vec3& x : face.world) x = away(x);
            for (VertexChange& change : moved.changes) {
                change.old_world = away(change.old_world);
                change.new_world = away(change.new_world);
            }
            const std::vector<Tetrahedron> swept = swept_by(setting.cloth, event);
            const Vec3 nail = some_point(swept, random);
            const double depth_of_nail = depth(swept, nail);
            if (std::abs(depth_of_nail) < 1e-6) continue;  // rounding at 1e3 m, for cells of 0.25 m
            const Obstacle there = shape(make_points({nail}));
            EXPECT_EQ(is_free(moved, there, away, kThickness), depth_of_nail < 0.0) << depth_of_nail;
            (depth_of_nail > 0.0 ? in_way : beside) += 1;
        }
    }
    EXPECT_GT(in_way, 20);
    EXPECT_GT(beside, 20);
}

TEST(SurgeryClearance, AMoveThroughTheMaterialAloneSweepsTheFacesOnly)
{
    // Pure flow: the vertex keeps its place in the world, so the cloth sweeps no volume.
    const Setting setting(3);
    for (const VertexId v : {7u, 12u, 17u}) {
        const SurgeryProposal flow =
            setting.cloth.propose_moves({{v, setting.cloth.material(v) + Vec2(0.02, 0.01), true}});
        ASSERT_TRUE(flow.is_legal());
        const Vec3 above = setting.cloth.world(v) + Vec3(0, 0, 1e-4);
        EXPECT_TRUE(is_free(flow.event, shape(make_points({above})), {}, kThickness));
    }
}

TEST(SurgeryClearance, ASplitIsFreeWhateverIsThere)
{
    const Setting setting(1);
    const ClothSurgery& cloth = setting.cloth;
    const VertexId w = cloth.ring(12).vertices[0];
    const SurgeryProposal edge = cloth.propose_edge_split(12, w, 0.5);
    const SurgeryProposal face = cloth.propose_face_split(cloth.faces_at(12)[0], Vec3(1, 1, 1) / 3.0);
    ASSERT_TRUE(edge.is_legal());
    ASSERT_TRUE(face.is_legal());
    for (const SurgeryEvent* event : {&edge.event, &face.event}) {
        const Vec3 made = event->changes[0].new_world;
        EXPECT_TRUE(is_free(*event, shape(make_points({made})), {}, kThickness));
        EXPECT_TRUE(is_free(*event, shape(make_wire({made, made + Vec3(0, 0, 1)}, false)), {}, kThickness));
        EXPECT_TRUE(is_free(*event, shape(make_box({1, 1, 1})), {Mat3::Identity(), made}, kThickness));
    }
}

}  // namespace
}  // namespace arris
