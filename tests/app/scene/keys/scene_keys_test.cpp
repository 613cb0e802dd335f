// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_keys.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "physics/elements/material.h"

namespace arris {
namespace {

bool is_table(const SceneKey& key)
{
    return key.type == KeyType::Table || key.type == KeyType::Tables;
}

TEST(SceneKeys, AreUniqueAndStandBelowTheirTable)
{
    std::set<std::string> seen = {""};
    for (const SceneKey& key : scene_keys()) {
        EXPECT_TRUE(seen.insert(std::string(key.name)).second) << key.name;
        const std::size_t dot = key.name.rfind('.');
        const std::string parent(dot == std::string_view::npos ? "" : key.name.substr(0, dot));
        EXPECT_TRUE(seen.contains(parent)) << key.name;
        if (key.type == KeyType::Tables) seen.insert(std::string(key.name) + "[]");
    }
}

TEST(SceneKeys, SayWhatTheyAreFor)
{
    for (const SceneKey& key : scene_keys()) {
        EXPECT_TRUE(key.sentence.ends_with('.')) << key.name;
        EXPECT_FALSE(allowed_values(key).empty()) << key.name;
    }
}

TEST(SceneKeys, HaveDefaultsThatAreJson)
{
    for (const SceneKey& key : scene_keys()) {
        if (key.fallback.empty() || key.fallback == kRequired || key.fallback.starts_with('(')) continue;
        EXPECT_TRUE(nlohmann::json::accept(key.fallback)) << key.name;
    }
}

TEST(SceneKeys, HaveNumericDefaultsWithinTheirRange)
{
    for (const SceneKey& key : scene_keys()) {
        const auto value = nlohmann::json::parse(key.fallback, nullptr, false);
        if (is_table(key) || value.is_discarded()) continue;
        for (const auto& number : value.is_array() ? value : nlohmann::json::array({value})) {
            if (!number.is_number()) continue;
            EXPECT_LE(number.get<double>(), key.range.greatest) << key.name;
            EXPECT_GE(number.get<double>(), key.range.least) << key.name;
        }
    }
}

TEST(SceneKeys, HaveNoDefaultThatIsNotBuilt)
{
    for (const SceneKey& key : scene_keys())
        for (const std::string_view choice : split_choices(key.unbuilt_choices))
            EXPECT_EQ(key.fallback.find(choice), std::string_view::npos) << key.name;
}

TEST(SceneKeys, OfferEveryMaterialPreset)
{
    const auto offered = split_choices(find_scene_key("cloth.material.preset")->choices);
    ASSERT_EQ(offered.size(), kMaterialPresets.size());
    for (std::size_t i = 0; i < offered.size(); ++i) EXPECT_EQ(offered[i], kMaterialPresets[i].name);
}

TEST(EditDistance, CountsChangesAndSwaps)
{
    EXPECT_EQ(edit_distance("", ""), 0);
    EXPECT_EQ(edit_distance("abc", ""), 3);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("step", "step"), 0);
    EXPECT_EQ(edit_distance("step", "stp"), 1);
    EXPECT_EQ(edit_distance("step", "stepp"), 1);
    EXPECT_EQ(edit_distance("step", "stop"), 1);
    EXPECT_EQ(edit_distance("step", "setp"), 1);
    EXPECT_EQ(edit_distance("ca", "abc"), 3);  // restricted: a swapped pair is not touched again
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(ClosestKey, IsASiblingFirst)
{
    EXPECT_EQ(closest_key("cloth", "resolutoin"), "resolution");
    EXPECT_EQ(closest_key("pin[]", "releas"), "release");
    EXPECT_EQ(closest_key("cloth.material", "density_"), "density");
    EXPECT_EQ(closest_key("cloth", "formats"), "output.formats");
    EXPECT_EQ(closest_key("obstacle[]", "velocity"), "motion.velocity");
    EXPECT_EQ(closest_key("pin[]", "translate"), "keyframes[].translate");
    EXPECT_EQ(closest_key("obstacle[].rotate", "angle"), "") << "remesh.angle is no rotation";
    EXPECT_EQ(closest_key("cloth", "qqqqqqqqq"), "");
    EXPECT_EQ(closest_key("cloth", std::string(1'000'000, 'x')), "");
}

}  // namespace
}  // namespace arris
