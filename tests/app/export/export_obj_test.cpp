// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <sstream>

#include "tests/app/example_frame.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

/// The words of every line that begins with `key`, without it.
std::vector<std::vector<std::string>> lines_of(const std::string& text, const std::string& key)
{
    std::vector<std::vector<std::string>> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word != key) continue;
        auto& rest = lines.emplace_back();
        while (words >> word) rest.push_back(word);
    }
    return lines;
}

std::string export_text(const Frame& frame)
{
    const TemporaryDirectory dir;
    write_obj(dir / "a.obj", frame, UpAxis::Z);
    EXPECT_EQ(dir.entry_count(), 1U);
    return read_bytes(dir / "a.obj");
}

template <class Vector>
void expect_same_bits(const std::vector<std::vector<std::string>>& lines, const std::vector<Vector>& vectors)
{
    ASSERT_EQ(lines.size(), vectors.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        ASSERT_EQ(lines[i].size(), static_cast<std::size_t>(vectors[i].size()));
        for (std::size_t k = 0; k < lines[i].size(); ++k)
            EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(lines[i][k].c_str(), nullptr)),
                      std::bit_cast<std::uint64_t>(vectors[i][static_cast<Eigen::Index>(k)]))
                << lines[i][k];
    }
}

TEST(ExportObj, KeepsEveryNumberBitForBit)
{
    const Frame frame = make_example_frame();
    const std::string text = export_text(frame);
    expect_same_bits(lines_of(text, "v"), frame.world);
    expect_same_bits(lines_of(text, "vt"), frame.material);
}

TEST(ExportObj, CountsVerticesFromOne)
{
    using ::testing::ElementsAre;
    const std::string text = export_text(make_example_frame());
    EXPECT_THAT(lines_of(text, "f"),
                ElementsAre(ElementsAre("1/1", "2/2", "3/3"), ElementsAre("3/3", "2/2", "4/4")));
    EXPECT_THAT(lines_of(text, "l"), ElementsAre(ElementsAre("2", "3")));
}

// Readers make lines of an object that has both faces and lines.
TEST(ExportObj, PutsEolEdgesIntoAnObjectOfTheirOwn)
{
    const std::string text = export_text(make_example_frame());
    EXPECT_LT(text.find("\no cloth\n"), text.find("\nf "));
    EXPECT_LT(text.rfind("\nf "), text.find("\no cloth_eol\n"));
    EXPECT_LT(text.find("\no cloth_eol\n"), text.find("\nl "));
}

TEST(ExportObj, HasNoLinesWithoutEolEdges)
{
    Frame frame = make_example_frame();
    frame.eol_edges.clear();
    EXPECT_TRUE(lines_of(export_text(frame), "l").empty());
    EXPECT_EQ(lines_of(export_text(frame), "o").size(), 1U);
    EXPECT_TRUE(lines_of(export_text(Frame{}), "v").empty());
}

TEST(ExportObj, WritesObstaclesWhereTheirPointsAre)
{
    const TemporaryDirectory dir;
    ObstacleRecord thing{"thing", {}, {}, {}};
    thing.mesh.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.1, 0.2, 1.0 / 3.0}};
    thing.mesh.faces = {{0, 1, 2}};
    thing.mesh.segments = {{2, 3}};
    thing.mesh.lone_points = {3};
    write_obj(dir / "thing.obj", thing,
              {{0.0, 0.0, 2.0}, {0.0, 1.0, 2.0}, {-1.0, 0.0, 2.0}, {-0.2, 0.1, 2.0 + 1.0 / 3.0}}, UpAxis::Z);
    EXPECT_EQ(read_bytes(dir / "thing.obj"),
              "# Arris: m, z is up; l: wires; p: lone points\no thing\n"
              "v 0 0 2\nv 0 1 2\nv -1 0 2\nv -0.2 0.1 2.3333333333333335\n"
              "f 1 2 3\nl 3 4\np 4\n");
}

}  // namespace
}  // namespace arris
