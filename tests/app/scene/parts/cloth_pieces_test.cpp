// SPDX-License-Identifier: GPL-3.0-or-later
// Several pieces of cloth, and fabrics.
#include "app/scene/parts/cloth_pieces.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "app/run/state_readings.h"
#include "app/scene/scene_load.h"
#include "geometry/input_error.h"
#include "solver/advance.h"
#include "solver/step.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RunConfig load(const std::string& text, const std::vector<std::string>& overrides = {})
{
    return load_scene(SceneSource{"s.toml", text, overrides});
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {})
{
    try {
        load(text, overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

const std::string kFlag =
    "size = [1.0, 0.5]\nresolution = [6, 3]\nfabric = \"thin\"\n"
    "rotate = { axis = [1, 0, 0], degrees = 80 }\nvelocity = [0, 0.5, 0]\n";
const std::string kCurtain =
    "size = [0.6, 0.8]\nresolution = [4, 5]\npattern = \"diagonal\"\ntranslate = [3, 0, 0]\n"
    "rotate = { axis = [0, 1, 0], degrees = 30 }\n"
    "material = { preset = \"denim\", bending_model = \"plate\", damping = 0.01, thickness = 0.002 }\n";
const std::string kFabric = "[[fabric]]\nname = \"thin\"\npreset = \"silk\"\npoisson_ratio = 0.1\n";
const std::string kPieces = "duration = 1\n[[cloth]]\nname = \"flag\"\n" + kFlag +
                            "[[cloth]]\nname = \"curtain\"\n" + kCurtain + kFabric + "[gravity]\n";

TEST(ClothPieces, LieSideBySideInThePlaneOfAllMaterial)
{
    const RunConfig config = load(kPieces + "[[pin]]\npiece = \"curtain\"\nmaterial = [[-9, 0], [9, 0]]\n" +
                                  "[[probe]]\nname = \"tip\"\npiece = \"curtain\"\nmaterial = [0.6, 0.8]\n");
    ASSERT_EQ(config.pieces.size(), 2U);
    const ClothPiece &flag = config.pieces[0], &curtain = config.pieces[1];
    EXPECT_EQ(flag.shift, 0.0);
    EXPECT_EQ(flag.end, curtain.begin);
    EXPECT_GT(curtain.shift, 1.0 + 4.0 * 0.2) << "at least four cells apart";
    const int of_flag = extract_piece(config, 0).vertex_count();
    EXPECT_EQ(config.cloth.vertex_count(), of_flag + extract_piece(config, 1).vertex_count());
    for (int v = 0; v < config.cloth.vertex_count(); ++v) {
        const Vec2& X = config.cloth.material[v];
        const bool is_curtain = v >= of_flag;
        EXPECT_EQ(config.scene.materials.piece_at(X), is_curtain ? 1 : 0);
        EXPECT_EQ(config.cloth_velocity[v], is_curtain ? Vec3(0, 0, 0) : Vec3(0, 0.5, 0));
        const Vec2 own = config.pieces[is_curtain ? 1 : 0].from_plane(X);
        EXPECT_TRUE(own.x() > -1e-12 && own.x() < (is_curtain ? 0.6 : 1.0) + 1e-12);
    }
    // A box that reaches beyond its piece holds nothing of another one.
    EXPECT_EQ(vertices_inside(config.cloth, config.scene.pins[0].material).size(), 5U);
    EXPECT_LT((config.probes[0].material - curtain.to_plane(Vec2(0.6, 0.8))).norm(), 1e-15);
    EXPECT_EQ(material_in_words(config.scene, config.probes[0].material, 6), "[0.6, 0.8] of curtain");
}

TEST(ClothPieces, HaveTheirOwnMaterial)
{
    const RunConfig config = load(kPieces);
    const Materials& materials = config.scene.materials;
    ASSERT_EQ(materials.count(), 2);
    EXPECT_EQ(materials[0].density, find_material_preset("silk")->density);
    EXPECT_EQ(materials[0].poisson_ratio, 0.1);
    EXPECT_EQ(config.pieces[0].material_key, "fabric.0");
    EXPECT_EQ(materials[1].density, find_material_preset("denim")->density);
    EXPECT_EQ(materials[1].bending_model, BendingModel::Plate);
    EXPECT_EQ(materials.thickness(), 0.002) << "the greatest";
    EXPECT_THAT(
        config.warnings,
        ElementsAre(
            "s.toml:16: cloth.1.material.thickness = 0.002: has no effect: the scene has no obstacle"));
}

TEST(ClothPieces, RubAsTheirMaterialsAndObstaclesSay)
{
    const std::string text = "duration = 1\n[self_contact]\n[[cloth]]\n" + kCurtain + "[[cloth]]\n" + kFlag +
                             "translate = [9, 9, 9]\n" + kFabric + "friction = 0.7\n" +
                             "[[obstacle]]\npoints = [[0, 0, -9]]\n[[obstacle]]\npoints = [[0, 0, -8]]\n"
                             "friction = 0.1\n";
    const Friction own = load(text).scene.friction.value();
    EXPECT_EQ(own.with_obstacle(0, 0), 0.0) << "there is no [friction]";
    EXPECT_EQ(own.with_obstacle(0, 1), 0.7);
    EXPECT_EQ(own.with_obstacle(1, 1), 0.1) << "the obstacle's own";
    EXPECT_EQ(own.between(0, 1), 0.35);
    EXPECT_EQ(own.between(1, 1), 0.7);
    const Friction common = load(text, {"friction.coefficient=0.3"}).scene.friction.value();
    EXPECT_EQ(common.with_obstacle(0, 0), 0.3);
    EXPECT_EQ(common.between(0, 1), 0.5);
    const Friction layers = load(text, {"self_contact.friction=0.2"}).scene.friction.value();
    EXPECT_EQ(layers.between(0, 1), 0.2);
}

TEST(ClothPieces, OneInAListIsTheSameAsATable)
{
    const RunConfig table = load("duration = 1\n[cloth]\n" + kFlag + kFabric);
    const RunConfig list = load("duration = 1\n[[cloth]]\n" + kFlag + kFabric);
    EXPECT_EQ(table.cloth.material, list.cloth.material);
    EXPECT_EQ(table.cloth.world, list.cloth.world);
    EXPECT_EQ(list.pieces[0].name, "piece0");
    EXPECT_FALSE(table.as_run["cloth"].contains("name"));
}

TEST(ClothPieces, AreSetByIndex)
{
    const RunConfig config = load(kPieces, {"cloth.1.resolution=[8, 10]", "fabric.0.density=0.2"});
    EXPECT_EQ(extract_piece(config, 1).vertex_count(), 9 * 11);
    EXPECT_EQ(config.scene.materials[0].density, 0.2);
}

TEST(ClothPieces, RefuseWhatContradicts)
{
    const std::string pin = "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n";
    EXPECT_EQ(
        refusal(kPieces + pin),
        "s.toml:22: pin.0.piece: is required and missing, as there are several pieces of cloth; allowed: "
        "the name of a piece: flag, curtain");
    EXPECT_EQ(
        refusal(kPieces + pin + "piece = \"shirt\"\n"),
        "s.toml:24: pin.0.piece = \"shirt\": is not a piece of cloth; allowed: the name of a piece: flag, "
        "curtain");
    EXPECT_EQ(refusal("duration = 1\n[cloth]\n" + kFlag + kFabric + pin + "piece = \"flag\"\n"),
              "s.toml:14: pin.0.piece = \"flag\": is not a piece of cloth; allowed: none, as [cloth] has no "
              "name");
    EXPECT_EQ(refusal(kPieces, {"cloth.1.fabric=thin"}),
              "--set cloth.1.fabric=thin: contradicts cloth.1.material; allowed: either a fabric or a "
              "material");
    EXPECT_EQ(refusal(kPieces, {"cloth.0.fabric=thick"}),
              "--set cloth.0.fabric=thick: is not a fabric; allowed: the name of a fabric: thin");
    EXPECT_EQ(refusal(kPieces, {"cloth.1.name=flag"}),
              "--set cloth.1.name=flag: is already the name of cloth.0; allowed: a unique name other than "
              "cloth");
    EXPECT_EQ(refusal(kPieces + kFabric),
              "s.toml:23: fabric.1.name = \"thin\": is already the name of a fabric; allowed: a name that no "
              "other fabric has");
    EXPECT_EQ(refusal("duration = 1\ncloth = []\n"),
              "s.toml:2: cloth = []: is empty; allowed: a table, [cloth], or tables, [[cloth]]");
    EXPECT_EQ(refusal("duration = 1\n[[cloth]]\nsize = [1, 1]\n"),
              "s.toml:2: cloth.0.resolution: is required and missing, as there is none of cloth.0.outline, "
              "cloth.0.panel, cloth.0.pattern_file and cloth.0.file; allowed: 2 integers from 1 to 5000000");
    EXPECT_THAT(refusal(kPieces + pin + "piece = \"curtain\"\n", {"pin.0.material=[[0.7, 0], [9, 9]]"}),
                HasSubstr("holds no vertex of the cloth; the nearest is at [0.6, "));
    EXPECT_THAT(refusal(kPieces, {"cloth.size=[1, 1]"}),
                HasSubstr("size is not an index of cloth; allowed: 0 to 2, where 2 appends"));
}

TEST(ClothPieces, AProbeBeyondItsPieceIsOnNoOther)
{
    const std::string probe = "[[probe]]\nname = \"p\"\npiece = \"flag\"\nmaterial = ";
    const RunConfig config = load(kPieces);
    const double other = config.pieces[1].shift + 0.3;  // u of the curtain's middle in the plane
    EXPECT_THAT(refusal(kPieces + probe + fmt::format("[{}, 0.4]\n", other)),
                HasSubstr("is not on the cloth"));
}

TEST(ClothPieces, AnUnusedFabricIsAWarning)
{
    EXPECT_THAT(
        load("duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[gravity]\n" + kFabric).warnings,
        ElementsAre("s.toml:6: fabric.0: has no effect: no piece of cloth is made of it"));
}

/// Positions of the probes at the start and after 60 steps.
std::array<std::vector<Vec3>, 2> probe(const std::string& text)
{
    const RunConfig config = load(text);
    State state = make_state(config.scene, config.cloth, config.cloth_velocity);
    Workspace work;
    std::array<std::vector<Vec3>, 2> places;
    for (const ProbeSample& sample : sample_probes(config.probes, state))
        places[0].push_back(sample.position);
    for (int k = 1; k <= 60; ++k)
        EXPECT_FALSE(advance(config.scene, config.settings, 0.005 * k, state, work,
                             [](const StepReport&, bool) { return true; }));
    for (const ProbeSample& sample : sample_probes(config.probes, state))
        places[1].push_back(sample.position);
    return places;
}

/// Cloth that slips over an edge, where the mesh changes at every step, beside cloth that is held far away.
TEST(ClothPieces, DrapeByTheirOwnMaterialWhereTheMeshChanges)
{
    const auto end_of = [](const std::string& far_away) {
        const auto [start, end] = probe(
            "duration = 1\n[[cloth]]\nname = \"far\"\nsize = [0.6, 0.5]\nresolution = [12, 10]\n"
            "translate = [50, 0, 0]\nmaterial = { " +
            far_away +
            " }\n[[cloth]]\nname = \"near\"\nsize = [0.6, 0.5]\nresolution = [12, 10]\n"
            "translate = [-0.2, -0.25, 0.0011]\n[gravity]\n"
            "[[obstacle]]\nbox = [0.5, 1, 1]\ntranslate = [0, 0, -0.5]\n"
            "[[pin]]\npiece = \"far\"\nmaterial = [[0, 0], [0.6, 0.5]]\n"
            "[[probe]]\nname = \"p\"\npiece = \"near\"\nmaterial = [0.6, 0.25]\n");
        EXPECT_GT((end[0] - start[0]).norm(), 0.1);
        return end[0];
    };
    const Vec3 same = end_of("preset = \"cotton\""),
               stiff = end_of("youngs_modulus = 5e5, bending_stiffness = 0.01, damping = 0.01");
    EXPECT_LT((same - stiff).norm(), 1e-9);
}

/// Pins along one side and probes all over a piece.
std::string hold_and_probe(const std::string& name, double width, double height)
{
    std::string text = "[[pin]]\npiece = \"" + name + "\"\nmaterial = [[0, 0], [0, 1]]\n";
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            text += fmt::format("[[probe]]\nname = \"{0}{1}{2}\"\npiece = \"{0}\"\nmaterial = [{3}, {4}]\n",
                                name, i, j, width * i / 3.0, height * j / 3.0);
    return text;
}

/// Distance by which the probes on two pieces differ from those on each alone, and that by which they move.
std::array<double, 2> compare_with_each_alone(const std::string& effects)
{
    const std::string flag = "[[cloth]]\nname = \"flag\"\n" + kFlag,
                      curtain = "[[cloth]]\nname = \"curtain\"\n" + kCurtain;
    const std::string head = "duration = 1\n", tail = "[gravity]\n" + effects;
    const std::string on_flag = hold_and_probe("flag", 1.0, 0.5),
                      on_curtain = hold_and_probe("curtain", 0.6, 0.8);
    const auto [start, together] = probe(head + flag + curtain + kFabric + tail + on_flag + on_curtain);
    std::vector<Vec3> each = probe(head + flag + kFabric + tail + on_flag)[1];
    const std::vector<Vec3> other = probe(head + curtain + tail + on_curtain)[1];
    each.insert(each.end(), other.begin(), other.end());
    EXPECT_EQ(together.size(), each.size());
    double off = 0.0, way = 0.0;
    for (std::size_t k = 0; k < each.size(); ++k) {
        off = std::max(off, (together[k] - each[k]).norm());
        way = std::max(way, (together[k] - start[k]).norm());
    }
    return {off, way};
}

/// Cloth that does not meet other cloth moves as if it were alone: every material is where it belongs.
TEST(ClothPieces, MoveAsEachAlone)
{
    const auto [off, way] = compare_with_each_alone("[wind]\nvelocity = [1, 2, 0]\n");
    EXPECT_LT(off, 1e-10);
    EXPECT_GT(way, 0.1);
}

}  // namespace
}  // namespace arris
