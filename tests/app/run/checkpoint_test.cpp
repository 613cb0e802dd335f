// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/checkpoint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/input_error.h"
#include "solver/step.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

Checkpoint make_checkpoint()
{
    Checkpoint checkpoint;
    checkpoint.source = {"/somewhere/scene.toml", "title = \"é\"\n", {"time.step=0.001", "title=x"}};
    checkpoint.warnings = {"a warning"};
    checkpoint.kernel = "Haswell";
    ClothGrid grid;
    grid.resolution = {3, 2};
    checkpoint.state = make_state(Scene{}, make_cloth_grid(grid), Vec3(1, -0.0, 1e-310));
    checkpoint.state.time = 0.1;
    checkpoint.state.step = 17;
    checkpoint.state.previous_dt = 0.005;
    checkpoint.state.active = {{{2, 5}, ContactKind::Edge, 0, 3, Vec3::UnitX(), 0.1, {}, true},
                               {{2}, ContactKind::Vertex, 1, 7, Vec3::UnitZ(), 1e-7}};
    checkpoint.state.eol = {{1, FeatureId::bend(0, 4, 1), Vec3::UnitZ(), 0, 0},
                            {5, FeatureId::corner(1, 2), Vec3::UnitX(), 2, -1}};
    checkpoint.state.material_velocity[1] = Vec2(0.25, -1e-310);
    checkpoint.state.refused_edges = {{{1, 5}, 2, 24}, {{2, 3}, 1, 20}};
    checkpoint.state.crossings = 3;
    checkpoint.position = {0.0625, 3};
    checkpoint.frames = 4;
    checkpoint.rows = 18;
    checkpoint.strain.stretch = {0.25, 0.05, Vec3(1, 2, -0.0), Vec2(0.5, 1e-310)};
    checkpoint.strain.compression = {-0.5, 0.1, Vec3(4, 5, 6), Vec2(1, 2)};
    checkpoint.strain.in_plane = {-0.0625, 0.1, Vec3(7, 8, 9), Vec2(3, 4)};
    checkpoint.strain.plane_rows = 11;
    checkpoint.strain.last_stretch = {0.125, 0.1, Vec3(1, 0, 2), Vec2(6, 5)};
    checkpoint.strain.last_compression = {-0.375, 0.1, Vec3(0, 1, 2), Vec2(8, 7)};
    checkpoint.friction = {0.375, 0.15, Vec3(-1, 1e-310, 2), 5};
    return checkpoint;
}

std::string refusal(const std::string& path)
{
    try {
        read_checkpoint(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Checkpoint, ReadsBackToTheSameBytes)
{
    const TemporaryDirectory folder;
    const std::string path = folder / "checkpoint";
    write_checkpoint(path, make_checkpoint());
    const Checkpoint read = read_checkpoint(path);
    EXPECT_EQ(read.source.overrides, make_checkpoint().source.overrides);
    EXPECT_EQ(read.state.active[0].multiplier, 0.1);
    EXPECT_EQ(read.state.active[0].kind, ContactKind::Edge);
    EXPECT_EQ(read.state.active[0].element, 3);
    EXPECT_EQ(read.state.active[0].normal, Vec3::UnitX());
    EXPECT_TRUE(read.state.active[0].is_squeezed);
    EXPECT_EQ(read.state.active[1].obstacle, 1);
    EXPECT_FALSE(read.state.active[1].is_squeezed);
    ASSERT_EQ(read.state.refused_edges.size(), 2u);
    EXPECT_EQ(read.state.refused_edges[0].vertex_ids[1], 5u);
    EXPECT_EQ(read.state.refused_edges[0].refusals, 2);
    EXPECT_EQ(read.state.refused_edges[1].until, 20);
    EXPECT_EQ(read.state.eol[1].vertex_id, 5u);
    EXPECT_TRUE(read.state.eol[1].on.is_corner());
    EXPECT_EQ(read.state.eol[1].on.index, 2);
    EXPECT_EQ(read.state.eol[1].idle, 2);
    EXPECT_EQ(read.state.eol[1].side, -1);
    EXPECT_EQ(read.state.eol[0].on.end, 1);
    EXPECT_EQ(read.state.eol[1].on.end, -1);
    EXPECT_EQ(read.state.eol[0].outward, Vec3::UnitZ());
    EXPECT_EQ(read.state.material_velocity[1], Vec2(0.25, -1e-310));
    EXPECT_EQ(read.state.crossings, 3);
    EXPECT_EQ(read.position.done, 3);
    EXPECT_EQ(read.strain.stretch.material, Vec2(0.5, 1e-310));
    EXPECT_EQ(read.strain.compression.strain, -0.5);
    EXPECT_EQ(read.strain.in_plane.world, Vec3(7, 8, 9));
    EXPECT_EQ(read.strain.plane_rows, 11);
    EXPECT_EQ(read.strain.last_stretch.material, Vec2(6, 5));
    EXPECT_EQ(read.strain.last_compression.strain, -0.375);
    EXPECT_EQ(read.friction.residual, 0.375);
    EXPECT_EQ(read.friction.time, 0.15);
    EXPECT_EQ(read.friction.world, Vec3(-1, 1e-310, 2));
    EXPECT_EQ(read.friction.rows, 5);
    write_checkpoint(path + "2", read);
    EXPECT_EQ(read_bytes(path), read_bytes(path + "2"));
}

TEST(Checkpoint, EveryTruncationAndEveryFlippedByteIsOneInputError)
{
    const TemporaryDirectory folder;
    const std::string path = folder / "checkpoint";
    write_checkpoint(path, make_checkpoint());
    const std::string whole = read_bytes(path);
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 40) {
        write_bytes(path, whole.substr(0, length));
        EXPECT_NE(refusal(path), "") << length;
    }
    for (std::size_t k = 0; k < whole.size(); k += 1 + k / 40) {
        std::string damaged = whole;
        damaged[k] = static_cast<char>(damaged[k] ^ 0x81);
        write_bytes(path, damaged);
        EXPECT_NE(refusal(path).find(path), std::string::npos) << k;
    }
    write_bytes(path, whole + "x");
    EXPECT_NE(refusal(path), "");
}

TEST(Checkpoint, AnotherVersionIsNamed)
{
    const TemporaryDirectory folder;
    const std::string path = folder / "checkpoint";
    write_checkpoint(path, make_checkpoint());
    std::string bytes = read_bytes(path);
    const std::size_t at = bytes.find("0.1.0");
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, 5, "9.8.7");
    write_bytes(path, bytes);
    EXPECT_NE(refusal(path).find("9.8.7"), std::string::npos) << refusal(path);
}

