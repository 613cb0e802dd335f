// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/crossings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/scene/scene_load.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

constexpr const char* kCloth =
    "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [8, 8]\npattern = \"diagonal\"\ntranslate = [-0.5, "
    "-0.5, 0]\n";

std::string read(const std::string& path)
{
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Statements of an OBJ text by object, without vertices.
std::map<std::string, std::map<char, int>> count_statements(const std::string& text)
{
    std::map<std::string, std::map<char, int>> counts;
    std::istringstream lines(text);
    std::string object, line;
    while (std::getline(lines, line)) {
        if (line[0] == 'o') counts[object = line.substr(2)];
        if (line[0] == 'f' || line[0] == 'l' || line[0] == 'p') ++counts[object][line[0]];
    }
    return counts;
}

std::map<std::string, std::map<char, int>> crossings_of(const std::string& scene)
{
    const TemporaryDirectory folder;
    LoadOptions options;
    options.tells_intersections = true;
    write_crossings(folder / "crossings.obj",
                    load_scene(SceneSource{folder / "s.toml", kCloth + scene, {}}, options));
    return count_statements(read(folder / "crossings.obj"));
}

TEST(Crossings, AreTheFacesThatABoxCuts)
{
    // The box stands in the middle cell of the cloth: its sides cut the two faces of four cells.
    const auto counts = crossings_of(
        "[[obstacle]]\nname = \"post\"\nbox = [0.2, 0.2, 1]\n"
        "[[obstacle]]\nname = \"away\"\nbox = [1, 1, 1]\ntranslate = [0, 0, 3]\n");
    ASSERT_EQ(counts.size(), 3U);
    EXPECT_EQ(counts.at("cloth").at('f'), 8);
    EXPECT_EQ(counts.at("post").at('f'), 8);  // two triangles of each of four sides
    EXPECT_TRUE(counts.at("away").empty());
}

TEST(Crossings, AreWiresPointsAndTheClothItself)
{
    const auto counts = crossings_of(
        "[[obstacle]]\nname = \"line\"\nwire = [[0.02, 0.01, -1], [0.02, 0.01, 1], [3, 0, 1]]\n"
        "[[obstacle]]\nname = \"nail\"\npoints = [[0.3, 0.28, 0], [0.3, 0.28, 1]]\n");
    EXPECT_EQ(counts.at("cloth").at('f'), 2);
    EXPECT_EQ(counts.at("line").at('l'), 1);
    EXPECT_EQ(counts.at("nail").at('p'), 1);
    // A strip that is rolled up into a square, with a last side that crosses the first.
    const auto own = crossings_of(
        "folds = [ { line = [[0.25, 0.0], [0.25, 1.0]], degrees = 95 },"
        "          { line = [[0.5, 0.0], [0.5, 1.0]], degrees = 95 },"
        "          { line = [[0.625, 0.0], [0.625, 1.0]], degrees = 95 } ]\n[self_contact]\n");
    EXPECT_GT(own.at("cloth").at('f'), 8);
}

TEST(Crossings, OfClothInsideAnObstacleAreItsDeepestFace)
{
    const auto counts = crossings_of("[[obstacle]]\nname = \"hall\"\nbox = [4, 4, 4]\n");
    EXPECT_EQ(counts.at("cloth").at('f'), 1);
    EXPECT_TRUE(counts.at("hall").empty());
}

TEST(Crossings, ArePagesThatMarkThem)
{
    const TemporaryDirectory folder;
    LoadOptions options;
    options.tells_intersections = true;
    const auto meta_of = [&](const std::string& scene) {
        write_crossings(folder / "crossings.html",
                        load_scene(SceneSource{folder / "s.toml", kCloth + scene, {}}, options));
        const std::string page = read(folder / "crossings.html");
        const std::string opening = "id=\"arris-meta\">";
        const std::size_t begin = page.find(opening) + opening.size();
        return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    };
    const nlohmann::json crossed = meta_of("[[obstacle]]\nname = \"post\"\nbox = [0.2, 0.2, 1]\n");
    EXPECT_EQ(crossed["frames"].size(), 1U);
    ASSERT_EQ(crossed["meshes"].size(), 3U);
    EXPECT_FALSE(crossed["meshes"][0].contains("mark"));
    EXPECT_EQ(crossed["meshes"][1]["name"], "cloth");
    EXPECT_EQ(crossed["meshes"][1]["faces"], 8);
    EXPECT_EQ(crossed["meshes"][2]["name"], "post");
    EXPECT_TRUE(crossed["meshes"][1]["mark"].get<bool>() && crossed["meshes"][2]["mark"].get<bool>());
    EXPECT_THAT(crossed["title"].get<std::string>(), HasSubstr("8 faces of cloth cross or touch"));

    const nlohmann::json clear = meta_of("");
    EXPECT_TRUE(clear["meshes"].empty());
    EXPECT_THAT(clear["title"].get<std::string>(), HasSubstr("nothing crosses or touches"));
    std::ofstream(folder / "viewer.html") << "<!-- a run's page -->\n";
    EXPECT_THAT(
        error_of([&] {
            write_crossings(folder / "viewer.html", load_scene(SceneSource{folder / "s.toml", kCloth, {}}));
        }),
        HasSubstr("viewer.html"));
}

TEST(Crossings, ReplaceNoFileOfAnotherKind)
{
    const TemporaryDirectory folder;
    const RunConfig config = load_scene(SceneSource{folder / "s.toml", kCloth, {}});
    write_crossings(folder / "own.obj", config);
    write_crossings(folder / "own.obj", config);
    EXPECT_EQ(count_statements(read(folder / "own.obj")).size(), 1U);
    std::ofstream(folder / "cloth.obj") << "v 0 0 0\n";
    EXPECT_THAT(error_of([&] { write_crossings(folder / "cloth.obj", config); }), HasSubstr("cloth.obj"));
    EXPECT_EQ(read(folder / "cloth.obj"), "v 0 0 0\n");
    EXPECT_THROW(write_crossings(folder / "none/own.obj", config), std::system_error);
}

}  // namespace
}  // namespace arris
