// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/sub_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {
namespace {

TEST(SubMesh, HasTheFacesAskedForInTheirOrder)
{
    ClothGrid grid;
    grid.resolution = {4, 4};
    const ClothMesh whole = make_cloth_grid(grid);
    const std::vector<int> faces = {17, 3, 40, 4, 3};  // face 3 twice
    const SubMesh part = extract_faces(whole, faces);
    ASSERT_EQ(part.mesh.faces.size(), faces.size());
    ASSERT_EQ(part.mesh.world.size(), part.vertices.size());
    ASSERT_EQ(part.mesh.material.size(), part.vertices.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int v = part.mesh.faces[f][k];
            EXPECT_EQ(part.vertices[v], whole.faces[faces[f]][k]);
            EXPECT_EQ(part.mesh.world[v], whole.world[part.vertices[v]]);
            EXPECT_EQ(part.mesh.material[v], whole.material[part.vertices[v]]);
        }
    EXPECT_EQ(part.mesh.faces[0], (Face{0, 1, 2})) << "as the faces name them first";
    EXPECT_EQ(std::set<int>(part.vertices.begin(), part.vertices.end()).size(), part.vertices.size());
}

TEST(SubMesh, OfNoFacesIsEmpty)
{
    const SubMesh part = extract_faces(make_cloth_grid({}), {});
    EXPECT_TRUE(part.mesh.faces.empty());
    EXPECT_TRUE(part.vertices.empty());
}

}  // namespace
}  // namespace arris
