// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/feature_sites.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/elements/deformation_gradient.h"
#include "solver/eol/eol_features.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;

constexpr double kThickness = 1e-3;

std::vector<MeshEdge> edges_of(const State& state)
{
    return make_topology(state.mesh.vertex_count(), state.mesh.faces).edges;
}

/// Flat cloth on a ridge, its mesh turned relative to the ridge. `crossing` lists the edges that cross the
/// tip, in order along it.
struct RidgeCloth {
    EolCloth cloth;
    std::vector<std::pair<double, MeshEdge>> crossing;  ///< y and edge

    explicit RidgeCloth(double turn, double fold_degrees = 180.0)
        : cloth(testing::make_ridge(60.0, 0.5), testing::make_draped({7, turn, fold_degrees}))
    {
        State& state = cloth.state;
        for (Vec3& x : state.mesh.world) x.z() += kThickness;
        for (const MeshEdge& edge : edges_of(state)) {
            const Vec3 &a = state.mesh.world[edge.a], &b = state.mesh.world[edge.b];
            if (!(a.x() * b.x() < 0.0)) continue;
            const double s = a.x() / (a.x() - b.x());
            crossing.emplace_back((1.0 - s) * a.y() + s * b.y(), edge);
        }
        std::sort(crossing.begin(), crossing.end(),
                  [](const auto& p, const auto& q) { return p.first < q.first; });
    }

    void press(std::size_t k)
    {
        const MeshEdge& edge = crossing[k].second;
        cloth.state.active.push_back({{cloth.state.ids[edge.a], cloth.state.ids[edge.b]},
                                      ContactKind::Edge,
                                      0,
                                      cloth.scene.obstacles[0].shape().features().edges[tip()].edge,
                                      Vec3::UnitZ(),
                                      1e-6});
    }

    std::size_t most_across() const
    {
        const auto across = [this](const auto& of) {
            const std::vector<Vec3>& x = cloth.state.mesh.world;
            return std::abs((x[of.second.a] - x[of.second.b]).normalized().x());
        };
        const auto most =
            std::max_element(crossing.begin(), crossing.end(),
                             [&](const auto& p, const auto& q) { return across(p) < across(q); });
        return static_cast<std::size_t>(most - crossing.begin());
    }

    int tip() const { return testing::tip_of(cloth.scene.obstacles[0].shape()); }

    std::vector<FeatureSite> sites() const
    {
        return find_feature_sites(cloth.scene, cloth.state, cloth.stars());
    }

    /// Number of sites on each crossing edge; 1 where there is a site.
    std::vector<char> is_site() const
    {
        std::vector<char> is(crossing.size(), 0);
        for (const FeatureSite& site : sites())
            for (std::size_t k = 0; k < crossing.size(); ++k)
                if (site.edge == std::array{crossing[k].second.a, crossing[k].second.b}) ++is[k];
        return is;
    }
};

constexpr double kTurn = 17.0;  // degrees: for this turn no vertex is over the ridge

TEST(FeatureSites, AreWhereEdgesPressAndAllBetween)
{
    RidgeCloth ridge(kTurn);
    const std::size_t count = ridge.crossing.size();
    ASSERT_GT(count, 12u);
    ridge.press(3);
    ridge.press(8);
    const std::vector<char> is_site = ridge.is_site();
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(is_site[k], k >= 3 && k <= 8) << k;
}

TEST(FeatureSites, ReachTheClothsBorderFromNextToIt)
{
    RidgeCloth ridge(kTurn);
    const std::size_t count = ridge.crossing.size();
    ridge.press(1);
    ridge.press(count - 3);
    const std::vector<char> is_site = ridge.is_site();
    EXPECT_EQ(is_site[0], 1) << "one from the border";
    EXPECT_EQ(is_site[count - 2], 0) << "two from it";
    EXPECT_EQ(is_site[count - 1], 0);
    for (const FeatureSite& site : ridge.sites()) {
        const bool is_first = site.edge == std::array{ridge.crossing[0].second.a, ridge.crossing[0].second.b};
        EXPECT_EQ(site.is_on_border, is_first);
    }
}

