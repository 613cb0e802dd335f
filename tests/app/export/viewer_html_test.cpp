// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/viewer_html.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/frame.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/app/stretching_obstacle.h"

namespace arris {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// A directory of its own for each test, gone afterwards.
class ViewerHtml : public testing::Test {
  protected:
    void SetUp() override
    {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        run_ =
            (fs::temp_directory_path() / fmt::format("arris_viewer_{}_{}", test->name(), getpid())).string();
        fs::create_directories(run_ + "/frames");
    }
    void TearDown() override { fs::remove_all(run_); }

    std::string frame_path(int index) const { return fmt::format("{}/frames/cloth_{:05d}.ply", run_, index); }
    std::string page_path() const { return run_ + "/viewer.html"; }
    std::string page() const
    {
        std::ifstream in(page_path(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string refusal(const ViewerOptions& options = {}) const
    {
        try {
            write_viewer(run_, options);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    std::string run_;
};

/// A strip of `columns` squares with random positions in a box at `centre`, strains and contacts.
Frame make_strip(int columns, const Vec3& centre, const Vec3& extent, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    Frame frame;
    for (int v = 0; v < 2 * (columns + 1); ++v) {
        frame.world.push_back(centre + extent.cwiseProduct(Vec3(unit(random), unit(random), unit(random))));
        frame.material.emplace_back(v / 2, v % 2);
        frame.contact.push_back(unit(random) > 0.2 ? 1 : 0);
    }
    for (int c = 0; c < columns; ++c) {
        frame.faces.push_back({2 * c, 2 * c + 2, 2 * c + 3});
        frame.faces.push_back({2 * c, 2 * c + 3, 2 * c + 1});
    }
    for (std::size_t f = 0; f < frame.faces.size(); ++f) frame.strain.push_back(unit(random));
    frame.vertex_velocity.assign(frame.world.size(), Vec3::Zero());
    for (std::size_t v = 0; v < frame.world.size(); ++v)
        frame.material_velocity.emplace_back(unit(random), unit(random), unit(random));
    frame.ids.assign(frame.world.size(), 0);
    frame.eol.assign(frame.world.size(), 0);
    frame.stretch_energy.assign(frame.faces.size(), 0.0);
    frame.bending_energy = frame.stretch_energy;
    return frame;
}

Frame make_strip(int columns, unsigned seed)
{
    return make_strip(columns, Vec3(0.3, -2.0, 1.0), Vec3(1.0, 2.0, 0.1), seed);
}

// Below: the page read as viewer/README.md describes it, with other tools than those that wrote it.

std::vector<std::string> elements(const std::string& page, const std::string& id)
{
    std::vector<std::string> found;
    const std::string head = " id=\"" + id + "\">";
    for (std::size_t at = page.find(head); at != std::string::npos; at = page.find(head, at + 1)) {
        const std::size_t begin = at + head.size();
        found.push_back(page.substr(begin, page.find("</script>", begin) - begin));
    }
    return found;
}

json meta(const std::string& page)
{
    const auto found = elements(page, "arris-meta");
    EXPECT_EQ(found.size(), 1U);
    return json::parse(found.at(0));
}

std::vector<std::uint8_t> unpacked(const std::string& page, const std::string& id, std::size_t length)
{
    const auto found = elements(page, id);
    EXPECT_EQ(found.size(), 1U) << id;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> packed;
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : found.at(0)) {
        if (c == '=') break;
        group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
        bits += 6;
        if (bits >= 8) packed.push_back(static_cast<std::uint8_t>(group >> (bits -= 8)));
    }
    std::vector<std::uint8_t> bytes(length + 1);  // one more, to notice what is too long
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &size, packed.data(), packed.size()), Z_OK) << id;
    EXPECT_EQ(size, length) << id;
    return bytes;
}

/// 16-bit numbers from their differences in two planes, high bytes first.
std::vector<std::uint32_t> levels(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t count)
{
    std::vector<std::uint32_t> result;
    std::uint32_t level = 0;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(level = (level + 256U * bytes[at + i] + bytes[at + count + i]) % 65536U);
    return result;
}

std::vector<int> indices(const std::vector<std::uint8_t>& bytes, std::size_t count)
{
    std::vector<int> result;
    int value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::int64_t code = 0;
        for (std::size_t plane = 0; plane < 4; ++plane) code = code * 256 + bytes[plane * count + i];
        value += static_cast<int>(code % 2 == 0 ? code / 2 : -(code + 1) / 2);
        result.push_back(value);
    }
    return result;
}

struct Decoded {
    std::vector<Vec3> world;
    std::vector<Vec2> material;
    std::vector<double> speed;
    std::vector<double> strain;
    std::vector<int> contact;
    std::vector<int> topology;  // faces, EOL edges, corners
};

Decoded decode(const std::string& page, std::size_t position)
{
    const json all = meta(page);
    const json& frame = all["frames"].at(position);
    const auto topology = std::find_if(all["topologies"].begin(), all["topologies"].end(),
                                       [&](const json& entry) { return entry["id"] == frame["topology"]; });
    const std::size_t n = (*topology)["vertices"], m = (*topology)["faces"];
    const std::size_t e = (*topology)["edges"], corners = (*topology)["corners"];
    const std::size_t count = 3 * m + 2 * e + corners;
    const auto mesh =
        unpacked(page, fmt::format("arris-topology-{}", frame["topology"].get<int>()), 4 * count + 4 * n);
    const std::vector<int> mesh_indices = indices(mesh, count);
    const std::set<int> moving(mesh_indices.begin() + static_cast<std::ptrdiff_t>(3 * m), mesh_indices.end());
    const std::size_t moving_at = 6 * n + 2 * m + (n + 7) / 8, speed_at = moving_at + 4 * moving.size();
    const auto bytes = unpacked(page, fmt::format("arris-frame-{}", frame["index"].get<int>()), speed_at + n);

    Decoded result;
    result.world.resize(n);
    for (int axis = 0; axis < 3; ++axis) {
        const auto numbers = levels(bytes, 2 * n * static_cast<std::size_t>(axis), n);
        for (std::size_t v = 0; v < n; ++v)
            result.world[v][axis] =
                frame["least"][axis].get<double>() + frame["size"][axis].get<double>() * numbers[v] / 65535.0;
    }
    for (const std::uint32_t level : levels(bytes, 6 * n, m))
        result.strain.push_back(frame["strain"][0].get<double>() +
                                frame["strain"][1].get<double>() * level / 65535.0);
    for (std::size_t v = 0; v < n; ++v) result.contact.push_back(bytes[6 * n + 2 * m + v / 8] >> (v % 8) & 1);
    result.topology = mesh_indices;

    result.material.resize(n);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double least = (*topology)["least"][axis], size = (*topology)["size"][axis];
        const auto numbers = levels(mesh, 4 * count + 2 * n * axis, n);
        for (std::size_t v = 0; v < n; ++v)
            result.material[v][static_cast<Eigen::Index>(axis)] = least + size * numbers[v] / 65535.0;
        const auto moved = levels(bytes, moving_at + 2 * moving.size() * axis, moving.size());
        std::size_t k = 0;
        for (const int v : moving)
            result.material[static_cast<std::size_t>(v)][static_cast<Eigen::Index>(axis)] =
                least + size * moved[k++] / 65535.0;
    }
    std::uint8_t level = 0;
    for (std::size_t v = 0; v < n; ++v) {
        level = static_cast<std::uint8_t>(level + bytes[speed_at + v]);
        result.speed.push_back(frame["speed"].get<double>() * level / 255.0);
    }
    return result;
}

/// Half a level of the box or range, and the rounding of the doubles around `magnitude`.
double half_level(double range, double magnitude)
{
    return 0.5 * range / 65535.0 * (1.0 + 1e-9) + 4.0 * std::numeric_limits<double>::epsilon() * magnitude;
}

void expect_shows(const std::string& page, std::size_t position, const Frame& frame)
{
    const Decoded decoded = decode(page, position);
    ASSERT_EQ(decoded.world.size(), frame.world.size());
    ASSERT_EQ(decoded.strain.size(), frame.strain.size());
    for (int axis = 0; axis < 3; ++axis) {
        double least = frame.world[0][axis], most = least;
        for (const Vec3& x : frame.world) least = std::min(least, x[axis]), most = std::max(most, x[axis]);
        const double tolerance = half_level(most - least, std::max(std::abs(least), std::abs(most)));
        for (std::size_t v = 0; v < frame.world.size(); ++v)
            ASSERT_NEAR(decoded.world[v][axis], frame.world[v][axis], tolerance) << "vertex " << v;
    }
    const auto [least, most] = std::minmax_element(frame.strain.begin(), frame.strain.end());
    for (std::size_t f = 0; f < frame.strain.size(); ++f)
        ASSERT_NEAR(decoded.strain[f], frame.strain[f], half_level(*most - *least, 1.0)) << "face " << f;
    EXPECT_THAT(decoded.contact, testing::ElementsAreArray(frame.contact));
    double most_speed = 0.0;
    for (const Vec3& velocity : frame.material_velocity) most_speed = std::max(most_speed, velocity.norm());
    for (std::size_t v = 0; v < frame.world.size(); ++v) {
        ASSERT_NEAR((decoded.material[v] - frame.material[v]).cwiseAbs().maxCoeff(), 0.0,
                    half_level(100.0, 100.0))
            << "vertex " << v;
        ASSERT_NEAR(decoded.speed[v], frame.material_velocity[v].norm(), 0.501 / 255.0 * most_speed)
            << "vertex " << v;
    }

    std::vector<int> topology;
    for (const Face& face : frame.faces) topology.insert(topology.end(), face.begin(), face.end());
    for (const auto& edge : frame.eol_edges) topology.insert(topology.end(), edge.begin(), edge.end());
    for (std::size_t v = 0; v < frame.eol.size(); ++v)
        if (frame.eol[v] == 2) topology.push_back(static_cast<int>(v));
    EXPECT_EQ(decoded.topology, topology);
}

TEST_F(ViewerHtml, HoldsEveryFrameToHalfALevelOfItsBox)
{
    std::vector<Frame> frames;
    for (unsigned k = 0; k < 5; ++k) frames.push_back(make_strip(100, k));
    for (int k = 0; k < 5; ++k) write_frame(frame_path(k), frames[k]);
    write_viewer(run_, {"strip", 25.0});

    const json all = meta(page());
    EXPECT_EQ(all["format"], 3);
    EXPECT_EQ(all["title"], "strip");
    EXPECT_EQ(all["frames_per_second"], 25.0);
    EXPECT_EQ(all["run_frames"], 5);
    EXPECT_EQ(all["stride"], 1);
    for (std::size_t k = 0; k < 5; ++k) expect_shows(page(), k, frames[k]);
}

TEST_F(ViewerHtml, KeepsItsPrecisionFarAwayFlatTinyAndHuge)
{
    const std::vector<Frame> frames = {
        make_strip(7, Vec3(1e6, -1e6, 3.0), Vec3(1.0, 1.0, 1.0), 1),  // far from the origin
        make_strip(7, Vec3::Zero(), Vec3(1.0, 1.0, 0.0), 2),          // flat: one direction without extent
        make_strip(7, Vec3::Zero(), Vec3(1e-9, 1e-9, 1e-9), 3),
        make_strip(7, Vec3::Zero(), Vec3(1e17, 1.0, 1.0), 4),
        make_strip(7, Vec3(5.0, 5.0, 5.0), Vec3::Zero(), 5),  // all in one point
    };
    for (std::size_t k = 0; k < frames.size(); ++k) write_frame(frame_path(static_cast<int>(k)), frames[k]);
    write_viewer(run_, {});
    for (std::size_t k = 0; k < frames.size(); ++k) expect_shows(page(), k, frames[k]);
}

TEST_F(ViewerHtml, StoresATopologyAnewWhereAnyOtherVertexMovesInTheMaterial)
{
    std::vector<Frame> frames(2, make_strip(20, 1));
    frames[1].material[5] = {2.3, 0.9};
    for (int k = 0; k < 2; ++k) write_frame(frame_path(k), frames[k]);
    write_viewer(run_, {});
    EXPECT_EQ(meta(page())["topologies"].size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) expect_shows(page(), k, frames[k]);
}

TEST_F(ViewerHtml, StoresATopologyOnlyWhereItChanges)
{
    std::vector<Frame> frames;
    for (unsigned k = 0; k < 8; ++k) frames.push_back(make_strip(k < 6 ? 20 : 33, k));
    for (unsigned k = 2; k < 5; ++k) frames[k].eol_edges = {{2, 4}, {4, 6}, {40, 38}};
    frames[3].material[4] = {2.3, 0.1};  // an EOL vertex slides: the topology stays
    frames[4].eol[6] = 2;
    frames[4].eol[4] = 1;
    for (int k = 0; k < 8; ++k) write_frame(frame_path(k), frames[k]);
    write_viewer(run_, {});

    std::vector<int> used;
    const json all = meta(page());
    for (const json& frame : all["frames"]) used.push_back(frame["topology"]);
    EXPECT_EQ(used, (std::vector<int>{0, 0, 1, 1, 2, 3, 4, 4}));
    EXPECT_EQ(all["topologies"].size(), 5U);
    for (std::size_t k = 0; k < 8; ++k) expect_shows(page(), k, frames[k]);
}

/// What a page of `frames` with at most `most` bytes must be, whatever its blocks compress to.
void expect_thinned(const std::string& page, const std::vector<Frame>& frames, std::size_t most)
{
    const json all = meta(page);
    const auto count = static_cast<int>(frames.size());
    const int stride = all["stride"];
    EXPECT_EQ(all["run_frames"], count);
    std::vector<int> expected, kept;
    for (int k = 0; k < count; ++k)
        if (k % stride == 0 || k == count - 1) expected.push_back(k);
    std::set<int> used, listed;
    for (const json& frame : all["frames"]) {
        kept.push_back(frame["index"]);
        used.insert(frame["topology"].get<int>());
    }
    ASSERT_EQ(kept, expected);
    for (const json& topology : all["topologies"]) listed.insert(topology["id"].get<int>());
    EXPECT_EQ(listed, used);

    std::size_t characters = 0;
    for (const int id : kept) characters += elements(page, fmt::format("arris-frame-{}", id)).at(0).size();
    for (const int id : used) characters += elements(page, fmt::format("arris-topology-{}", id)).at(0).size();
    const std::size_t bytes = characters * 3 / 4;
    const std::size_t padding = 3 * (kept.size() + used.size());
    if (kept.size() > 2) {
        EXPECT_LE(bytes, most + padding);
    }
    if (stride > 1) {
        EXPECT_GE(2 * bytes + padding, most / 2) << "more frames would have fitted";
    }
    for (std::size_t position = 0; position < kept.size(); ++position)
        expect_shows(page, position, frames[kept[position]]);
}

TEST_F(ViewerHtml, LeavesFramesOutWhereTheyDoNotFitAndSaysSo)
{
    // The mesh changes at an odd frame, so that thinning may throw out the frame that brought the new one.
    std::vector<Frame> frames;
    // One mesh is that of a single frame.
    for (unsigned k = 0; k < 22; ++k) frames.push_back(make_strip(k == 7 ? 42 : k < 9 ? 40 : 41, k));
    for (int k = 0; k < 22; ++k) write_frame(frame_path(k), frames[k]);
    std::set<int> strides;
    for (std::size_t most = 400; most < 24'000; most += 300) {
        write_viewer(run_, {"long", 24.0, most});
        ASSERT_NO_FATAL_FAILURE(expect_thinned(page(), frames, most)) << most;
        strides.insert(meta(page())["stride"].get<int>());
    }
    EXPECT_EQ(strides, (std::set<int>{1, 2, 4, 8, 16, 32}));
    write_viewer(run_, {"long", 24.0, 1});
    EXPECT_EQ(meta(page())["frames"].size(), 2U) << "the first and the last are always there";
}

/// Points of the k-th obstacle where the page has them at a frame of its list, m.
std::vector<Vec3> mesh_points(const std::string& page, std::size_t k, std::size_t position)
{
    const json all = meta(page);
    const json& mesh = all["meshes"].at(k);
    const json& placements = mesh["placements"];
    const json& rows = placements.at(placements.size() == 1 ? 0 : position);
    const std::size_t n = mesh["points"], indices = 3 * mesh["faces"].get<std::size_t>() +
                                                    2 * mesh["segments"].get<std::size_t>() +
                                                    mesh["lone_points"].get<std::size_t>();
    const auto bytes = unpacked(page, fmt::format("arris-mesh-{}", k), 4 * (3 * n + indices));
    std::vector<Vec3> points(n);
    for (std::size_t p = 0; p < n; ++p) {
        Vec3 local;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::uint32_t bits = 0;
            for (std::size_t plane = 0; plane < 4; ++plane)
                bits = bits << 8 | bytes[plane * 3 * n + axis * n + p];
            float value = 0.0F;
            std::memcpy(&value, &bits, sizeof value);
            local[static_cast<Eigen::Index>(axis)] = value;
        }
        for (std::size_t row = 0; row < 3; ++row)
            points[p][static_cast<Eigen::Index>(row)] =
                rows[4 * row].get<double>() * local.x() + rows[4 * row + 1].get<double>() * local.y() +
                rows[4 * row + 2].get<double>() * local.z() + rows[4 * row + 3].get<double>();
    }
    return points;
}

