// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/creases.h"

#include <gtest/gtest.h>

#include "geometry/cloth/mesh_topology.h"
#include "tests/solver/eol_cloth.h"

namespace arris::testing {
namespace {

ClothElements elements_of(const ClothMesh& mesh)
{
    return make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
}

/// Draped cloth with EOL vertices at `count` neighbouring places on the ridge.
EolCloth draped_with(int count)
{
    const Drape drape;
    EolCloth cloth(make_ridge(90.0), make_draped(drape));
    cloth.scene.gravity = Gravity{};
    cloth.scene.materials[0].bending_stiffness = 1e-6;  // this cloth bends within millimetres
    const int tip = tip_of(cloth.scene.obstacles[0].shape());
    for (int k = 0; k < count; ++k)
        cloth.add_eol(cloth.vertex_at(0.2, 0.1 + k * 0.4 / drape.cells), false, tip);
    return cloth;
}

bool mark(const EolCloth& cloth, ClothElements& elements)
{
    return mark_creases(find_creases(cloth.scene, cloth.state, cloth.stars()), cloth.state.mesh, elements);
}

std::vector<HingeElement> creases_of(const ClothElements& elements)
{
    std::vector<HingeElement> creases;
    for (const HingeElement& hinge : elements.hinges)
        if (hinge.is_crease()) creases.push_back(hinge);
    return creases;
}

TEST(Creases, AreTheHingesAlongAFeatureBetweenEolVertices)
{
    for (const int count : {0, 1, 2, 4}) {
        EolCloth cloth = draped_with(count);
        ClothElements elements = elements_of(cloth.state.mesh);
        EXPECT_EQ(mark(cloth, elements), count > 1);
        const std::vector<HingeElement> creases = creases_of(elements);
        EXPECT_EQ(static_cast<int>(creases.size()), std::max(count - 1, 0));
        for (const HingeElement& crease : creases) {
            for (const int k : {0, 1})
                EXPECT_GE(cloth.state.eol_entry(cloth.state.ids[crease.vertices[k]]), 0);
            const std::vector<Vec2>& X = cloth.state.mesh.material;
            const double length = (X[crease.vertices[1]] - X[crease.vertices[0]]).norm();
            EXPECT_DOUBLE_EQ(crease.weight, 3.0 * length / crease.crease_width);
        }
    }
}

TEST(Creases, AreNoneWithoutATargetForTheMesh)
{
    EolCloth cloth = draped_with(3);
    cloth.scene.eol.reset();
    ClothElements elements = elements_of(cloth.state.mesh);
    EXPECT_FALSE(mark(cloth, elements));
}

TEST(Creases, AreNoneWhereTheBendIsAsWide)
{
    EolCloth cloth = draped_with(3);
    const double half = 0.5 * 0.87 * cloth.scene.eol->mean_lengths[0];
    const double tension = cloth.scene.materials[0].density * 9.81 * 0.4;
    for (const auto& [share, is_crease] : {std::pair(0.99, true), {1.01, false}}) {
        cloth.scene.materials[0].bending_stiffness = share * tension * half * half;
        ClothElements elements = elements_of(cloth.state.mesh);
        EXPECT_EQ(mark(cloth, elements), is_crease);
        EXPECT_EQ(creases_of(elements).empty(), !is_crease);
    }
    cloth.scene.materials[0].bending_stiffness = 1e-6;
    cloth.scene.gravity.reset();
    ClothElements elements = elements_of(cloth.state.mesh);
    EXPECT_FALSE(mark(cloth, elements)) << "nothing pulls";
}

TEST(Creases, AreNoneAnyMoreWhereTheVerticesAreReleased)
{
    EolCloth cloth = draped_with(3);
    ClothElements elements = elements_of(cloth.state.mesh);
    const ClothElements plain = elements;
    ASSERT_TRUE(mark(cloth, elements));
    EXPECT_FALSE(mark(cloth, elements)) << "nothing has changed";
    cloth.state.eol.clear();
    EXPECT_TRUE(mark(cloth, elements));
    EXPECT_TRUE(creases_of(elements).empty());
    for (std::size_t h = 0; h < plain.hinges.size(); ++h)
        EXPECT_EQ(elements.hinges[h].weight, plain.hinges[h].weight);
}

}  // namespace
}  // namespace arris::testing
