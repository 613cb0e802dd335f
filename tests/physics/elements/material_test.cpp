// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/material.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace arris {
namespace {

TEST(MaterialPresets, AreSheetsWithASource)
{
    std::set<std::string_view> names;
    for (const MaterialPreset& preset : kMaterialPresets) {
        const Material& material = preset.material;
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_TRUE(preset.source.ends_with('.')) << preset.name;
        // Densities are between those of tulle and of a belt.
        EXPECT_GT(material.density, 0.02) << preset.name;
        EXPECT_LT(material.density, 2.0) << preset.name;
        EXPECT_GT(material.youngs_modulus, 50.0) << preset.name;
        EXPECT_LT(material.youngs_modulus, 1e5) << preset.name;
        EXPECT_GE(material.poisson_ratio, 0.0) << preset.name;
        EXPECT_LE(material.poisson_ratio, 0.5) << preset.name;
        EXPECT_GT(material.bending_stiffness, 1e-7) << preset.name;
        EXPECT_LT(material.bending_stiffness, 1e-2) << preset.name;
        EXPECT_EQ(material.damping, 0.0) << preset.name;
        EXPECT_EQ(material.thickness, 1e-3) << preset.name;
    }
}

TEST(MaterialPresets, AreFoundByName)
{
    for (const MaterialPreset& preset : kMaterialPresets) {
        const auto found = find_material_preset(preset.name);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->density, preset.material.density);
        EXPECT_EQ(found->bending_stiffness, preset.material.bending_stiffness);
    }
    EXPECT_FALSE(find_material_preset("spandex"));
    EXPECT_FALSE(find_material_preset(""));
    EXPECT_FALSE(find_material_preset("Cotton"));
}

TEST(MaterialPresets, HaveTheDocumentedCotton)
{
    const Material cotton = find_material_preset("cotton").value();
    EXPECT_EQ(cotton.density, 0.15);
    EXPECT_EQ(cotton.youngs_modulus, 500.0);
    EXPECT_EQ(cotton.poisson_ratio, 0.3);
    EXPECT_EQ(cotton.bending_stiffness, 1e-5);
}

}  // namespace
}  // namespace arris
