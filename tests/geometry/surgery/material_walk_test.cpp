// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/material_walk.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/cgal.h"
#include "geometry/cloth/mesh_topology.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

bool do_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
    return exact_orientation(a, b, c) * exact_orientation(a, b, d) <= 0 &&
           exact_orientation(c, d, a) * exact_orientation(c, d, b) <= 0;
}

TEST(MaterialWalk, AWayLeadsOffTheClothWhereItMeetsAnEdgeOfTheBorder)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int off = 0, inside = 0;
    for (const SurgeryCloth& cloth : {square_cloth(8, 0.2), bay_cloth(9), holed_cloth(9), turned_cloth(8),
                                      placed(square_cloth(8, 0.2), 1e-3, {1000, 1000})}) {
        const ClothSurgery surgery = cloth.surgery();
        const std::vector<MeshEdge> edges = make_topology(cloth.mesh.vertex_count(), cloth.mesh.faces).edges;
        for (const VertexId v : cloth.ids()) {
            if (surgery.is_border(v)) continue;
            for (int k = 0; k < 20; ++k) {
                const Vec2 way = 4.0 * cloth.cell * Vec2(unit(random), unit(random));
                const Vec2 from = surgery.material(v), to = from + way;
                bool is_off = false;
                for (const MeshEdge& e : edges)
                    is_off = is_off || (e.face_right < 0 && do_cross(from, to, cloth.mesh.material[e.a],
                                                                     cloth.mesh.material[e.b]));
                ASSERT_EQ(leads_off(surgery, v, way), is_off) << cloth.name << " " << v;
                (is_off ? off : inside)++;
            }
        }
    }
    EXPECT_GT(off, 500);
    EXPECT_GT(inside, 500);
}

TEST(MaterialWalk, ALineThroughVerticesIsFollowed)
{
    const ClothSurgery surgery = square_cloth(8).surgery();
    const VertexId middle = nearest_vertex(surgery, {0.5, 0.5});
    for (const Vec2& along : {Vec2(1, 0), Vec2(0, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        EXPECT_FALSE(leads_off(surgery, middle, 0.25 * along));
        EXPECT_FALSE(leads_off(surgery, middle, 0.49 * along));
        EXPECT_TRUE(leads_off(surgery, middle, 0.51 * along));
        EXPECT_TRUE(leads_off(surgery, middle, 2.0 * along));
    }
    EXPECT_FALSE(leads_off(surgery, middle, Vec2::Zero()));
    for (const double tiny : {1e-300, 1e-20, 1e-16})
        EXPECT_FALSE(leads_off(surgery, middle, tiny * Vec2(1.0, -0.7))) << tiny;
}

// Rounding moves the border's vertices off the line of the walk.
TEST(MaterialWalk, OnTheBorderItLeadsOffAtTheNextFixedVertex)
{
    const SurgeryCloth cloth = turned_cloth(8);
    const Vec2 u(std::cos(0.3), std::sin(0.3)), v(-u.y(), u.x());
    const ClothSurgery surgery = cloth.surgery();
    for (const auto& [side, along] : {std::pair(Vec2(0.25 * u), u), {0.25 * v, v}, {u + 0.25 * v, v}}) {
        const VertexId at = nearest_vertex(surgery, side);
        ASSERT_TRUE(surgery.is_border(at));
        EXPECT_FALSE(leads_off(surgery, at, 0.74 * along));
        EXPECT_TRUE(leads_off(surgery, at, 0.76 * along));
        EXPECT_FALSE(leads_off(surgery, at, -0.24 * along));
        EXPECT_TRUE(leads_off(surgery, at, -0.26 * along));
    }
    const ClothSurgery pinned(cloth.mesh, cloth.ids(), 81, {nearest_vertex(surgery, 0.5 * u)});
    const VertexId at = nearest_vertex(pinned, 0.25 * u);
    EXPECT_FALSE(leads_off(pinned, at, 0.24 * u));
    EXPECT_TRUE(leads_off(pinned, at, 0.26 * u));
}

}  // namespace
}  // namespace arris