TEST(FeatureSites, DoNotBridgeWhatIsOffTheFeature)
{
    RidgeCloth ridge(kTurn);
    ridge.press(3);
    ridge.press(8);
    const MeshEdge& lifted = ridge.crossing[6].second;
    for (const int v : {lifted.a, lifted.b}) ridge.cloth.state.mesh.world[v].z() += 3.0 * kThickness;
    const std::vector<char> is_site = ridge.is_site();
    for (std::size_t k = 0; k < is_site.size(); ++k) EXPECT_EQ(is_site[k], k == 3 || k == 8) << k;
}

// A contact that pressed is looked for at its gap, where it has slid to.
TEST(FeatureSites, AreWhereWhatPressedHasTurnedAsItSlid)
{
    constexpr double kHeight = 6.0, kSlide = 20.0, kDt = 5e-3;  // kHeight, kSlide: thicknesses; kDt: s
    const double turn = 20.0 * M_PI / 180.0;                    // turn of the cloth in the step
    const auto count_sites = [&](double height, double turned, const Vec3& way) {
        RidgeCloth ridge(kTurn);
        State& state = ridge.cloth.state;
        ridge.press(ridge.most_across());
        state.active[0].normal = Vec3(std::sin(turned), 0.0, std::cos(turned));
        for (Vec3& x : state.mesh.world) x.z() += (height - 1.0) * kThickness;
        for (Vec3& v : state.velocity) v = kThickness / kDt * way;
        state.previous_dt = kDt;
        return ridge.sites().size();
    };
    const Vec3 across = kSlide * Vec3::UnitX(), along = kSlide * Vec3::UnitY();
    EXPECT_EQ(count_sites(1.0, turn, Vec3::Zero()), 1u);
    EXPECT_EQ(count_sites(kHeight, turn, across), 1u);
    EXPECT_EQ(count_sites(2.0 * kHeight, turn, across), 0u);
    EXPECT_EQ(count_sites(kHeight, 0.0, across), 0u) << "it has lifted off";
    EXPECT_EQ(count_sites(kHeight, turn, along), 0u);
    EXPECT_EQ(count_sites(kHeight, turn, Vec3::Zero()), 0u);
}

TEST(FeatureSites, GoOnFromTheEndOfATrace)
{
    RidgeCloth ridge(0.0);  // with seven columns of cells no vertex is over the ridge
    ridge.press(4);
    State& state = ridge.cloth.state;
    // Moves a vertex onto the tip.
    const MeshEdge& edge = ridge.crossing[9].second;
    const int v = edge.a;
    const double s =
        state.mesh.world[edge.a].x() / (state.mesh.world[edge.a].x() - state.mesh.world[edge.b].x());
    state.mesh.material[v] = (1.0 - s) * state.mesh.material[edge.a] + s * state.mesh.material[edge.b];
    state.mesh.world[v] = (1.0 - s) * state.mesh.world[edge.a] + s * state.mesh.world[edge.b];
    ridge.cloth.add_eol(v, false, ridge.tip());
    const auto is_at = [&](const FeatureSite& site) { return site.material == state.mesh.material[v]; };
    const std::vector<FeatureSite> sites = ridge.sites();
    EXPECT_GT(sites.size(), 3u);
    EXPECT_TRUE(std::none_of(sites.begin(), sites.end(), is_at)) << "it is there";
    double least = 1.0, most = 0.0;
    for (const FeatureSite& site : sites) {
        least = std::min(least, site.material.y());
        most = std::max(most, site.material.y());
    }
    EXPECT_LT(most, state.mesh.material[v].y());
    state.eol.clear();
    EXPECT_EQ(ridge.sites().size(), 1u);
}