TEST_F(ViewerHtml, HoldsObstaclesOnceAndWhereTheyAreInEveryFrame)
{
    for (int i = 0; i < 5; ++i) write_frame(frame_path(i), make_strip(3, 7U));
    ObstacleRecord table{"table", make_box({1.0, 2.0, 0.5}), {}, {}};
    table.placement = {rotation_about({1.0, 2.0, 3.0}, 40.0), {100.0, 0.5, -2.0}};
    ObstacleRecord rope{
        "rope", make_wire({{9.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, {10.0, 1.0, 0.3}}, true), {}, {}};
    rope.motion.velocity = {1.0, 0.0, 0.0};
    rope.motion.angular_velocity = {0.0, 0.0, 3.0};
    const std::vector<ObstacleRecord> obstacles = {
        table, rope, {"nails", make_points({{0.0, 0.0, 1.0}, {2.0, 0.0, 1.0}}), {}, {}}};
    write_viewer(run_, {"obstacles", 24.0}, obstacles);

    const std::string written = page();
    constexpr double kSingle = 1e-7;  // of 1 m about the middle of an obstacle
    ASSERT_EQ(meta(written)["meshes"].size(), 3U);
    EXPECT_FALSE(meta(written).contains("left_out"));
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(meta(written)["meshes"][k]["name"], obstacles[k].name);
        EXPECT_EQ(meta(written)["meshes"][k]["placements"].size(), k == 1 ? 5U : 1U);
        for (const std::size_t position : {0U, 4U}) {
            const std::vector<Vec3> points = mesh_points(written, k, position);
            ASSERT_EQ(points.size(), obstacles[k].mesh.points.size());
            const Placement placement = obstacles[k].at(static_cast<double>(position) / 24.0);
            for (std::size_t p = 0; p < points.size(); ++p)
                EXPECT_NEAR((points[p] - placement(obstacles[k].mesh.points[p])).norm(), 0.0, 2.0 * kSingle);
        }
    }
    EXPECT_EQ(meta(written)["meshes"][0]["size"], json({1.0, 2.0, 0.5}));
}

