// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/cloth_elements.h"

#include <gtest/gtest.h>

#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

TEST(ClothElements, UpdatedElementsAreThoseMadeAnew)
{
    ClothMesh mesh = crumpled_sheet({5, 4}, GridPattern::Cross, 14);
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    ClothElements updated = make_elements(mesh, topology);
    const double weight_before = updated.hinges[7].weight;
    Generator random(15);
    std::vector<char> is_moved(mesh.material.size(), 0);
    for (int v = 0; v < mesh.vertex_count(); v += 3) {
        is_moved[v] = 1;
        mesh.material[v] += random2(random, 0.01);
    }
    update_elements(mesh, is_moved, updated);
    const ClothElements anew = make_elements(mesh, topology);
    for (std::size_t f = 0; f < anew.faces.size(); ++f) {
        EXPECT_EQ(updated.faces[f].area, anew.faces[f].area);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(updated.faces[f].gradients[i], anew.faces[f].gradients[i]);
    }
    for (std::size_t h = 0; h < anew.hinges.size(); ++h)
        EXPECT_EQ(updated.hinges[h].weight, anew.hinges[h].weight);
    EXPECT_NE(anew.hinges[7].weight, weight_before);
}

}  // namespace
}  // namespace arris