TEST(FeatureSites, AreAtAVertexThatIsAllButInThePlaneWhereTheClothEndsThere)
{
    for (const double off :
         {0.0, 0.05, -0.05, 0.09, 0.11, 0.3}) {  // thicknesses from the border to the ridge's plane
        EolCloth cloth = testing::lying(0.0, 0.2 + off * kThickness);
        const int inside = cloth.vertex_at(testing::kLyingCell, 0.2), border = cloth.vertex_at(0.0, 0.2);
        const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
        cloth.state.active.push_back(
            {{cloth.state.ids[std::min(inside, border)], cloth.state.ids[std::max(inside, border)]},
             ContactKind::Edge,
             0,
             cloth.scene.obstacles[0].shape().features().edges[tip].edge,
             Vec3::UnitZ(),
             1e-6});
        const std::vector<FeatureSite> sites = find_feature_sites(cloth.scene, cloth.state, cloth.stars());
        const auto pressing = std::count_if(sites.begin(), sites.end(),
                                            [](const FeatureSite& site) { return site.contact >= 0; });
        EXPECT_EQ(pressing, off < 0.1 ? 1 : 0) << off;
        for (const FeatureSite& site : sites) {
            if (site.contact < 0 || off < 0.0) continue;
            EXPECT_EQ(site.edge, (std::array{border, border}));
            EXPECT_EQ(site.material, cloth.state.mesh.material[border]);
        }
    }
}

/// Obstacles with a corner at the origin, which is their first point.
std::vector<ObstacleMesh> make_tips()
{
    const Vec3 tip = Vec3::Zero();
    ObstacleMesh star = make_wire({tip, {0.4, 0.0, -0.3}}, false);  // three wires that meet
    for (const Vec3& end : {Vec3(-0.2, 0.3, -0.3), Vec3(-0.2, -0.3, -0.3)}) {
        star.segments.push_back({0, static_cast<int>(star.points.size())});
        star.points.push_back(end);
    }
    return {make_points({tip}), make_wire({tip, {0.0, 0.0, -1.0}}, false),
            make_wire({tip, {0.4, 0.0, -0.4}, {0.0, 0.0, -0.8}, {-0.4, 0.0, -0.4}}, true), star};
}

TEST(FeatureSites, OnATipIsAVertexThatIsOnItAlreadyWhateverFaceOfItPresses)
{
    // A vertex at several heights above the tip; each face around it presses in turn.
    for (const ObstacleMesh& mesh : make_tips())
        for (const double height : {0.2, 1.0, 2.4, 2.6}) {
            EolCloth cloth(MovingObstacle("tip", mesh, {}, {}, 30.0), testing::make_draped({8, 0.0, 180.0}));
            for (Vec3& x : cloth.state.mesh.world)
                x.z() = height * kThickness - 0.5 * std::hypot(x.x(), x.y());
            const int v = cloth.vertex_at(0.2, 0.2);
            const ClothStars stars = cloth.stars();
            for (const int f : stars.faces[v]) {
                ContactVertexIds ids;
                for (int k = 0; k < 3; ++k) ids[k] = cloth.state.ids[cloth.state.mesh.faces[f][k]];
                std::sort(ids.begin(), ids.end());
                cloth.state.active = {{ids, ContactKind::Triangle, 0, 0, Vec3::UnitZ(), 1e-6}};
                const std::vector<FeatureSite> sites = find_feature_sites(cloth.scene, cloth.state, stars);
                ASSERT_EQ(sites.size(), 1u);
                EXPECT_TRUE(sites[0].on.is_corner());
                EXPECT_EQ(sites[0].contact, 0);
                EXPECT_EQ(sites[0].near, cloth.state.ids[v]);
                EXPECT_EQ(sites[0].material == cloth.state.mesh.material[v], height < kOnFeature) << height;
            }
        }
}