TEST_F(ViewerHtml, LeavesObstaclesOutThatTakeMoreThanHalfThePage)
{
    for (int i = 0; i < 3; ++i) write_frame(frame_path(i), make_strip(3, 7U));
    std::vector<Vec3> many;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    for (int i = 0; i < 2000; ++i) many.emplace_back(unit(random), unit(random), unit(random));
    ViewerOptions options{"crowded", 24.0};
    options.most_bytes = 10000;
    write_viewer(run_, options,
                 {{"many", make_points(many), {}, {}}, {"box", make_box({1.0, 1.0, 1.0}), {}, {}}});
    const json all = meta(page());
    EXPECT_EQ(all["left_out"], json({"many"}));
    ASSERT_EQ(all["meshes"].size(), 1U);
    EXPECT_EQ(all["meshes"][0]["name"], "box");
    EXPECT_EQ(all["frames"].size(), 3U);
}

/// Points of the k-th obstacle, which deforms without motion, where the page has them at a frame of its list.
std::vector<Vec3> pose_points(const std::string& page, std::size_t k, std::size_t position)
{
    const json all = meta(page);
    const json& mesh = all["meshes"].at(k);
    const json &rows = mesh["placements"].at(0), &box = mesh["poses"].at(position);
    const std::size_t n = mesh["points"];
    const auto bytes = unpacked(
        page, fmt::format("arris-pose-{}-{}", k, all["frames"].at(position)["index"].get<int>()), 6 * n);
    std::vector<Vec3> points(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto numbers = levels(bytes, 2 * n * axis, n);
        for (std::size_t p = 0; p < n; ++p)
            points[p][static_cast<Eigen::Index>(axis)] =
                box["least"][axis].get<double>() + box["size"][axis].get<double>() * numbers[p] / 65535.0 +
                rows[4 * axis + 3].get<double>();
    }
    return points;
}

