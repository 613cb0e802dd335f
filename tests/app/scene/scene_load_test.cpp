// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/run_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "app/scene/scene_load.h"
#include "geometry/input_error.h"
#include "solver/step.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

constexpr double kRoundOff = 1e-14;  // of coordinates about 1
constexpr double kNever = std::numeric_limits<double>::infinity();

const std::string kBase = "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n";
const std::string kFileCloth = "duration = 1\n[cloth]\nfile = \"cloth.obj\"\n";

RunConfig load(const std::string& text, const std::vector<std::string>& overrides = {})
{
    return load_scene(SceneSource{"s.toml", text, overrides});
}

std::string refusal(const std::string& path)
{
    try {
        load_scene(path, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

/// Every key of the documented example that this version has.
constexpr const char* kWholeScene = R"(
title    = "Tablecloth"
duration = 2.0
[time]
step       = 0.01
integrator = "implicit_euler"
[cloth]
size       = [1.0, 0.5]
resolution = [3, 2]
pattern    = "diagonal"
pattern_angle = 0.0
folds      = [ { line = [[0.6, 0.0], [0.6, 0.5]], degrees = 90 } ]
translate  = [0.0, 0.0, 0.5]
rotate     = { axis = [0, 0, 2], degrees = 90 }
scale      = 2.0
velocity   = [0.1, 0.2, 0.3]
[cloth.material]
preset            = "cotton"
density           = 0.16
youngs_modulus    = 600.0
poisson_ratio     = 0.2
bending_stiffness = 2e-5
bending_model     = "plate"
damping           = 0.01
thickness         = 2e-3
compression_modulus = 3e4
[[pin]]
material = [[0.0, 0.0], [0.0, 0.5]]
velocity = [1.0, 2.0, 3.0]
angular_velocity = [0.0, 0.0, 1.0]
pivot    = [4.0, 5.0, 6.0]
directions = ["z", "x"]
release  = 1.5
[[pin]]
material = [[1.0, 0.0], [1.0, 0.0]]
keyframes = [ { time = 0.0 }, { time = 1, translate = [0, 0, 1], rotate = { axis = [1, 0, 0], degrees = 90 } } ]
[gravity]
acceleration = [0.0, 0.0, -1.6]
[wind]
velocity = [3.0, 0.0, 0.0]
air_density = 1.1
drag = 0.9
gust = { amplitude = 0.3, frequency = 0.5, seed = 7 }
[[pull]]
material = [[1.0, 0.0], [1.0, 0.5]]
force    = [0.0, 0.0, -1.0]
start    = 0.25
stop     = 0.75
[eol]
enabled = false
[[probe]]
name     = "tip"
material = [1.0, 0.25]
[solver]
tolerance = 1e-8
kernel    = "exact"
[output]
frames_per_second = 30
formats = ["obj", "usd", "viewer"]
)";

TEST(SceneLoad, TakesEveryKeyToItsPlace)
{
    const RunConfig config = load(kWholeScene);
    EXPECT_EQ(config.title, "Tablecloth");
    EXPECT_EQ(config.duration, 2.0);
    EXPECT_EQ(config.settings.step, 0.01);
    EXPECT_EQ(config.settings.integrator, Integrator::ImplicitEuler);
    EXPECT_EQ(config.settings.tolerance, 1e-8);
    EXPECT_EQ(config.cloth_velocity, std::vector<Vec3>(config.cloth.world.size(), Vec3(0.1, 0.2, 0.3)));

    const Material& material = config.scene.materials[0];
    EXPECT_EQ(material.density, 0.16);
    EXPECT_EQ(material.youngs_modulus, 600.0);
    EXPECT_EQ(material.poisson_ratio, 0.2);
    EXPECT_EQ(material.bending_stiffness, 2e-5);
    EXPECT_EQ(material.bending_model, BendingModel::Plate);
    EXPECT_EQ(material.damping, 0.01);
    EXPECT_EQ(material.thickness, 2e-3);
    EXPECT_EQ(material.compression_modulus, 3e4);

    ASSERT_TRUE(config.scene.gravity);
    EXPECT_EQ(config.scene.gravity->acceleration, Vec3(0.0, 0.0, -1.6));
    ASSERT_TRUE(config.scene.wind && config.scene.wind->gust);
    EXPECT_EQ(config.scene.wind->velocity, Vec3(3.0, 0.0, 0.0));
    EXPECT_EQ(config.scene.wind->air_density, 1.1);
    EXPECT_EQ(config.scene.wind->drag, 0.9);
    EXPECT_EQ(config.scene.wind->gust->amplitude, 0.3);
    EXPECT_EQ(config.scene.wind->gust->frequency, 0.5);
    EXPECT_EQ(config.scene.wind->gust->seed, 7);

    ASSERT_EQ(config.scene.pulls.size(), 1u);
    EXPECT_EQ(config.scene.pulls[0].material.min, Vec2(1.0, 0.0));
    EXPECT_EQ(config.scene.pulls[0].material.max, Vec2(1.0, 0.5));
    EXPECT_EQ(config.scene.pulls[0].force, Vec3(0.0, 0.0, -1.0));
    EXPECT_EQ(config.scene.pulls[0].start, 0.25);
    EXPECT_EQ(config.scene.pulls[0].stop, 0.75);

    ASSERT_EQ(config.probes.size(), 1u);
    EXPECT_EQ(config.probes[0].name, "tip");
    EXPECT_EQ(config.probes[0].material, Vec2(1.0, 0.25));
    EXPECT_EQ(config.output.frames_per_second, 30.0);
    EXPECT_THAT(config.output.formats, ElementsAre("obj", "usd", "viewer"));
}

TEST(SceneLoad, APinsMotionStartsWithThePin)
{
    const RunConfig config = load(kWholeScene, {"pin.0.start=0.5", "pin.1.start=0.5"});
    EXPECT_EQ(config.scene.pins[0].start, 0.5);
    EXPECT_EQ(config.scene.pins[0].motion.start, 0.5);
    EXPECT_EQ(config.scene.pins[1].motion.keyframes[0].time,
              load(kWholeScene).scene.pins[1].motion.keyframes[0].time)
        << "keyframes have absolute times";
}

TEST(SceneLoad, PinsVerticesByTheirNumbers)
{
    const RunConfig grid = load(kBase + "[[pin]]\nvertices = [3, 0]\n");
    EXPECT_THAT(vertices_inside(grid.cloth, grid.scene.pins[0].material), ElementsAre(0, 3));
    EXPECT_FALSE(grid.as_run["pin"][0].contains("material"));

    const TemporaryDirectory folder;
    std::ofstream(folder / "cloth.obj") << "v 1 0 0\nv 0 0 0\nv 9 9 9\nv 0 1 0\nv 1 1 0\nf 2 1 5\nf 2 5 4\n";
    const auto load_file = [&](const std::string& vertices) {
        return load_scene(SceneSource{folder / "s.toml",
                                      "duration = 1\n[[cloth]]\nsize = [1, 1]\nresolution = [1, 1]\n"
                                      "[[cloth]]\nname = \"own\"\nfile = \"cloth.obj\"\n"
                                      "[[pin]]\npiece = \"own\"\nvertices = " +
                                          vertices + "\n",
                                      {}});
    };
    const RunConfig config = load_file("[0, 4]");
    std::vector<Vec3> held;
    for (const int v : vertices_inside(config.cloth, config.scene.pins[0].material))
        held.push_back(config.cloth.world[static_cast<std::size_t>(v)]);
    EXPECT_THAT(held, UnorderedElementsAre(Vec3(1, 0, 0), Vec3(1, 1, 0)));
    for (const char* wrong : {"[0, 5]", "[2]"})
        EXPECT_THAT(error_of([&] { load_file(wrong); }), HasSubstr("pin.0.vertices.")) << wrong;
}

TEST(SceneLoad, GivesPinsTheirMotion)
{
    const RunConfig config = load(kWholeScene);
    ASSERT_EQ(config.scene.pins.size(), 2u);
    const Pin& moved = config.scene.pins[0];
    EXPECT_EQ(moved.motion.velocity, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(moved.motion.angular_velocity, Vec3(0.0, 0.0, 1.0));
    EXPECT_EQ(moved.motion.pivot, Vec3(4.0, 5.0, 6.0));
    EXPECT_THAT(moved.held, ElementsAre(true, false, true));
    EXPECT_EQ(moved.release, 1.5);

    const Pin& keyed = config.scene.pins[1];
    EXPECT_THAT(keyed.held, ElementsAre(true, true, true));
    EXPECT_EQ(keyed.release, kNever);
    ASSERT_EQ(keyed.motion.keyframes.size(), 2u);
    const Placement last = keyed.motion.at(1.0);
    EXPECT_NEAR((last(Vec3(0.0, 1.0, 0.0)) - Vec3(0.0, 0.0, 2.0)).norm(), 0.0, kRoundOff);
}

TEST(SceneLoad, PlacesAScaledTurnedFoldedRectangle)
{
    // (u, v) folded about u = 0.6: what is right of the line towards +v, u > 0.6, hangs down.
    const RunConfig config = load(kWholeScene);
    int on_fold = 0;
    for (int i = 0; i < config.cloth.vertex_count(); ++i) {
        const Vec2& X = config.cloth.material[i];
        if (std::abs(X.x() - 0.6) < kRoundOff) ++on_fold;
        const Vec3 folded(std::min(X.x(), 0.6), X.y(), -std::max(X.x() - 0.6, 0.0));
        const Vec3 expected(-2.0 * folded.y(), 2.0 * folded.x(), 0.5 + 2.0 * folded.z());
        EXPECT_NEAR((config.cloth.world[i] - expected).norm(), 0.0, 4.0 * kRoundOff) << X.transpose();
    }
    EXPECT_GE(on_fold, 3);
}

TEST(SceneLoad, WritesOutWhatTheSceneLeavesToDefaults)
{
    const RunConfig config =
        load(kBase +
             "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n[gravity]\n[wind]\nvelocity = [1, 0, 0]\n"
             "[[pull]]\nmaterial = [[1, 0], [1, 1]]\nforce = [0, 0, 1]\n");
    const auto expected = nlohmann::ordered_json::parse(R"({
        "title": "s", "duration": 1.0,
        "time": {"step": 0.005, "integrator": "bdf2"},
        "cloth": {
            "size": [1.0, 1.0], "resolution": [2, 2], "pattern": "cross", "pattern_angle": 0.0,
            "translate": [0.0, 0.0, 0.0], "rotate": {"axis": [0.0, 0.0, 1.0], "degrees": 0.0}, "scale": 1.0,
            "velocity": [0.0, 0.0, 0.0],
            "material": {"preset": "cotton", "density": 0.15, "youngs_modulus": 500.0, "poisson_ratio": 0.3,
                         "bending_stiffness": 1e-5, "bending_model": "hinge", "damping": 0.0,
                         "thickness": 0.001, "compression_modulus": 10000.0}},
        "pin": [{"material": [[0.0, 0.0], [0.0, 1.0]], "velocity": [0.0, 0.0, 0.0],
                 "angular_velocity": [0.0, 0.0, 0.0], "pivot": [0.0, 0.0, 0.0],
                 "directions": ["x", "y", "z"], "start": 0.0, "release": null}],
        "gravity": {"acceleration": [0.0, 0.0, -9.81]},
        "wind": {"velocity": [1.0, 0.0, 0.0], "air_density": 1.2, "drag": 1.0},
        "pull": [{"material": [[1.0, 0.0], [1.0, 1.0]], "force": [0.0, 0.0, 1.0], "start": 0.0, "stop": null}],
        "eol": {"enabled": true},
        "solver": {"tolerance": 1e-9, "kernel": "exact"},
        "output": {"frames_per_second": 24.0, "formats": ["viewer"]}})");
    EXPECT_EQ(config.as_run.dump(2), expected.dump(2));
    EXPECT_THAT(config.warnings, IsEmpty());
}

TEST(SceneLoad, SimulatesWhatAsRunSays)
{
    // The defaults in as_run are those that were loaded: the same scene, every key written, is the same run.
    const RunConfig config = load(kBase + "[gravity]\n");
    EXPECT_EQ(config.settings.step, 0.005);
    EXPECT_EQ(config.settings.tolerance, 1e-9);
    EXPECT_EQ(config.settings.integrator, Integrator::Bdf2);
    EXPECT_EQ(config.scene.materials[0].density, 0.15);
    EXPECT_EQ(config.scene.materials[0].youngs_modulus, 500.0);
    EXPECT_EQ(config.scene.materials.thickness(), 1e-3);
    EXPECT_EQ(config.scene.gravity->acceleration, Vec3(0.0, 0.0, -9.81));
    EXPECT_EQ(config.output.frames_per_second, 24.0);
    EXPECT_EQ(config.cloth.vertex_count(), 13);
    EXPECT_EQ(config.cloth.face_count(), 16);
}

TEST(SceneLoad, LeavesOutEffectsWithoutTheirTable)
{
    const RunConfig config = load(kBase);
    EXPECT_FALSE(config.scene.gravity);
    EXPECT_FALSE(config.scene.wind);
    EXPECT_THAT(config.scene.pulls, IsEmpty());
    EXPECT_THAT(config.scene.pins, IsEmpty());
    EXPECT_THAT(config.probes, IsEmpty());
    for (const char* absent :
         {"gravity", "wind", "pull", "pin", "probe", "friction", "remesh", "obstacle", "self_contact"})
        EXPECT_FALSE(config.as_run.contains(absent)) << absent;
}

TEST(SceneLoad, WritesOutWhatContactBetweenLayersTakesFromOtherTables)
{
    const std::string thick = kBase + "[cloth.material]\nthickness = 0.002\n[self_contact]\n";
    const RunConfig plain = load(thick);
    EXPECT_EQ(plain.as_run["self_contact"].dump(), "{\"start\":\"clear\",\"thickness\":0.002}");
    EXPECT_EQ(plain.scene.self_contact.value().thickness, 0.002);
    EXPECT_FALSE(plain.scene.friction);

    const RunConfig rough = load(thick + "[friction]\ncoefficient = 0.4\n");
    EXPECT_EQ(rough.as_run["self_contact"].dump(),
              "{\"start\":\"clear\",\"thickness\":0.002,\"friction\":0.4}");
    EXPECT_EQ(rough.scene.friction.value().between_layers, 0.4);

    const RunConfig own = load(thick + "thickness = 0.003\nfriction = 0.1\n[friction]\ncoefficient = 0.4\n");
    EXPECT_EQ(own.as_run["self_contact"].dump(),
              "{\"thickness\":0.003,\"friction\":0.1,\"start\":\"clear\"}");
    EXPECT_EQ(own.scene.self_contact.value().thickness, 0.003);
    EXPECT_EQ(own.scene.friction.value().between_layers, 0.1);
}

TEST(SceneLoad, OverridesThePresetKeyByKey)
{
    const RunConfig config = load(kBase + "[cloth.material]\npreset = \"denim\"\ndensity = 0.3\n");
    const Material denim = find_material_preset("denim").value();
    EXPECT_EQ(config.scene.materials[0].density, 0.3);
    EXPECT_EQ(config.scene.materials[0].youngs_modulus, denim.youngs_modulus);
    EXPECT_EQ(config.scene.materials[0].bending_stiffness, denim.bending_stiffness);
    EXPECT_EQ(config.scene.materials[0].bending_model, BendingModel::Hinge);
    EXPECT_EQ(config.as_run["cloth"]["material"]["youngs_modulus"], denim.youngs_modulus);
}

TEST(SceneLoad, TakesIntegersWhereNumbersAreExpected)
{
    const RunConfig config =
        load("duration = 2\n[cloth]\nsize = [1, 2]\nresolution = [1, 1]\ntranslate = [1, -2, 0x10]\n");
    EXPECT_EQ(config.duration, 2.0);
    EXPECT_TRUE(config.as_run["duration"].is_number_float());
    EXPECT_EQ(config.as_run["cloth"]["translate"].dump(), "[1.0,-2.0,16.0]");
}

TEST(SceneLoad, TakesTablesInEveryFormTomlHas)
{
    const std::string dotted =
        "duration = 1\ncloth.size = [1, 1]\ncloth.resolution = [2, 2]\ncloth.material.density = 1\n"
        "pin = [ { material = [[0, 0], [0, 1]] } ]\ngravity = {}\n";
    const std::string headers =
        "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[cloth.material]\ndensity = 1\n"
        "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n[gravity]\n";
    EXPECT_EQ(load(dotted).as_run, load(headers).as_run);
    EXPECT_EQ(load("\xef\xbb\xbf" + headers).as_run, load(headers).as_run);
}

TEST(SceneLoad, WarnsOfVerticesThatTheirFirstKeyframeMoves)
{
    const std::string keyframes =
        "[[pin]]\nmaterial = [[0, 0], [0, 1]]\ndirections = [\"x\", \"z\"]\n"
        "keyframes = [ { time = 0.5, translate = [0, 7, 1], rotate = { axis = [0, 0, 1], "
        "degrees = 90 } } ]\n";
    const RunConfig config = load(kBase + keyframes);
    const ClothMesh start = make_state(config.scene, config.cloth, Vec3::Zero()).mesh;
    for (int i = 0; i < config.cloth.vertex_count(); ++i) {
        const Vec2& X = config.cloth.material[i];
        // Held components of (0, 7, 1) + R (0, v, 0), R turning y to -x; y is not held.
        const Vec3 expected = X.x() > 0.0 ? Vec3(X.x(), X.y(), 0.0) : Vec3(-X.y(), X.y(), 1.0);
        EXPECT_NEAR((start.world[i] - expected).norm(), 0.0, kRoundOff);
    }
    EXPECT_THAT(config.warnings,
                ElementsAre(AllOf(HasSubstr("s.toml:8: pin.0.keyframes"), HasSubstr("moves 3 vertices"))));
}

TEST(SceneLoad, LetsTheLastOfOverlappingPinsPlaceTheirVertices)
{
    const std::string pin =
        "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = [ { time = 0, translate = [0, 0, ";
    const RunConfig config = load(kBase + pin + "1] } ]\n" + pin + "2] } ]\n");
    EXPECT_EQ(make_state(config.scene, config.cloth, Vec3::Zero()).mesh.world[0].z(), 2.0);
}

TEST(SceneLoad, DoesNotMoveVerticesToAnIdentityKeyframe)
{
    const RunConfig config =
        load(kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = [ { time = 0 } ]\n[gravity]\n");
    EXPECT_THAT(config.warnings, IsEmpty());
    EXPECT_EQ(config.cloth.world[0], Vec3(0.0, 0.0, 0.0));
}

// A frame: a square with a square hole.
const std::string kFrameCloth =
    "duration = 1\n[cloth]\noutline = [[0, 0], [0, 1], [1, 1], [1, 0]]\n"
    "holes = [[[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6]]]\nedge_length = 0.1\n";

double material_area(const ClothMesh& mesh)
{
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.faces)
        area += 0.5 * twice_area(mesh.material[a], mesh.material[b], mesh.material[c]);
    return area;
}

TEST(SceneLoad, MeshesFoldsAndPlacesAnOutline)
{
    const RunConfig config =
        load(kFrameCloth +
             "folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = 90 } ]\n"
             "scale = 2.0\ntranslate = [1, 2, 3]\n[[pin]]\nmaterial = [[0, 0], [0, 1]]\n");
    EXPECT_THAT(config.notes, IsEmpty());
    EXPECT_NEAR(material_area(config.cloth), 0.96, kRoundOff);
    for (int v = 0; v < config.cloth.vertex_count(); ++v) {
        const Vec2& X = config.cloth.material[v];
        // The line points to +v, so the material with u > 0.5 is turned down.
        const Vec3 folded = X.x() > 0.5 ? Vec3(0.5, X.y(), 0.5 - X.x()) : Vec3(X.x(), X.y(), 0.0);
        EXPECT_NEAR((config.cloth.world[v] - (2.0 * folded + Vec3(1, 2, 3))).norm(), 0.0, 10 * kRoundOff);
    }
    EXPECT_FALSE(config.as_run["cloth"].contains("pattern"));
    EXPECT_EQ(config.as_run["cloth"]["holes"][0][2][0], 0.6);
}

TEST(SceneLoad, TellsHowFarAnOutlineIsCoarsened)
{
    std::string corners;
    for (int k = 0; k < 100; ++k)
        corners += std::to_string(std::cos(0.02 * std::numbers::pi * k)) + "," +
                   std::to_string(std::sin(0.02 * std::numbers::pi * k)) + "],[";
    corners.resize(corners.size() - 3);
    const std::string disc =
        "duration = 1\n[gravity]\n[cloth]\noutline = [[" + corners + "]]\nedge_length = ";
    const RunConfig fine = load(disc + "0.126\n");
    EXPECT_THAT(fine.notes, ElementsAre(HasSubstr("50 of 100 corners are left out, as they are finer than "
                                                  "cloth.edge_length; this changes the area by -0.2 %")));
    EXPECT_THAT(fine.warnings, IsEmpty());

    // A polygon of 13 corners: its area is 13 / (2 pi) sin(2 pi / 13) = 0.962 of the circle's.
    const RunConfig coarse = load(disc + "0.5\n");
    EXPECT_THAT(coarse.notes, IsEmpty());
    EXPECT_THAT(coarse.warnings,
                ElementsAre(HasSubstr("87 of 100 corners are left out, as they are finer than "
                                      "cloth.edge_length; this changes the area by -3.8 %")));
}

TEST(SceneLoad, FindsClothFilesBesideTheScene)
{
    const TemporaryDirectory directory;
    write_bytes(directory / "cloth.obj",
                "v 0 0 0\nv 100 0 0\nv 0 50 0\nvt 0 0\nvt 1 0\nvt 0 0.5\nf 1/1 2/2 3/3\n");
    write_bytes(directory / "s.toml", kFileCloth +
                                          "units = \"cm\"\ntranslate = [0, 0, 3]\nscale = 2\n"
                                          "[cloth.material]\nbending_stiffness = 0\n");
    const RunConfig config = load_scene(directory / "s.toml", {});
    ASSERT_EQ(config.cloth.vertex_count(), 3);
    EXPECT_NEAR((config.cloth.world[1] - Vec3(2.0, 0.0, 3.0)).norm(), 0.0, kRoundOff);
    EXPECT_NEAR((config.cloth.world[2] - Vec3(0.0, 1.0, 3.0)).norm(), 0.0, kRoundOff);
    EXPECT_NEAR((config.cloth.material[1] - Vec2(1.0, 0.0)).norm(), 0.0, kRoundOff);
    EXPECT_EQ(config.as_run["cloth"]["file"], "cloth.obj");
    for (const char* key : {"size", "resolution", "pattern", "pattern_angle"})
        EXPECT_FALSE(config.as_run["cloth"].contains(key)) << key;
}

TEST(SceneLoad, ScalesUVsFrom0To1ToMetres)
{
    const TemporaryDirectory directory;
    const std::string places = "v 0 0 0\nv 1.6 0 0\nv 0 1.6 0\n";
    write_bytes(directory / "cloth.obj", places + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    const std::string scene = kFileCloth + "[gravity]\n[cloth.material]\nbending_stiffness = 0\n";
    write_bytes(directory / "s.toml", scene);
    EXPECT_THAT(
        load_scene(directory / "s.toml", {}).warnings,
        Contains(AllOf(HasSubstr("starts strained, "), HasSubstr("scale the UVs in the file to metres, "),
                       HasSubstr("or set cloth.uv_scale (near 1.6)"))));

    const RunConfig scaled = load_scene(directory / "s.toml", {"cloth.uv_scale=1.6"});
    EXPECT_THAT(scaled.warnings, Not(Contains(HasSubstr("strained"))));
    EXPECT_EQ(scaled.cloth.material[1], Vec2(1.6, 0.0));
    EXPECT_EQ(scaled.cloth.world[1], Vec3(1.6, 0.0, 0.0));
    try {
        load_scene(directory / "s.toml", {"cloth.uv_scale=0"});
        ADD_FAILURE() << "no InputError";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("cloth.uv_scale=0: is out of range"));
    }

    write_bytes(directory / "cloth.obj", places + "f 1 2 3\n");
    EXPECT_THAT(load_scene(directory / "s.toml", {"cloth.uv_scale=1.6"}).warnings,
                Contains(HasSubstr("cloth.uv_scale=1.6: has no effect: the file has no UVs")));
}

TEST(SceneLoad, BlamesTheKeyThatNamesABadClothFile)
{
    const TemporaryDirectory directory;
    write_bytes(directory / "s.toml", kFileCloth);
    const std::string line = refusal(directory / "s.toml");
    EXPECT_THAT(line, HasSubstr("s.toml:3: cloth.file = \"cloth.obj\": "));
    EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(SceneLoad, RefusesWhatIsNoSceneFile)
{
    const TemporaryDirectory directory;
    EXPECT_EQ(refusal(directory / "none.toml"), directory / "none.toml: No such file or directory");
    EXPECT_EQ(refusal(directory.path()), directory.path() + ": is a directory; allowed: a scene file (TOML)");
    EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is not a regular file; allowed: a scene file (TOML)");
    EXPECT_THAT(refusal(directory / "a\nb\x1b.toml"), HasSubstr("a\\nb\\u001b.toml: No such file"));

    write_bytes(directory / "huge.toml", "");
    std::filesystem::resize_file(directory / "huge.toml", (16 << 20) + 1);
    EXPECT_EQ(refusal(directory / "huge.toml"),
              directory / "huge.toml: is 16777217 bytes long; allowed: a file of at most 16777216 bytes");
}

TEST(SceneLoad, RefusesFoldsThatAreNotIsometric)
{
    const std::string folds =
        "folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = 90 }, { line = [[0, 0.5], [1, 0.5]], "
        "degrees = 90 } ]\n";
    try {
        load(kBase + folds);
        FAIL() << "was accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("s.toml:5: cloth.folds = "));
    }
}

TEST(SceneLoad, TakesTheLargestOfEverythingThatIsAllowed)
{
    EXPECT_EQ(load("title = \"" + std::string(200, 'x') + "\"\n" + kBase).title.size(), 200u);
    std::string umlauts;
    for (int i = 0; i < 200; ++i) umlauts += "ü";
    EXPECT_EQ(load("title = \"" + umlauts + "\"\n" + kBase).title, umlauts);
    const std::string name(64, 'n');
    EXPECT_EQ(load(kBase + "[[probe]]\nname = \"" + name + "\"\nmaterial = [0, 0]\n").probes[0].name, name);
    EXPECT_EQ(load("duration = 1e6\n[time]\nstep = 0.01\n[output]\nframes_per_second = 0\n"
                   "[cloth]\nsize = [1, 1]\nresolution = [1, 1]\n")
                  .duration,
              1e6);  // 1e8 steps
}

}  // namespace
}  // namespace arris
