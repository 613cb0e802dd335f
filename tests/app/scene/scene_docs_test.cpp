// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/scene_docs.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/scene/keys/scene_keys.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/scene_load.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

const std::string kDocs = std::string(ARRIS_SOURCE_DIR) + "/docs/";

TEST(SceneDocs, InTheRepositoryAreThoseOfTheTable)
{
    EXPECT_TRUE(read_bytes(kDocs + "scene.md") == scene_markdown()) << "run scripts/docs";
    EXPECT_TRUE(read_bytes(kDocs + "scene.schema.json") == scene_schema()) << "run scripts/docs";
}

TEST(SceneDocs, NameEveryKey)
{
    const std::string text = scene_markdown();
    for (const SceneKey& key : scene_keys()) {
        EXPECT_NE(text.find(key.sentence), std::string::npos) << key.name;
        EXPECT_NE(text.find(leaf_name(key.name)), std::string::npos) << key.name;
    }
}

TEST(SceneDocs, OpenWithASceneThatLoads)
{
    const std::string text = scene_markdown();
    const std::size_t begin = text.find("```toml\n") + 8;
    const RunConfig config =
        load_scene(SceneSource{"s.toml", text.substr(begin, text.find("```", begin) - begin), {}});
    EXPECT_EQ(config.title, "Flag");
    EXPECT_TRUE(config.warnings.empty());
}

/// The schema of a key: through objects by name, through arrays by their items.
nlohmann::json schema_of(std::string_view name)
{
    nlohmann::json schema = nlohmann::json::parse(scene_schema());
    while (!name.empty()) {
        const std::size_t end = std::min(name.find('.'), name.size());
        std::string part(name.substr(0, end));
        const bool is_list = part.ends_with("[]");
        if (is_list) part.resize(part.size() - 2);
        schema = schema.at("properties").at(part);
        if (schema.contains("oneOf")) schema = schema.at("oneOf").at(0);  // a table, or an array of them
        if (is_list) schema = schema.at("items");
        name.remove_prefix(std::min(end + 1, name.size()));
    }
    return schema;
}

TEST(SceneSchema, HasEveryKey)
{
    for (const SceneKey& key : scene_keys()) EXPECT_TRUE(schema_of(key.name).contains("type")) << key.name;
}

TEST(SceneSchema, StatesTypesRangesAndDefaults)
{
    const auto step = schema_of("time.step");
    EXPECT_EQ(step["type"], "number");
    EXPECT_EQ(step["exclusiveMinimum"], 0.0);
    EXPECT_EQ(step["default"], 0.005);
    EXPECT_EQ(schema_of("probe[]")["required"], nlohmann::json::array({"name", "material"}));
    EXPECT_EQ(schema_of("output.formats")["items"]["enum"],
              nlohmann::json::array({"obj", "usd", "viewer", "vtk", "pc2", "mdd", "gltf"}));
    EXPECT_EQ(schema_of("eol.enabled")["type"], "boolean");
    EXPECT_EQ(schema_of("cloth")["additionalProperties"], false);
    const nlohmann::json schema = nlohmann::json::parse(scene_schema());
    const nlohmann::json pieces = schema["properties"]["cloth"]["oneOf"][1];
    EXPECT_EQ(pieces["items"], schema_of("cloth"));
    EXPECT_EQ(pieces["minItems"], 1);
    EXPECT_EQ(schema_of("")["required"], nlohmann::json::array({"duration", "cloth"}));
}

}  // namespace
}  // namespace arris