TEST(Checkpoint, AStateThatCannotBeIsRefused)
{
    const TemporaryDirectory folder;
    const std::string path = folder / "checkpoint";
    const auto refused = [&](const char* what, const auto& damage) {
        Checkpoint checkpoint = make_checkpoint();
        damage(checkpoint);
        write_checkpoint(path, checkpoint);
        EXPECT_NE(refusal(path).find("damaged"), std::string::npos) << what;
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    refused("face index", [](Checkpoint& c) { c.state.mesh.faces[0][1] = 1000; });
    refused("negative face index", [](Checkpoint& c) { c.state.mesh.faces[0][1] = -1; });
    refused("position", [&](Checkpoint& c) { c.state.mesh.world[3].y() = kNan; });
    refused("velocity", [&](Checkpoint& c) { c.state.velocity[3].y() = kNan; });
    refused("history", [&](Checkpoint& c) { c.state.previous_world[0].x() = INFINITY; });
    refused("ids", [](Checkpoint& c) { std::swap(c.state.ids[0], c.state.ids[1]); });
    refused("lengths", [](Checkpoint& c) { c.state.velocity.pop_back(); });
    refused("orientation",
            [](Checkpoint& c) { std::swap(c.state.mesh.faces[0][1], c.state.mesh.faces[0][2]); });
    refused("time", [&](Checkpoint& c) { c.state.time = kNan; });
    refused("previous step", [&](Checkpoint& c) { c.state.previous_dt = -1.0; });
    refused("rows", [](Checkpoint& c) { c.rows = 0; });
    refused("contacts", [](Checkpoint& c) { std::swap(c.state.active[0], c.state.active[1]); });
    refused("contact", [](Checkpoint& c) { c.state.active[0].vertex_ids[1] = 99; });
    refused("kind", [](Checkpoint& c) { c.state.active[0].kind = static_cast<ContactKind>(-1); });
    refused("normal", [&](Checkpoint& c) { c.state.active[1].normal.z() = kNan; });
    refused("material velocity", [&](Checkpoint& c) { c.state.material_velocity[2].x() = kNan; });
    refused("material history", [](Checkpoint& c) { c.state.previous_material.pop_back(); });
    refused("EOL order", [](Checkpoint& c) { std::swap(c.state.eol[0], c.state.eol[1]); });
    refused("EOL vertex", [](Checkpoint& c) { c.state.eol[1].vertex_id = 99; });
    refused("EOL direction", [&](Checkpoint& c) { c.state.eol[0].outward.x() = kNan; });
    refused("EOL side", [](Checkpoint& c) { c.state.eol[0].side = 2; });
    refused("EOL end", [](Checkpoint& c) { c.state.eol[0].on.end = 2; });
    refused("EOL kind", [](Checkpoint& c) { c.state.eol[0].on.kind = static_cast<FeatureId::Kind>(3); });
    refused("EOL bend without an end", [](Checkpoint& c) { c.state.eol[0].on.end = -1; });
    refused("EOL end of a corner", [](Checkpoint& c) { c.state.eol[1].on.end = 0; });
    refused("EOL count", [](Checkpoint& c) { c.state.eol[0].idle = -1; });
    refused("refused edges",
            [](Checkpoint& c) { std::swap(c.state.refused_edges[0], c.state.refused_edges[1]); });
    refused("refused edge", [](Checkpoint& c) { c.state.refused_edges[1].vertex_ids[1] = 99; });
    refused("refusals", [](Checkpoint& c) { c.state.refused_edges[0].refusals = 0; });
    refused("strain", [&](Checkpoint& c) { c.strain.stretch.strain = kNan; });
    refused("place of a strain", [&](Checkpoint& c) { c.strain.in_plane.world.z() = INFINITY; });
    refused("rows of plane cloth", [](Checkpoint& c) { c.strain.plane_rows = -1; });
    refused("strain of the last row", [&](Checkpoint& c) { c.strain.last_compression.strain = kNan; });
    refused("friction", [&](Checkpoint& c) { c.friction.residual = kNan; });
    refused("place of friction", [&](Checkpoint& c) { c.friction.world.x() = INFINITY; });
    refused("rows of friction", [](Checkpoint& c) { c.friction.rows = -1; });
    refused("crossings", [](Checkpoint& c) { c.state.crossings = -1; });
}

TEST(Checkpoint, AMissingOneOrAFolderIsOneInputError)
{
    const TemporaryDirectory folder;
    EXPECT_NE(refusal(folder / "checkpoint").find("no checkpoint"), std::string::npos);
    EXPECT_NE(refusal(folder.path()).find("no checkpoint"), std::string::npos);
    EXPECT_NE(refusal("/dev/zero").find("no checkpoint"), std::string::npos);
}

}  // namespace
}  // namespace arris