TEST_F(ViewerHtml, HoldsThePointsOfObstaclesThatDeformInEveryFrame)
{
    for (int i = 0; i < 5; ++i) write_frame(frame_path(i), make_strip(3, 7U));
    ObstacleRecord body = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    body.placement.translation = {100.0, 0.5, -2.0};
    const ObstacleRecord table{"table", make_box({1.0, 2.0, 0.5}), {}, {}};
    write_viewer(run_, {"obstacles", 1.0}, {table, body});

    const std::string written = page();
    const json all = meta(written);
    ASSERT_EQ(all["meshes"].size(), 2U);
    EXPECT_FALSE(all["meshes"][0].contains("poses"));
    EXPECT_EQ(all["meshes"][1]["poses"].size(), 5U);
    EXPECT_EQ(all["meshes"][1]["placements"].size(), 1U);
    unpacked(written, "arris-mesh-1", 4 * 3 * 12);  // faces, but no points
    for (const std::size_t position : {0U, 3U, 4U}) {
        const std::vector<Vec3> points = pose_points(written, 1, position);
        ASSERT_EQ(points.size(), 8U);
        for (std::size_t p = 0; p < points.size(); ++p) {
            const Vec3 own = stretched(body.mesh.points[p], static_cast<double>(position));
            EXPECT_NEAR((points[p] - body.placement(own)).norm(), 0.0, 5.0 / 65535.0) << position;
        }
    }
}