TEST(FeatureSites, AreOnTheNextEdgeWhereOneEndsBetweenItsNearestPointAndThePlane)
{
    // A sloping plane of cloth is one thickness off the tip. It meets the ridge's plane 0.84 thicknesses
    // beyond the point nearest to the tip. A vertex is at `end`, in thicknesses from that point.
    const double slope = 40.0 * M_PI / 180.0;
    const Vec3 normal(std::sin(slope), 0.0, std::cos(slope)), down(std::cos(slope), 0.0, -std::sin(slope));
    for (const double end : {-0.2, -0.4, -0.9}) {
        EolCloth cloth(testing::make_ridge(60.0, 0.5), testing::make_draped({8, 0.0, 180.0}));
        State& state = cloth.state;
        for (int v = 0; v < state.mesh.vertex_count(); ++v) {
            const Vec2 X = state.mesh.material[v] - Vec2::Constant(0.2);
            state.mesh.world[v] =
                kThickness * normal + (X.x() + end * kThickness) * down + X.y() * Vec3::UnitY();
        }
        const int from = cloth.vertex_at(0.2, 0.2), to = cloth.vertex_at(0.25, 0.2);
        const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
        state.active.push_back({{state.ids[std::min(from, to)], state.ids[std::max(from, to)]},
                                ContactKind::Edge,
                                0,
                                cloth.scene.obstacles[0].shape().features().edges[tip].edge,
                                normal,
                                1e-6});
        const std::vector<FeatureSite> sites = find_feature_sites(cloth.scene, state, cloth.stars());
        const auto site =
            std::find_if(sites.begin(), sites.end(), [](const auto& s) { return s.contact == 0; });
        ASSERT_NE(site, sites.end()) << end;
        const double crossing = 0.2 - (end + std::tan(slope)) * kThickness;
        EXPECT_NEAR(site->material.x(), crossing, 1e-9) << end;
        EXPECT_EQ(site->edge == (std::array{std::min(from, to), std::max(from, to)}), end < -0.84) << end;
    }
}

TEST(FeatureSites, AreStraightOutwardOfWhereARimBendsUnderAFace)
{
    for (const double height : {0.2, 1.0, 1.7, 3.0}) {
        EolCloth cloth = testing::make_disk_cloth(height);
        const Obstacle& disk = cloth.scene.obstacles[0].shape();
        ASSERT_TRUE(disk.features().corners.empty()) << "it bends by 22.5 degrees";
        State& state = cloth.state;
        const ClothMesh& mesh = state.mesh;
        const auto& [a, b, c] = mesh.faces[0];
        const Mat32 F = deformation_gradient({mesh.material[a], mesh.material[b], mesh.material[c]},
                                             {mesh.world[a], mesh.world[b], mesh.world[c]});
        for (int point = 0; point < static_cast<int>(disk.mesh().points.size()); ++point) {
            const Vec3& p = disk.mesh().points[point];
            if (p.z() < -0.05) continue;
            testing::press_faces_on(point, state);
            const std::vector<FeatureSite> sites = find_feature_sites(cloth.scene, state, cloth.stars());
            // The bisector rises at 45 degrees, so it meets the cloth at sqrt(2) times the cloth's height.
            if (std::sqrt(2.0) * height > kOnFeature) {
                EXPECT_TRUE(sites.empty()) << height;
                continue;
            }
            ASSERT_GE(sites.size(), 1u) << point;
            for (const FeatureSite& site : sites) {
                EXPECT_FALSE(site.on.is_corner());
                const auto [from, to] = feature_segment(disk, site.on.index);
                EXPECT_LT(std::min((from - p).norm(), (to - p).norm()), 1e-12) << "one of its two edges";
                const Vec3 place = mesh.world[a] + F * (site.material - mesh.material[a]);
                const Vec3 side = Vec3(from.x() + to.x(), from.y() + to.y(), 0.0).normalized();
                EXPECT_LT((place - p).cross(side + Vec3::UnitZ()).norm(), 1e-9) << height;
                EXPECT_GT((place - p).dot(side + Vec3::UnitZ()), 0.0);
            }
            // Conforming inserts a vertex on that edge.
            const ConformOutcome outcome = testing::conform_cloth(cloth);
            ASSERT_TRUE(outcome.mesh) << point;
            ASSERT_GE(outcome.mesh->eol.size(), 1u) << point;
            EXPECT_EQ(outcome.mesh->eol[0].on.index, sites[0].on.index);
        }
    }
}

TEST(FeatureSites, AreNoneWhereNothingPresses)
{
    EXPECT_TRUE(RidgeCloth(kTurn).sites().empty());
}

}  // namespace
}  // namespace arris
