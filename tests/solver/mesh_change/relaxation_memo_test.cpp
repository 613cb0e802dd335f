// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/relaxation_memo.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::make_draped;
using testing::make_ridge;

/// Flat cloth with one displaced vertex, which is free.
LoosePatch make_patch(const EolCloth& cloth)
{
    LoosePatch patch{cloth.state.mesh, {}, {}, {}};
    patch.is_free.assign(patch.mesh.world.size(), 0);
    patch.normals.assign(patch.mesh.world.size(), Vec3::Zero());
    const int out = cloth.vertex_at(0.2, 0.2);
    patch.is_free[out] = 1;
    patch.mesh.world[out] += Vec3(0.01, 0.0, 0.02);
    return patch;
}

/// A change that makes the question a new one.
struct Change {
    std::string name;
    std::function<void(LoosePatch&, int)> make;  ///< changes the patch at the given vertex
};

TEST(RelaxationMemo, AnswersWhateverHasChangedAsIfItHadNotBeenAskedBefore)
{
    const EolCloth cloth(make_ridge(60.0), make_draped({4, 0.0, 180.0}));
    const int out = cloth.vertex_at(0.2, 0.2);
    const double drop = 0.9 * testing::elastic_energy_of(cloth.scene, make_patch(cloth).mesh);
    RelaxationMemo memo;
    ASSERT_TRUE(memo.can_relax_by(cloth.scene, make_patch(cloth), drop));

    const std::vector<Change> changes = {
        {"is_free", [](LoosePatch& patch, int v) { patch.is_free[v] = 0; }},
        {"normal", [](LoosePatch& patch, int v) { patch.normals[v] = Vec3::UnitZ(); }},
        {"world", [](LoosePatch& patch, int v) { patch.mesh.world[v == 0 ? 1 : 0].x() += 0.1; }},
        {"material", [](LoosePatch& patch, int v) { patch.mesh.material[v].x() += 0.02; }},
        {"creases",
         [](LoosePatch& patch, int v) {
             patch.creases = {{0.1}, {{v, patch.mesh.vertex_count()}}};
         }},
        {"faces", [](LoosePatch& patch, int) { patch.mesh.faces.pop_back(); }},
    };
    int questions = 1;
    for (const Change& change : changes) {
        LoosePatch patch = make_patch(cloth);
        change.make(patch, out);
        EXPECT_EQ(memo.can_relax_by(cloth.scene, patch, drop), can_relax_by(cloth.scene, patch, drop))
            << change.name;
        EXPECT_EQ(memo.count(), ++questions) << change.name;
    }
    EXPECT_FALSE(memo.can_relax_by(cloth.scene, make_patch(cloth), 1.0));
    EXPECT_EQ(memo.count(), ++questions) << "drop";
}

TEST(RelaxationMemo, AsksOnce)
{
    const EolCloth cloth(make_ridge(60.0), make_draped({4, 0.0, 180.0}));
    RelaxationMemo memo;
    const double energy = testing::elastic_energy_of(cloth.scene, make_patch(cloth).mesh);
    for (const double share : {0.9, 2.0, 0.9, 2.0})
        EXPECT_EQ(memo.can_relax_by(cloth.scene, make_patch(cloth), share * energy), share < 1.0);
    EXPECT_EQ(memo.count(), 2);
}

}  // namespace
}  // namespace arris