/// An obstacle whose points hardly compress.
ObstacleRecord make_noisy(int count)
{
    std::vector<Vec3> points;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    for (int i = 0; i < count; ++i) points.emplace_back(unit(random), unit(random), unit(random));
    return make_stretching("body", make_points(points));
}

TEST_F(ViewerHtml, LeavesFramesOutWhereThePointsOfObstaclesTakeTooMuch)
{
    for (int i = 0; i < 17; ++i) write_frame(frame_path(i), make_strip(3, 7U));
    // A frame's points take 6 kB.
    ViewerOptions options{"crowded", 24.0};
    const auto data_bytes = [&] {
        const std::string written = page();
        std::size_t bytes = 0;
        for (std::size_t at = 0;
             (at = written.find("<script type=\"text/plain\"", at)) != std::string::npos;) {
            at = written.find('>', at) + 1;
            bytes += (written.find('<', at) - at) / 4 * 3;
        }
        return bytes;
    };
    for (const auto& [most, stride] : {std::pair(200'000, 1), {70'000, 2}, {40'000, 4}}) {
        options.most_bytes = static_cast<std::size_t>(most);
        write_viewer(run_, options, {make_noisy(1000)});
        const json all = meta(page());
        EXPECT_EQ(all["stride"], stride);
        EXPECT_FALSE(all.contains("left_out"));
        EXPECT_EQ(all["meshes"][0]["poses"].size(), all["frames"].size());
        EXPECT_LE(data_bytes(),
                  static_cast<std::size_t>(most) + 200);  // base64 rounds each block up by 2 bytes
    }
    // Two frames' points do not fit into half the page.
    options.most_bytes = 20'000;
    write_viewer(run_, options, {make_noisy(1000)});
    EXPECT_EQ(meta(page())["left_out"], json({"body"}));
    EXPECT_EQ(meta(page())["stride"], 1);
}

TEST_F(ViewerHtml, TakesTitlesAsDataWhateverTheyHold)
{
    write_frame(frame_path(0), make_strip(1, 0));
    for (const std::string title :
         {"</script><img src=x onerror=alert(1)>", "<!--<script>", "quotes \" and \\ and\nlines",
          "Tischtuch \xc3\xbc\xe2\x82\xac", "<!-- ARRIS-DATA -->"}) {
        write_viewer(run_, {title, 24.0});
        EXPECT_EQ(meta(page())["title"], title);
        EXPECT_THAT(elements(page(), "arris-meta").at(0), testing::Not(HasSubstr("<")));
    }
    write_viewer(run_, {"broken \xff byte", 24.0});
    EXPECT_EQ(meta(page())["title"], "broken \xef\xbf\xbd byte");
}

TEST_F(ViewerHtml, GivesTheStrainsOfTheRun)
{
    Frame calm = make_strip(200, 0), wild = make_strip(200, 1);
    std::fill(calm.strain.begin(), calm.strain.end(), -0.02);
    std::fill(wild.strain.begin(), wild.strain.end(), 0.05);
    wild.strain[17] = 3.0;  // one sliver
    write_frame(frame_path(0), calm);
    write_frame(frame_path(1), wild);
    write_viewer(run_, {});
    const json strain = meta(page())["strain"];
    EXPECT_EQ(strain["least"], -0.02);
    EXPECT_EQ(strain["greatest"], 3.0);
    EXPECT_EQ(strain["typical"], 0.05);
}

TEST_F(ViewerHtml, RefusesWhatItCannotShow)
{
    EXPECT_THAT(refusal(), HasSubstr(run_ + "/frames: has no frames"));
    write_frame(frame_path(0), make_strip(2, 0));
    write_frame(frame_path(3), make_strip(2, 0));
    EXPECT_THAT(refusal(), HasSubstr(frame_path(1) + ": is missing"));

    for (const int k : {1, 2}) write_frame(frame_path(k), make_strip(2, 0));
    fs::resize_file(frame_path(2), fs::file_size(frame_path(2)) - 1);
    EXPECT_THAT(refusal(), HasSubstr(frame_path(2)));
    EXPECT_FALSE(fs::exists(page_path()));

    write_frame(frame_path(2), make_strip(0, 0));
    EXPECT_THAT(refusal(), HasSubstr(frame_path(2) + ": has no faces"));
    for (const double extent : {1e20, 1e308}) {
        Frame wide = make_strip(2, 0);
        wide.world[0].x() = extent, wide.world[1].x() = -extent;
        write_frame(frame_path(2), wide);
        EXPECT_THAT(refusal(), HasSubstr(frame_path(2) + ": a vertex is farther away"));
    }
    Frame torn = make_strip(2, 0);
    torn.strain[1] = -1e300;
    write_frame(frame_path(2), torn);
    EXPECT_THAT(refusal(), HasSubstr(frame_path(2) + ": a strain is larger"));
    write_frame(frame_path(2), make_strip(2, 0));
    for (const double rate : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
        EXPECT_THAT(refusal({"", rate}), HasSubstr("frames_per_second"));
    EXPECT_EQ(refusal(), "accepted");
}

TEST_F(ViewerHtml, TakesOnlyFramesForFrames)
{
    write_frame(frame_path(0), make_strip(2, 0));
    for (const char* name : {"cloth_00001.ply.tmp", "cloth_1.ply", "cloth_0000x.ply", "table_00001.obj",
                             "cloth_99999999999999999999.ply", "cloth_.ply", "cloth_-0001.ply"})
        std::ofstream(run_ + "/frames/" + name) << "not a frame";
    write_viewer(run_, {});
    EXPECT_EQ(meta(page())["run_frames"], 1);
}

TEST_F(ViewerHtml, KeepsTheOldPageWhereTheNewOneFails)
{
    write_frame(frame_path(0), make_strip(2, 0));
    write_viewer(run_, {"old", 24.0});
    const std::string old = page();
    std::ofstream(frame_path(1)) << "not a frame";
    EXPECT_NE(refusal({"new", 24.0}), "accepted");
    EXPECT_EQ(page(), old);

    fs::remove(frame_path(1));
    fs::remove(page_path());
    fs::create_directories(page_path() + "/in the way");
    EXPECT_THROW(write_viewer(run_, {"new", 24.0}), std::system_error);
    EXPECT_FALSE(fs::exists(page_path() + ".tmp"));
}

TEST_F(ViewerHtml, IsTheSamePageEachTime)
{
    for (int k = 0; k < 3; ++k) write_frame(frame_path(k), make_strip(50, static_cast<unsigned>(k)));
    write_viewer(run_, {"twice", 24.0});
    const std::string first = page();
    write_viewer(run_, {"twice", 24.0});
    EXPECT_EQ(page(), first);
}

TEST_F(ViewerHtml, AsksForNothingFromANetwork)
{
    write_frame(frame_path(0), make_strip(2, 0));
    write_viewer(run_, {});
    EXPECT_THAT(page(), HasSubstr("default-src 'none'"));
    for (const char* loads : {"<script src", "<link", "<iframe", "<img", "@import"})
        EXPECT_THAT(page(), testing::Not(HasSubstr(loads)));
}

}  // namespace
}  // namespace arris
