// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of mistake in a scene file, with the whole line that a person gets to read.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "app/scene/parts/run_config.h"
#include "app/scene/scene_load.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

const std::string kCloth = "[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n";
const std::string kRemedy =
    "move the cloth or the obstacle ('translate') until they are at least 0.001 m apart, the cloth's "
    "thickness";
const std::string kBase = "duration = 1\n" + kCloth;
const std::string kTriangle = "outline = [[0, 0], [1, 0], [0, 1]]\n";
const std::string kOutlined = "duration = 1\n[cloth]\n" + kTriangle + "edge_length = 0.1\n";
const std::string kNail = "[[obstacle]]\npoints = [[0, 0, 9]]\n";

std::string many_nails(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i) text += kNail;
    return text;
}

struct WrongScene {
    std::string name;
    std::string text;
    std::vector<std::string> overrides;
    std::string line;
};

void PrintTo(const WrongScene& scene, std::ostream* out)
{
    *out << scene.name;
}

class WrongSceneTest : public ::testing::TestWithParam<WrongScene> {};

TEST_P(WrongSceneTest, IsRefusedInOneLineThatNamesPlaceKeyValueAndWhatIsAllowed)
{
    const WrongScene& scene = GetParam();
    try {
        load_scene(SceneSource{"s.toml", scene.text, scene.overrides});
        FAIL() << "was accepted";
    } catch (const InputError& error) {
        // What the parser has to say about TOML is its own affair.
        const std::string line = error.what();
        EXPECT_EQ(scene.line.ends_with(": ") ? line.substr(0, scene.line.size()) : line, scene.line);
        EXPECT_EQ(line.find_first_of("\n\r\033"), std::string::npos);
    }
}

const std::vector<WrongScene> kWrongScenes = {
    {"EmptyFile",
     "",
     {},
     "s.toml:1: duration: is required and missing; allowed: a number > 0 and <= 1000000 (s)"},
    {"SyntaxError", "duration = 1\nx = = 2\n", {}, "s.toml:2: is not TOML: "},
    {"TableAndArrayOfTables",
     kBase + "[obstacle]\nbox = [1, 1, 1]\n" + kNail,
     {},
     "s.toml:7: is not TOML: Error while parsing table header: cannot redefine existing table 'obstacle' as "
     "array-of-tables; allowed: [[name]] with two brackets above every one of several tables with this name"},
    {"ArrayOfTablesAndTable",
     kBase + kNail + "[obstacle]\nbox = [1, 1, 1]\n",
     {},
     "s.toml:7: is not TOML: Error while parsing table header: cannot redefine existing array 'obstacle' as "
     "table; "
     "allowed: [[name]] with two brackets above every one of several tables with this name"},
    {"Backslash",
     kBase + "[[obstacle]]\nfile = \"C:\\meshes\\table.obj\"\n",
     {},
     "s.toml:6: is not TOML: Error while parsing string: unknown escape sequence '\\m'; allowed: in double "
     "quotes "
     "\\\\ for a backslash; or single quotes, as in 'C:\\meshes\\table.obj'"},
    {"BackslashU",
     kBase + "[[obstacle]]\nfile = \"C:\\users\\table.obj\"\n",
     {},
     "s.toml:6: is not TOML: Error while parsing unicode scalar sequence: expected hex digit, saw 's'; "
     "allowed: in "
     "double quotes \\\\ for a backslash; or single quotes, as in 'C:\\meshes\\table.obj'"},
    {"RotateOfNumbers",
     kBase + "rotate = [0, 0, 45]\n",
     {},
     "s.toml:5: cloth.rotate = [0, 0, 45]: is not a table; allowed: a table, { axis = [0, 0, 1], degrees = "
     "45 }"},
    {"RotateOfANumber",
     kBase + kNail + "rotate = 45\n",
     {},
     "s.toml:7: obstacle.0.rotate = 45: is not a table; allowed: a table, { axis = [0, 0, 1], degrees = 45 "
     "}"},
    {"MotionOfNumbers",
     kBase + kNail + "motion = [1, 0, 0]\n",
     {},
     "s.toml:7: obstacle.0.motion = [1, 0, 0]: is not a table; allowed: a table, [obstacle.motion]"},
    {"VelocityOfAnObstacle",
     kBase + kNail + "velocity = [1, 0, 0]\n",
     {},
     "s.toml:7: obstacle.0.velocity = [1, 0, 0]: unknown key, did you mean motion.velocity?; allowed: name, "
     "file, "
     "units, up, deform, box, points, wire, closed, teeth, translate, rotate, scale, feature_angle, motion, "
     "keyframes, "
     "friction, "
     "start"},
    {"MotionOfTheScene",
     kBase + "[motion]\nvelocity = [1, 0, 0]\n",
     {},
     "s.toml:5: motion: unknown key, did you mean [obstacle.motion], below its [[obstacle]]?; allowed: "
     "title, "
     "duration, time, cloth, fabric, pin, gravity, wind, pull, friction, self_contact, eol, remesh, "
     "obstacle, probe, "
     "solver, "
     "output"},
    {"RadiusOfANail",
     kBase + kNail + "radius = 0.01\n",
     {},
     "s.toml:7: obstacle.0.radius = 0.01: unknown key: obstacles, wires and nails too, have no thickness of "
     "their "
     "own; cloth.material.thickness is the distance that the cloth keeps from them; allowed: name, file, "
     "units, up, "
     "deform, box, points, wire, closed, teeth, translate, rotate, scale, feature_angle, motion, keyframes, "
     "friction, "
     "start"},
    {"StudyForAScene",
     "scene = \"strip.toml\"\n" + kBase,
     {},
     "s.toml:1: scene = \"strip.toml\": unknown key: a file with it is a study, which `arris study` runs; "
     "allowed: title, duration, time, cloth, fabric, pin, gravity, wind, pull, friction, self_contact, eol, "
     "remesh, "
     "obstacle, probe, solver, output"},
    {"DuplicateKey", "duration = 1\nduration = 2\n", {}, "s.toml:2: is not TOML: "},
    {"UnclosedHeader", "[cloth\n", {}, "s.toml:1: is not TOML: "},
    {"ControlCharacter", "title = \"a\033b\"\n", {}, "s.toml:1: is not TOML: "},
    {"NestingBomb",
     "x = "
     "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
     "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
     "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
     "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\n",
     {},
     "s.toml:1: is not TOML: "},
    {"NumberTooLarge", "duration = 99999999999999999999\n", {}, "s.toml:1: is not TOML: "},
    {"NotUtf8", "title = \"a\"\nduration = \3771\n", {}, "s.toml:2: is not UTF-8 text; allowed: TOML"},
    {"UnknownKey",
     "durration = 1\n" + kCloth,
     {},
     "s.toml:1: durration = 1: unknown key, did you mean duration?; allowed: title, duration, time, cloth, "
     "fabric, pin, gravity, wind, pull, friction, self_contact, eol, remesh, obstacle, probe, solver, "
     "output"},
    {"UnknownTable",
     kBase + "[gravitation]\n",
     {},
     "s.toml:5: gravitation: unknown key; allowed: title, duration, time, cloth, fabric, pin, gravity, wind, "
     "pull, "
     "friction, self_contact, eol, remesh, obstacle, probe, solver, output"},
    {"UnknownKeyOfTable",
     kBase + "[cloth.material]\nbending_stifness = 1\n",
     {},
     "s.toml:6: cloth.material.bending_stifness = 1: unknown key, did you mean bending_stiffness?; allowed: "
     "preset, density, youngs_modulus, poisson_ratio, bending_stiffness, bending_model, damping, thickness, "
     "compression_modulus, friction"},
    {"KeyOfAnotherTable",
     kBase + "step = 0.01\n",
     {},
     "s.toml:5: cloth.step = 0.01: unknown key, did you mean time.step?; allowed: name, fabric, size, "
     "resolution, pattern, pattern_angle, outline, holes, edge_length, folds, file, units, up, uv_scale, "
     "translate, rotate, "
     "scale, velocity, "
     "pattern_file, rotation_order, panel, seam, assembly, material"},
    {"UnknownFarFromAll",
     kBase + "[solver]\nzzzzzzzz = 1\n",
     {},
     "s.toml:6: solver.zzzzzzzz = 1: unknown key; allowed: tolerance, kernel"},
    {"UnknownKeyWithControlCharacter",
     kBase + "\"a\\nb\" = 1\n",
     {},
     "s.toml:5: cloth.a\\nb = 1: unknown key; allowed: name, fabric, size, resolution, pattern, "
     "pattern_angle, outline, holes, edge_length, folds, "
     "file, units, up, uv_scale, translate, rotate, scale, velocity, "
     "pattern_file, rotation_order, panel, seam, assembly, material"},
    {"UnknownInInlineTable",
     kBase + "rotate = { axis = [0, 0, 1], degree = 10 }\n",
     {},
     "s.toml:5: cloth.rotate.degree = 10: unknown key, did you mean degrees?; allowed: axis, degrees"},
    {"UnknownInSecondElement",
     kBase + "[[probe]]\nname = \"a\"\nmaterial = [0, 0]\n[[probe]]\nname = \"b\"\nmaterial = [0, 0]\ncolour "
             "= 1\n",
     {},
     "s.toml:11: probe.1.colour = 1: unknown key; allowed: name, material, piece, panel"},
    {"TextForNumber",
     "duration = \"1\"\n" + kCloth,
     {},
     "s.toml:1: duration = \"1\": is not a number; allowed: a number > 0 and <= 1000000 (s)"},
    {"BooleanForNumber",
     "duration = true\n" + kCloth,
     {},
     "s.toml:1: duration = true: is not a number; allowed: a number > 0 and <= 1000000 (s)"},
    {"DateForText",
     "title = 1979-05-27\n" + kBase,
     {},
     "s.toml:1: title = 1979-05-27: is not a text; allowed: a text of at most 200 characters"},
    {"NumberForText",
     "title = 5\n" + kBase,
     {},
     "s.toml:1: title = 5: is not a text; allowed: a text of at most 200 characters"},
    {"NumberForIntegers",
     "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2.0, 2]\n",
     {},
     "s.toml:4: cloth.resolution = [2.0, 2]: is not an integer; allowed: 2 integers from 1 to 5000000"},
    {"NumberForTable",
     kBase + "material = 3\n",
     {},
     "s.toml:5: cloth.material = 3: is not a table; allowed: a table, [cloth.material]"},
    {"TablesForTable",
     kBase + "[[gravity]]\n",
     {},
     "s.toml:5: gravity: is not a table; allowed: a table, [gravity]"},
    {"TableForTables",
     kBase + "[pin]\nmaterial = [[0, 0], [0, 1]]\n",
     {},
     "s.toml:5: pin: is not an array of tables; allowed: tables, [[pin]]"},
    {"NumbersForTables",
     "pin = [1, 2]\n" + kBase,
     {},
     "s.toml:1: pin.0 = 1: is not a table; allowed: tables, [[pin]]"},
    {"NumberForArray",
     kBase + "translate = 1\n",
     {},
     "s.toml:5: cloth.translate = 1: is not an array, such as [1, 2, 3]; allowed: 3 numbers from -1000000 to "
     "1000000 (m)"},
    {"TooFewNumbers",
     kBase + "translate = [1, 2]\n",
     {},
     "s.toml:5: cloth.translate = [1, 2]: has the wrong number of entries; allowed: 3 numbers from -1000000 "
     "to 1000000 (m)"},
    {"TooManyNumbers",
     "duration = 1\n[cloth]\nsize = [1, 1, 1]\nresolution = [2, 2]\n",
     {},
     "s.toml:3: cloth.size = [1, 1, 1]: has the wrong number of entries; allowed: 2 numbers from 1e-06 to "
     "10000 (m)"},
    {"TextInArray",
     kBase + "translate = [1, \"2\", 3]\n",
     {},
     "s.toml:5: cloth.translate = [1, \"2\", 3]: is not a number; allowed: 3 numbers from -1000000 to "
     "1000000 (m)"},
    {"FlatBox",
     kBase + "[[pin]]\nmaterial = [0, 0, 0, 1]\n",
     {},
     "s.toml:6: pin.0.material = [0, 0, 0, 1]: is not an array of points, such as [[0, 0], [0, 1]]; allowed: "
     "[[u, v], [u, v]], "
     "least then greatest, numbers from -1000000 to 1000000 (m)"},
    {"BoxOfThree",
     kBase + "[[pin]]\nmaterial = [[0, 0, 0], [0, 1, 0]]\n",
     {},
     "s.toml:6: pin.0.material = [[0, 0, 0], [0, 1, 0]]: has the wrong number of entries; allowed: [[u, v], "
     "[u, v]], least then greatest, numbers from -1000000 to 1000000 (m)"},
    {"TextForBoolean",
     kBase + "[eol]\nenabled = \"no\"\n",
     {},
     "s.toml:6: eol.enabled = \"no\": is not a boolean; allowed: true or false"},
    {"TextForChoices",
     kBase + "[output]\nformats = \"obj\"\n",
     {},
     "s.toml:6: output.formats = \"obj\": is not an array; allowed: any of \"obj\", \"usd\", \"viewer\", "
     "\"vtk\", \"pc2\", \"mdd\", \"gltf\""},
    {"ZeroDuration",
     "duration = 0\n" + kCloth,
     {},
     "s.toml:1: duration = 0: is out of range; allowed: a number > 0 and <= 1000000 (s)"},
    {"NegativeDuration",
     "duration = -1.5\n" + kCloth,
     {},
     "s.toml:1: duration = -1.5: is out of range; allowed: a number > 0 and <= 1000000 (s)"},
    {"InfiniteDuration",
     "duration = inf\n" + kCloth,
     {},
     "s.toml:1: duration = inf: is not finite; allowed: a number > 0 and <= 1000000 (s)"},
    {"NotANumber",
     kBase + "[time]\nstep = nan\n",
     {},
     "s.toml:6: time.step = nan: is not finite; allowed: a number > 0 and <= 1000000 (s)"},
    {"ZeroStep",
     kBase + "[time]\nstep = 0.0\n",
     {},
     "s.toml:6: time.step = 0.0: is out of range; allowed: a number > 0 and <= 1000000 (s)"},
    {"ZeroSize",
     "duration = 1\n[cloth]\nsize = [1, 0]\nresolution = [2, 2]\n",
     {},
     "s.toml:3: cloth.size = [1, 0]: is out of range; allowed: 2 numbers from 1e-06 to 10000 (m)"},
    {"ZeroResolution",
     "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [0, 2]\n",
     {},
     "s.toml:4: cloth.resolution = [0, 2]: is out of range; allowed: 2 integers from 1 to 5000000"},
    {"HugePosition",
     kBase + "translate = [0, 0, 1e7]\n",
     {},
     "s.toml:5: cloth.translate = [0, 0, 1e7]: is out of range; allowed: 3 numbers from -1000000 to 1000000 "
     "(m)"},
    {"InfinityInArray",
     kBase + "velocity = [0, -inf, 0]\n",
     {},
     "s.toml:5: cloth.velocity = [0, -inf, 0]: is not finite; allowed: 3 numbers from -1000000 to 1000000 "
     "(m/s)"},
    {"ZeroDensity",
     kBase + "[cloth.material]\ndensity = 0\n",
     {},
     "s.toml:6: cloth.material.density = 0: is out of range; allowed: a number > 0 and <= 10000 (kg/m^2)"},
    {"NegativeStiffness",
     kBase + "[cloth.material]\nyoungs_modulus = -5e2\n",
     {},
     "s.toml:6: cloth.material.youngs_modulus = -5e2: is out of range; allowed: a number > 0 and <= "
     "1000000000000 (N/m)"},
    {"PoissonRatio",
     kBase + "[cloth.material]\npoisson_ratio = 0.6\n",
     {},
     "s.toml:6: cloth.material.poisson_ratio = 0.6: is out of range; allowed: a number from 0 to 0.5"},
    {"NegativeBending",
     kBase + "[cloth.material]\nbending_stiffness = -1e-5\n",
     {},
     "s.toml:6: cloth.material.bending_stiffness = -1e-5: is out of range; allowed: a number from 0 to "
     "1000000 (J)"},
    {"PinWithBoxAndVertices",
     kBase + "[[pin]]\nvertices = [0]\nmaterial = [[0, 0], [0, 1]]\n",
     {},
     "s.toml:7: pin.0.material = [[0, 0], [0, 1]]: contradicts pin.0.vertices; allowed: one of material, "
     "vertices, label"},
    {"PinnedVertexThatIsNotThere",
     kBase + "[[pin]]\nvertices = [0, 99]\n",
     {},
     "s.toml:6: pin.0.vertices.1 = 99: is not a vertex of the cloth; allowed: an integer from 0 to 12"},
    {"PinnedVertexTwice",
     kBase + "[[pin]]\nvertices = [4, 4]\n",
     {},
     "s.toml:6: pin.0.vertices.1 = 4: is there twice; allowed: 1 or more different integers from 0 to "
     "5000000"},
    {"NoPinnedVertices",
     kBase + "[[pin]]\nvertices = []\n",
     {},
     "s.toml:6: pin.0.vertices = []: is empty; allowed: 1 or more different integers from 0 to 5000000"},
    {"NegativeDamping",
     kBase + "[cloth.material]\ndamping = -1\n",
     {},
     "s.toml:6: cloth.material.damping = -1: is out of range; allowed: a number from 0 to 1000 (s)"},
    {"ZeroThickness",
     kBase + "[cloth.material]\nthickness = 0\n",
     {},
     "s.toml:6: cloth.material.thickness = 0: is out of range; allowed: a number > 0 and <= 1 (m)"},
    {"ZeroScale",
     kBase + "scale = 0\n",
     {},
     "s.toml:5: cloth.scale = 0: is out of range; allowed: a number > 0 and <= 1000000"},
    {"ZeroAxis",
     kBase + "rotate = { axis = [0, 0, 0.0], degrees = 10 }\n",
     {},
     "s.toml:5: cloth.rotate.axis = [0, 0, 0.0]: has no direction; allowed: 3 numbers from -1000000 to "
     "1000000, not all nearly 0"},
    {"FoldTooFar",
     kBase + "folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = 181 } ]\n",
     {},
     "s.toml:5: cloth.folds.0.degrees = 181: is out of range; allowed: a number from -179.9 to 179.9 "
     "(degrees)"},
    {"FoldShut",
     kBase + "folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = -180 } ]\n",
     {},
     "s.toml:5: cloth.folds.0.degrees = -180: is out of range; allowed: a number from -179.9 to 179.9 "
     "(degrees)"},
    {"PointForLine",
     kBase + "folds = [ { line = [[0.5, 0], [0.5, 0]], degrees = 90 } ]\n",
     {},
     "s.toml:5: cloth.folds.0.line = [[0.5, 0], [0.5, 0]]: is a point, not a line; allowed: two different "
     "points, [[u, v], [u, v]], numbers from -1000000 to 1000000 (m)"},
    {"BoxUpsideDown",
     kBase + "[[pin]]\nmaterial = [[0, 1], [0, 0]]\n",
     {},
     "s.toml:6: pin.0.material = [[0, 1], [0, 0]]: has its least corner above its greatest; allowed: [[u, "
     "v], [u, v]], least then greatest, numbers from -1000000 to 1000000 (m)"},
    {"NegativeRelease",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nrelease = -1\n",
     {},
     "s.toml:7: pin.0.release = -1: is out of range; allowed: a number from 0 to 1000000 (s)"},
    {"NegativePinStart",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nstart = -0.5\n",
     {},
     "s.toml:7: pin.0.start = -0.5: is out of range; allowed: a number from 0 to 1000000 (s)"},
    {"InfinitePinStart",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nstart = inf\n",
     {},
     "s.toml:7: pin.0.start = inf: is not finite; allowed: a number from 0 to 1000000 (s)"},
    {"PinReleasedAtItsStart",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nstart = 0.5\nrelease = 0.5\n",
     {},
     "s.toml:8: pin.0.release = 0.5: is not later than the pin's start; allowed: a number > 0.5 (s)"},
    {"NegativeSeed",
     kBase + "[wind]\nvelocity = [1, 0, 0]\ngust = { amplitude = 1, frequency = 1, seed = -1 }\n",
     {},
     "s.toml:7: wind.gust.seed = -1: is out of range; allowed: an integer from 0 to 2147483647"},
    {"Tolerance",
     kBase + "[solver]\ntolerance = 1\n",
     {},
     "s.toml:6: solver.tolerance = 1: is out of range; allowed: a number from 1e-14 to 0.01"},
    {"LongTitle",
     "title = "
     "\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
     "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\""
     "\n" +
         kBase,
     {},
     "s.toml:1: title = \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\342\200\246: has 201 "
     "characters; allowed: a text of at most 200 characters"},
    {"Integrator",
     kBase + "[time]\nintegrator = \"rk4\"\n",
     {},
     "s.toml:6: time.integrator = \"rk4\": is not one of the choices; allowed: \"bdf2\", \"implicit_euler\""},
    {"Pattern",
     kBase + "pattern = \"Cross\"\n",
     {},
     "s.toml:5: cloth.pattern = \"Cross\": is not one of the choices; allowed: \"diagonal\", "
     "\"alternating\", "
     "\"cross\", \"unstructured\""},
    {"Preset",
     kBase + "[cloth.material]\npreset = \"spandex\"\n",
     {},
     "s.toml:6: cloth.material.preset = \"spandex\": is not one of the choices; allowed: \"cotton\", "
     "\"silk\", "
     "\"wool\", \"denim\", \"leather\", \"rubber\""},
    {"Direction",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\ndirections = [\"x\", \"w\"]\n",
     {},
     "s.toml:7: pin.0.directions = [\"x\", \"w\"]: \"w\" is not one of the choices; allowed: one or more of "
     "\"x\", \"y\", \"z\""},
    {"NoDirection",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\ndirections = []\n",
     {},
     "s.toml:7: pin.0.directions = []: is empty; allowed: one or more of \"x\", \"y\", \"z\""},
    {"DirectionTwice",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\ndirections = [\"x\", \"x\"]\n",
     {},
     "s.toml:7: pin.0.directions = [\"x\", \"x\"]: names \"x\" twice; allowed: one or more of \"x\", \"y\", "
     "\"z\""},
    {"Format",
     kBase + "[output]\nformats = [\"mp4\"]\n",
     {},
     "s.toml:6: output.formats = [\"mp4\"]: \"mp4\" is not one of the choices; allowed: any of \"obj\", "
     "\"usd\", \"viewer\", \"vtk\", \"pc2\", \"mdd\", \"gltf\""},
    {"BadName",
     kBase + "[[probe]]\nname = \"a b\"\nmaterial = [0, 0]\n",
     {},
     "s.toml:6: probe.0.name = \"a b\": is not a name; allowed: a letter or _, then at most 63 letters, "
     "digits or _"},
    {"LongName",
     kBase + "[[probe]]\nname = "
             "\"nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn\"\nmaterial = [0, 0]\n",
     {},
     "s.toml:6: probe.0.name = \"nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn\342\200\246: is "
     "not a name; allowed: a letter or _, then at most 63 letters, digits or _"},
    {"NameOfCloth",
     kBase + "[[probe]]\nname = \"cloth\"\nmaterial = [0, 0]\n",
     {},
     "s.toml:6: probe.0.name = \"cloth\": is already the name of the cloth; allowed: a unique name other "
     "than cloth"},
    {"NameTwice",
     kBase + "[[probe]]\nname = \"a\"\nmaterial = [0, 0]\n[[probe]]\nname = \"a\"\nmaterial = [1, 1]\n",
     {},
     "s.toml:9: probe.1.name = \"a\": is already the name of probe.0; allowed: a unique name other than "
     "cloth"},
    {"NoDuration",
     kCloth,
     {},
     "s.toml:1: duration: is required and missing; allowed: a number > 0 and <= 1000000 (s)"},
    {"NoCloth",
     "duration = 1\n",
     {},
     "s.toml:1: cloth.size: is required and missing, as there is none of cloth.outline, "
     "cloth.panel, cloth.pattern_file and cloth.file; "
     "allowed: 2 numbers from "
     "1e-06 to "
     "10000 (m)"},
    {"NoResolution",
     "duration = 1\n[cloth]\nsize = [1, 1]\n",
     {},
     "s.toml:2: cloth.resolution: is required and missing, as there is none of cloth.outline, "
     "cloth.panel, cloth.pattern_file and cloth.file; "
     "allowed: 2 integers "
     "from 1 "
     "to 5000000"},
    {"NoSize",
     "duration = 1\n[cloth]\nresolution = [1, 1]\n",
     {},
     "s.toml:2: cloth.size: is required and missing, as there is none of cloth.outline, "
     "cloth.panel, cloth.pattern_file and cloth.file; "
     "allowed: 2 numbers from "
     "1e-06 to "
     "10000 (m)"},
    {"PinWithoutMaterial",
     kBase + "[[pin]]\n",
     {},
     "s.toml:5: pin.0.material: is required and missing; allowed: [[u, v], [u, v]] (m), or pin.vertices, "
     "or pin.label"},
    {"PullWithoutMaterial",
     kBase + "[[pull]]\nforce = [0, 0, 1]\n",
     {},
     "s.toml:5: pull.0.material: is required and missing; allowed: [[u, v], [u, v]], least then greatest, "
     "numbers from -1000000 to 1000000 (m)"},
    {"PullWithoutForce",
     kBase + "[[pull]]\nmaterial = [[0, 0], [0, 1]]\n",
     {},
     "s.toml:5: pull.0.force: is required and missing; allowed: 3 numbers from -1000000000 to 1000000000 "
     "(N)"},
    {"WindWithoutVelocity",
     kBase + "[wind]\n",
     {},
     "s.toml:5: wind.velocity: is required and missing; allowed: 3 numbers from -1000000 to 1000000 (m/s)"},
    {"ProbeWithoutName",
     kBase + "[[probe]]\nmaterial = [0, 0]\n",
     {},
     "s.toml:5: probe.0.name: is required and missing; allowed: a letter or _, then at most 63 letters, "
     "digits or _"},
    {"ProbeWithoutMaterial",
     kBase + "[[probe]]\nname = \"a\"\n",
     {},
     "s.toml:5: probe.0.material: is required and missing; allowed: 2 numbers from -1000000 to 1000000 (m)"},
    {"RotateWithoutAxis",
     kBase + "rotate = { degrees = 10 }\n",
     {},
     "s.toml:5: cloth.rotate.axis: is required and missing; allowed: 3 numbers from -1000000 to 1000000, not "
     "all nearly 0"},
    {"KeyframeWithoutTime",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = [ { translate = [0, 0, 1] } ]\n",
     {},
     "s.toml:7: pin.0.keyframes.0.time: is required and missing; allowed: a number from 0 to 1000000 (s)"},
    {"SizeAndFile",
     "duration = 1\n[cloth]\nsize = [1, 1]\nfile = \"cloth.obj\"\n",
     {},
     "s.toml:3: cloth.size = [1, 1]: contradicts cloth.file; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"ResolutionAndFile",
     "duration = 1\n[cloth]\nfile = \"cloth.obj\"\nresolution = [2, 2]\n",
     {},
     "s.toml:4: cloth.resolution = [2, 2]: contradicts cloth.file; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"PatternAndFile",
     "duration = 1\n[cloth]\nfile = \"cloth.obj\"\npattern = \"cross\"\n",
     {},
     "s.toml:4: cloth.pattern = \"cross\": contradicts cloth.file; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"FoldsAndFile",
     "duration = 1\n[cloth]\nfile = \"cloth.obj\"\nfolds = []\n",
     {},
     "s.toml:4: cloth.folds = []: contradicts cloth.file; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"OutlineAndFile",
     "duration = 1\n[cloth]\nfile = \"cloth.obj\"\n" + kTriangle,
     {},
     "s.toml:4: cloth.outline = [[0, 0], [1, 0], [0, 1]]: contradicts cloth.file; allowed: keys of one "
     "shape: "
     "a rectangle, cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"OutlineAndSize",
     "duration = 1\n[cloth]\nsize = [1, 1]\n" + kTriangle + "edge_length = 0.1\n",
     {},
     "s.toml:3: cloth.size = [1, 1]: contradicts cloth.outline; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"OutlineAndPattern",
     "duration = 1\n[cloth]\npattern = \"cross\"\n" + kTriangle + "edge_length = 0.1\n",
     {},
     "s.toml:3: cloth.pattern = \"cross\": contradicts cloth.outline; allowed: keys of one shape: a "
     "rectangle, cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"OutlineWithoutEdgeLength",
     "duration = 1\n[cloth]\n" + kTriangle,
     {},
     "s.toml:2: cloth.edge_length: is required and missing, as there is cloth.outline; allowed: a number "
     "from 1e-06 to 10000 (m)"},
    {"HolesWithoutOutline",
     kBase + "holes = []\n",
     {},
     "s.toml:5: cloth.holes = []: is written without cloth.outline; allowed: keys of one shape: a rectangle, "
     "cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"EdgeLengthWithoutOutline",
     kBase + "edge_length = 0.1\n",
     {},
     "s.toml:5: cloth.edge_length = 0.1: is written without cloth.outline; allowed: keys of one shape: a "
     "rectangle, cloth.outline, cloth.panel, cloth.pattern_file or cloth.file"},
    {"OutlineOfTwoCorners",
     kOutlined,
     {"cloth.outline=[[0,0],[1,0]]"},
     "--set cloth.outline=[[0,0],[1,0]]: has too few corners; allowed: 3 or more corners [u, v], numbers "
     "from -1000000 to 1000000 (m)"},
    {"OutlineCorner",
     kOutlined,
     {"cloth.outline=[[0,0],[1,0],[0,inf]]"},
     "--set cloth.outline=[[0,0],[1,0],[0,inf]]: cloth.outline.2 = [0,inf]: is not finite; allowed: 3 or "
     "more corners [u, v], numbers from -1000000 to 1000000 (m)"},
    {"OutlineOfNumbers",
     kOutlined,
     {"cloth.outline=[1,2,3]"},
     "--set cloth.outline=[1,2,3]: is not an array of points, such as [[0, 0], [1, 0], [0.5, 0.9]]; allowed: "
     "3 or more corners [u, v], numbers from -1000000 to 1000000 (m)"},
    {"OutlineCrossesItself",
     kOutlined,
     {"cloth.outline=[[0,0],[1,1],[1,0],[0,1]]"},
     "--set cloth.outline=[[0,0],[1,1],[1,0],[0,1]]: its side from [1, 0] to [0, 1] crosses the side from "
     "[0, 0] to [1, 1]; allowed: sides that neither cross nor touch one another"},
    {"HoleOfOnePolygon",
     kOutlined + "holes = [[0.2, 0.2], [0.3, 0.2], [0.2, 0.3]]\n",
     {},
     "s.toml:5: cloth.holes.0 = [0.2, 0.2]: is not an array of points, such as [[0, 0], [1, 0], [0.5, 0.9]]; "
     "allowed: polygons [[u, v], [u, v], ...] of 3 or more corners, numbers from -1000000 to 1000000 (m)"},
    {"HoleOutside",
     kOutlined + "holes = [[[2, 0], [3, 0], [2, 1]]]\n",
     {},
     "s.toml:5: cloth.holes.0 = [[2, 0], [3, 0], [2, 1]]: lies outside the outline; allowed: holes inside "
     "the "
     "outline, and not in one another"},
    {"OutlineThatNearlyTouchesItself",
     kOutlined,
     {"cloth.outline=[[0,0],[1,0],[1,1e-8],[0,1e-8]]"},
     "--set cloth.outline=[[0,0],[1,0],[1,1e-8],[0,1e-8]]: around (0.2, 5e-09) m the mesh would need sides "
     "of 1e-08 m, or more than the 5e+06 vertices that are allowed, as sides of the border, or folds, come "
     "that near one another"},
    {"OutlineFoldThatMisses",
     kOutlined + "folds = [ { line = [[2, 0], [2, 1]], degrees = 9 } ]\n",
     {},
     "s.toml:5: cloth.folds = [ { line = [[2, 0], [2, 1]], degrees = 9 } ]: fold [[2, 0], [2, 1]]: its line "
     "does not run through the cloth"},
    {"EdgeLengthTooSmall",
     kOutlined,
     {"cloth.edge_length=1e-6"},
     "--set cloth.edge_length=1e-6: the run would have about 6.000015e+11 vertices; allowed: at most 5000000 "
     "vertices"},
    {"EdgeLengthInMillimetres",
     kOutlined,
     {"cloth.edge_length=60"},
     "--set cloth.edge_length=60: exceeds the outline's diagonal of 1.414 m; allowed: lengths (m) below the "
     "outline's extent of 1 x 1 m, with which its area changes by at most 10 %"},
    {"EdgeLengthThatCutsOffCorners",
     "duration = 1\n[cloth]\noutline = [[0, 0], [1, 0], [1, 0.02], [0.5, 0.08], [0, 0.02]]\n"
     "edge_length = 0.9\n",
     {},
     "s.toml:4: cloth.edge_length = 0.9: would leave out 2 of 5 corners of the outline and its holes, and "
     "change the area by -20 %; allowed: lengths (m) below the outline's extent of 1 x 0.08 m, with which "
     "its area changes by at most 10 %"},
    {"RemeshingInMillimetres",
     kBase + "[remesh]\nedge_length = [30, 120]\n",
     {},
     "s.toml:6: remesh.edge_length = [30, 120]: the smallest, 30 m, exceeds the cloth's diagonal of 1.414 m; "
     "allowed: lengths (m) whose smallest is below the cloth's extent of 1 x 1 m"},
    {"VelocityAndKeyframes",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nvelocity = [0, 0, 1]\nkeyframes = [ { time = 0 } ]\n",
     {},
     "s.toml:7: pin.0.velocity = [0, 0, 1]: contradicts pin.0.keyframes; allowed: either velocity, "
     "angular_velocity and pivot, or keyframes"},
    {"PivotAndKeyframes",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = [ { time = 0 } ]\npivot = [0, 0, 1]\n",
     {},
     "s.toml:8: pin.0.pivot = [0, 0, 1]: contradicts pin.0.keyframes; allowed: either velocity, "
     "angular_velocity and pivot, or keyframes"},
    {"NoKeyframes",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = []\n",
     {},
     "s.toml:7: pin.0.keyframes = []: is empty; allowed: one or more keyframes"},
    {"KeyframesOutOfOrder",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n[[pin.keyframes]]\ntime = 0.5\n[[pin.keyframes]]\ntime = "
             "0.5\n",
     {},
     "s.toml:10: pin.0.keyframes.1.time = 0.5: is not later than the previous keyframe; allowed: a number > "
     "0.5 (s)"},
    {"PullStopsBeforeItStarts",
     kBase + "[[pull]]\nmaterial = [[0, 0], [0, 1]]\nforce = [0, 0, 1]\nstart = 0.5\nstop = 0.5\n",
     {},
     "s.toml:9: pull.0.stop = 0.5: is not later than the pull's start; allowed: a number > 0.5 (s)"},
    {"ObstacleWithoutShape",
     kBase + "[[obstacle]]\nname = \"table\"\n",
     {},
     "s.toml:5: obstacle.0: has no shape; allowed: one of file, box, points, wire, teeth"},
    {"TwoShapes",
     kBase + "[[obstacle]]\nbox = [1, 1, 1]\nfile = \"table.obj\"\n",
     {},
     "s.toml:6: obstacle.0.box = [1, 1, 1]: contradicts obstacle.0.file; allowed: one of file, box, points, "
     "wire, teeth"},
    {"WireAndPoints",
     kBase + "[[obstacle]]\nwire = [[0, 0, 0], [1, 0, 0]]\npoints = [[0, 0, 0]]\n",
     {},
     "s.toml:6: obstacle.0.wire = [[0, 0, 0], [1, 0, 0]]: contradicts obstacle.0.points; allowed: one of "
     "file, box, points, wire, teeth"},
    {"TeethAndBoxOfTheSecond",
     kBase + kNail + kNail +
         "[[obstacle]]\nbox = [1, 1, 1]\n[obstacle.teeth]\ncount = 1\npitch = 1\nheight = "
         "1\nwidth = 1\ntip_degrees = 20\n",
     {},
     "s.toml:11: obstacle.2.teeth: contradicts obstacle.2.box; allowed: one of file, box, points, wire, "
     "teeth"},
    {"UnknownKeyOfObstacle",
     kBase + kNail + "positon = [0, 0, 0]\n",
     {},
     "s.toml:7: obstacle.0.positon = [0, 0, 0]: unknown key; allowed: name, file, units, "
     "up, deform, box, points, wire, closed, teeth, translate, rotate, scale, feature_angle, motion, "
     "keyframes, "
     "friction, "
     "start"},
    {"ObstacleName",
     kBase + kNail + "name = \"the table\"\n",
     {},
     "s.toml:7: obstacle.0.name = \"the table\": is not a name; allowed: a letter or _, then at most 63 "
     "letters, digits or _"},
    {"ObstacleCalledCloth",
     kBase + kNail + "name = \"cloth\"\n",
     {},
     "s.toml:7: obstacle.0.name = \"cloth\": is already the name of the cloth; allowed: a unique name other "
     "than cloth"},
    {"ObstacleNameTwice",
     kBase + kNail + "name = \"nail\"\n" + kNail + "name = \"nail\"\n",
     {},
     "s.toml:10: obstacle.1.name = \"nail\": is already the name of obstacle.0; allowed: a unique name other "
     "than cloth"},
    {"ObstacleAndProbeOfOneName",
     kBase + kNail + "name = \"nail\"\n[[probe]]\nname = \"nail\"\nmaterial = [0, 0]\n",
     {},
     "s.toml:9: probe.0.name = \"nail\": is already the name of obstacle.0; allowed: a unique name other "
     "than cloth"},
    {"ObstacleDefaultNameIsTaken",
     kBase + kNail + "name = \"obstacle1\"\n" + kNail,
     {},
     "s.toml:8: obstacle.1.name: the default obstacle1 is already the name of obstacle.0; allowed: a unique "
     "name other than cloth"},
    {"FlatObstacleBox",
     kBase + "[[obstacle]]\nbox = [1, 1, 0]\n",
     {},
     "s.toml:6: obstacle.0.box = [1, 1, 0]: is out of range; allowed: 3 numbers from 1e-06 to 10000 (m)"},
    {"NoNails",
     kBase + "[[obstacle]]\npoints = []\n",
     {},
     "s.toml:6: obstacle.0.points = []: has too few points; allowed: 1 or more points [x, y, z], numbers "
     "from "
     "-1000000 to 1000000 (m)"},
    {"FlatNails",
     kBase + "[[obstacle]]\npoints = [[1, 2]]\n",
     {},
     "s.toml:6: obstacle.0.points = [[1, 2]]: has the wrong number of entries; allowed: 1 or more points [x, "
     "y, z], numbers from -1000000 to 1000000 (m)"},
    {"InfiniteNail",
     kBase + "[[obstacle]]\npoints = [[1, 2, inf]]\n",
     {},
     "s.toml:6: obstacle.0.points = [[1, 2, inf]]: is not finite; allowed: 1 or more points [x, y, z], "
     "numbers "
     "from -1000000 to 1000000 (m)"},
    {"NailTwice",
     kBase + "[[obstacle]]\npoints = [[1, 2, 3], [1, 2, 3]]\n",
     {},
     "s.toml:6: obstacle.0.points = [[1, 2, 3], [1, 2, 3]]: "},
    {"WireOfOnePoint",
     kBase + "[[obstacle]]\nwire = [[0, 0, 0]]\n",
     {},
     "s.toml:6: obstacle.0.wire = [[0, 0, 0]]: has too few points; allowed: 2 or more points [x, y, z], "
     "numbers from -1000000 to 1000000 (m)"},
    {"WireThatStandsStill",
     kBase + "[[obstacle]]\nwire = [[0, 0, 2], [0, 0, 2]]\n",
     {},
     "s.toml:6: obstacle.0.wire = [[0, 0, 2], [0, 0, 2]]: "},
    {"ClosedWireOfTwoPoints",
     kBase + "[[obstacle]]\nwire = [[0, 0, 2], [1, 0, 2]]\nclosed = true\n",
     {},
     "s.toml:6: obstacle.0.wire = [[0, 0, 2], [1, 0, 2]]: "},
    {"TeethWithoutPitch",
     kBase + "[[obstacle]]\nteeth = { count = 5, height = 0.1, width = 0.6, tip_degrees = 60 }\n",
     {},
     "s.toml:6: obstacle.0.teeth.pitch: is required and missing; allowed: a number from 1e-06 to 10000 (m)"},
    {"TeethThatOverlap",
     kBase + kNail +
         "[[obstacle]]\nteeth = { count = 5, pitch = 0.1, height = 1, width = 0.6, tip_degrees = 120 }\n",
     {},
     "s.toml:8: obstacle.1.teeth = { count = 5, pitch = 0.1, height = 1, width = 0.6, "
     "tip_degre\342\200\246: "},
    {"HalfATooth",
     kBase +
         "[[obstacle]]\nteeth = { count = 1.5, pitch = 1, height = 0.1, width = 0.6, tip_degrees = 60 }\n",
     {},
     "s.toml:6: obstacle.0.teeth.count = 1.5: is not an integer; allowed: an integer from 1 to 10000"},
    {"TextForClosed",
     kBase + "[[obstacle]]\nwire = [[0, 0, 2], [1, 0, 2]]\nclosed = \"no\"\n",
     {},
     "s.toml:7: obstacle.0.closed = \"no\": is not a boolean; allowed: true or false"},
    {"Units",
     kBase + "[[obstacle]]\nfile = \"table.obj\"\nunits = \"feet\"\n",
     {},
     "s.toml:7: obstacle.0.units = \"feet\": is not one of the choices; allowed: \"m\", \"cm\", \"mm\", "
     "\"in\""},
    {"Up",
     kBase + "[[obstacle]]\nfile = \"table.obj\"\nup = \"-z\"\n",
     {},
     "s.toml:7: obstacle.0.up = \"-z\": is not one of the choices; allowed: \"x\", \"y\", \"z\""},
    {"ObstacleScale",
     kBase + kNail + "scale = -1\n",
     {},
     "s.toml:7: obstacle.0.scale = -1: is out of range; allowed: a number > 0 and <= 1000000"},
    {"ObstacleBeyondTheWorld",
     kBase + "[[obstacle]]\nbox = [1e4, 1, 1]\nscale = 1e3\n",
     {},
     "s.toml:7: obstacle.0.scale = 1e3: makes the obstacle reach beyond 1e+06 m; allowed: a smaller scale"},
    {"FeatureAngle",
     kBase + kNail + "feature_angle = 0\n",
     {},
     "s.toml:7: obstacle.0.feature_angle = 0: is out of range; allowed: a number > 0 and <= 180 (degrees)"},
    {"WideFeatureAngle",
     kBase + kNail + "feature_angle = 181\n",
     {},
     "s.toml:7: obstacle.0.feature_angle = 181: is out of range; allowed: a number > 0 and <= 180 (degrees)"},
    {"MotionAndKeyframes",
     kBase + kNail + "keyframes = [ { time = 0 } ]\nmotion = { velocity = [1, 0, 0] }\n",
     {},
     "s.toml:8: obstacle.0.motion = { velocity = [1, 0, 0] }: contradicts obstacle.0.keyframes; allowed: "
     "either motion, translate and rotate, or keyframes"},
    {"TranslateAndKeyframes",
     kBase + kNail + "keyframes = [ { time = 0 } ]\ntranslate = [1, 0, 0]\n",
     {},
     "s.toml:8: obstacle.0.translate = [1, 0, 0]: contradicts obstacle.0.keyframes; allowed: either motion, "
     "translate and rotate, or keyframes"},
    {"RotateAndKeyframes",
     kBase + kNail + "keyframes = [ { time = 0 } ]\nrotate = { axis = [0, 0, 1], degrees = 5 }\n",
     {},
     "s.toml:8: obstacle.0.rotate = { axis = [0, 0, 1], degrees = 5 }: contradicts obstacle.0.keyframes; "
     "allowed: either motion, translate and rotate, or keyframes"},
    {"NoObstacleKeyframes",
     kBase + kNail + "keyframes = []\n",
     {},
     "s.toml:7: obstacle.0.keyframes = []: is empty; allowed: one or more keyframes"},
    {"ObstacleKeyframesOutOfOrder",
     kBase + kNail + "keyframes = [ { time = 1 }, { time = 0.5 } ]\n",
     {},
     "s.toml:7: obstacle.0.keyframes.1.time = 0.5: is not later than the previous keyframe; allowed: a "
     "number "
     "> "
     "1 (s)"},
    {"ObstacleTurnsTooFarInAStep",
     kBase + kNail + "motion = { angular_velocity = [0, 0, 21000] }\n",
     {},
     "s.toml:7: obstacle.0.motion = { angular_velocity = [0, 0, 21000] }: rotates by 105 rad in a step of "
     "0.005 "
     "s; "
     "allowed: at most 16 turns (101 rad) per step; a shorter time.step allows faster rotation"},
    {"MotionStopsBeforeItStarts",
     kBase + kNail + "motion = { velocity = [1, 0, 0], start = 0.5, stop = 0.25 }\n",
     {},
     "s.toml:7: obstacle.0.motion.stop = 0.25: is not later than the motion's start; allowed: a number > 0.5 "
     "(s)"},
    {"TooManyObstacles",
     kBase + many_nails(1001),
     {},
     "s.toml:2005: obstacle.1000: is one of 1001 obstacles; allowed: at most 1000; one file or one list of "
     "points may hold many objects"},
    {"FollowNobody",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nfollow = \"table\"\n",
     {},
     "s.toml:7: pin.0.follow = \"table\": is not an obstacle; allowed: the name of an [[obstacle]]; this "
     "scene "
     "has "
     "none"},
    {"FollowAnotherName",
     kBase + kNail + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nfollow = \"table\"\n",
     {},
     "s.toml:9: pin.0.follow = \"table\": is not an obstacle; allowed: the name of an obstacle: obstacle0"},
    {"FollowAndVelocity",
     kBase + kNail + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nvelocity = [0, 0, 1]\nfollow = \"obstacle0\"\n",
     {},
     "s.toml:9: pin.0.velocity = [0, 0, 1]: contradicts pin.0.follow; allowed: either follow, or velocity, "
     "angular_velocity and pivot, or keyframes"},
    {"FollowAndKeyframes",
     kBase + kNail +
         "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nkeyframes = [ { time = 0 } ]\nfollow = "
         "\"obstacle0\"\n",
     {},
     "s.toml:9: pin.0.keyframes = [ { time = 0 } ]: contradicts pin.0.follow; allowed: either follow, or "
     "velocity, angular_velocity and pivot, or keyframes"},
    {"ClothInABox",
     kBase + "[[obstacle]]\nname = \"crate\"\nbox = [0.4, 0.4, 0.4]\ntranslate = [0.5, 0.5, 0.1]\n",
     {},
     "s.toml:5: obstacle.0: at time 0 the cloth reaches 0.1 m deep into crate, at [0.5, 0.5, 0] (m); "
     "allowed: "
     "cloth that starts clear of every obstacle; " +
         kRemedy + ", or start = \"untangle\" of the obstacle"},
    {"ClothThroughAWire",
     kBase + "[[obstacle]]\nwire = [[0.3, 0.3, -1], [0.3, 0.3, 1]]\n",
     {},
     "s.toml:5: obstacle.0: at time 0 the cloth intersects obstacle0, at [0.3, 0.3, 0] (m); allowed: cloth "
     "that starts clear of every obstacle; " +
         kRemedy},
    {"ClothOnANail",
     kBase + "[[obstacle]]\npoints = [[0.25, 0.25, 0]]\n",
     {},
     "s.toml:5: obstacle.0: at time 0 the cloth intersects obstacle0, at [0.25, 0.25, 0] (m); allowed: cloth "
     "that starts clear of every obstacle; " +
         kRemedy},
    {"SelfContactThickness",
     kBase + "[self_contact]\nthickness = 0\n",
     {},
     "s.toml:6: self_contact.thickness = 0: is out of range; allowed: a number > 0 and <= 1 (m)"},
    {"RemeshLengthsInReverse",
     kBase + "[remesh]\nedge_length = [0.1, 0.01]\n",
     {},
     "s.toml:6: remesh.edge_length = [0.1, 0.01]: has a largest edge length that is not above the smallest; "
     "allowed: two lengths, the second > 0.1 (m)"},
    {"FastKernel",
     kBase + "[solver]\nkernel = \"fast\"\n",
     {},
     "s.toml:6: solver.kernel = \"fast\": \"fast\" is not built yet in this version; allowed: \"exact\""},
    {"PlyCloth",
     "duration = 1\n[cloth]\nfile = \"cloth.ply\"\n",
     {},
     "s.toml:3: cloth.file = \"cloth.ply\": a cloth of this format is not built yet in this version; "
     "allowed: an .obj file"},
    {"PinBesideTheCloth",
     kBase + "[[pin]]\nmaterial = [[2, 0], [2, 1]]\n",
     {},
     "s.toml:6: pin.0.material = [[2, 0], [2, 1]]: holds no vertex of the cloth; the nearest is at "
     "[1, 0.5]; allowed: material coordinates of the cloth, within [[0, 0], [1, 1]] (m)"},
    {"PinBetweenVertices",
     kBase + "[[pin]]\nmaterial = [[0.1, 0.1], [0.15, 0.15]]\n",
     {},
     "s.toml:6: pin.0.material = [[0.1, 0.1], [0.15, 0.15]]: holds no vertex of the cloth; the nearest is at "
     "[0, 0]; allowed: material coordinates of the cloth, within [[0, 0], [1, 1]] (m)"},
    {"PullBesideTheCloth",
     kBase + "[[pull]]\nmaterial = [[-1, -1], [-0.5, -0.5]]\nforce = [0, 0, 1]\n",
     {},
     "s.toml:6: pull.0.material = [[-1, -1], [-0.5, -0.5]]: contains no cloth; allowed: material coordinates "
     "of "
     "the cloth, within [[0, 0], [1, 1]] (m)"},
    {"ProbeBesideTheCloth",
     kBase + "[[probe]]\nname = \"a\"\nmaterial = [0, 1.001]\n",
     {},
     "s.toml:7: probe.0.material = [0, 1.001]: is not on the cloth; allowed: material coordinates of the "
     "cloth, "
     "within [[0, 0], [1, 1]] (m)"},
    {"Vertices",
     "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [3000, 1000]\n",
     {},
     "s.toml:4: cloth.resolution = [3000, 1000]: the run would have about 6004001 vertices; allowed: at most "
     "5000000 vertices"},
    {"OverflowingVertices",
     "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [5000000, 5000000]\n",
     {},
     "s.toml:4: cloth.resolution = [5000000, 5000000]: the run would have about 5.000001e+13 vertices; "
     "allowed: at most 5000000 vertices"},
    {"Steps",
     "duration = 1e4\n" + kCloth + "[time]\nstep = 1e-6\n[output]\nframes_per_second = 0\n",
     {},
     "s.toml:6: time.step = 1e-6: the run would have about 1e+10 steps; allowed: at most 1e+08 steps"},
    {"StepsByDuration",
     "duration = 1e6\n[output]\nframes_per_second = 0\n" + kCloth,
     {},
     "s.toml:1: duration = 1e6: the run would have about 2e+08 steps; allowed: at most 1e+08 steps"},
    {"Frames",
     kBase + "[output]\nframes_per_second = 1e6\n",
     {},
     "s.toml:6: output.frames_per_second = 1e6: the run would have about 1000001 frames; allowed: at most "
     "1000000 frames"},
    {"FramesByDuration",
     "duration = 1e6\n" + kCloth,
     {},
     "s.toml:1: duration = 1e6: the run would have about 2.4e+07 frames; allowed: at most 1000000 frames"},
    {"SetWithoutValue", kBase, {"duration"}, "--set duration: is not an assignment; allowed: KEY=VALUE"},
    {"SetWithoutKey", kBase, {"=1"}, "--set =1: is not an assignment; allowed: KEY=VALUE"},
    {"SetEmptyValue",
     kBase,
     {"duration="},
     "--set duration=: has no value; allowed: KEY=VALUE, the value as in a scene file (a bare word is a "
     "string)"},
    {"SetUnknownKey",
     kBase,
     {"time.stp=0.1"},
     "--set time.stp=0.1: unknown key stp, did you mean step?; allowed: step, integrator"},
    {"SetWrongType",
     kBase,
     {"duration=soon"},
     "--set duration=soon: is not a number; allowed: a number > 0 and <= 1000000 (s)"},
    {"SetOutOfRange",
     kBase,
     {"cloth.material.density=-1"},
     "--set cloth.material.density=-1: is out of range; allowed: a number > 0 "
     "and <= 10000 (kg/m^2)"},
    {"SetBrokenArray",
     kBase,
     {"cloth.size=[1,"},
     "--set cloth.size=[1,: the value is not TOML; allowed: KEY=VALUE, the value as in a scene file (a bare "
     "word is a string)"},
    {"SetTwoValues",
     kBase,
     {"duration=1\ntitle=2"},
     "--set duration=1\\ntitle=2: the value is not TOML; allowed: KEY=VALUE, the value as in a scene file (a "
     "bare word is a string)"},
    {"SetGap",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n",
     {"pin.2.release=1"},
     "--set pin.2.release=1: 2 is not an index of pin; allowed: 0 to 1, where 1 appends"},
    {"SetGapInNothing",
     kBase,
     {"pin.1.release=1"},
     "--set pin.1.release=1: 1 is not an index of pin; allowed: 0"},
    {"SetNoIndex",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n",
     {"pin.release=1"},
     "--set pin.release=1: release is not an index of pin; allowed: 0 to 1, where 1 appends"},
    {"SetAppendsIncompletePin",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n",
     {"pin.1.release=1"},
     "--set pin.1.release=1: pin.1.material: is required and missing; allowed: [[u, v], [u, v]] (m), or "
     "pin.vertices, or pin.label"},
    {"SetBelowValue",
     kBase,
     {"duration.x=1"},
     "--set duration.x=1: duration has no keys below it; allowed: a number > 0 and <= 1000000 (s)"},
    {"SetThroughWrongType",
     "wind = 3\n" + kBase,
     {"wind.velocity=[1,0,0]"},
     "--set wind.velocity=[1,0,0]: line 1 of the file gives wind another type; allowed: a table, [wind]"},
    {"SetNotBuilt",
     kBase,
     {"solver.kernel=fast"},
     "--set solver.kernel=fast: \"fast\" is not built yet in this version; "
     "allowed: \"exact\""},
    {"SetObstacle",
     kBase,
     {"obstacle.0.box=[1,1]"},
     "--set obstacle.0.box=[1,1]: has the wrong number of entries; allowed: 3 "
     "numbers "
     "from 1e-06 to 10000 (m)"},
    {"SetPointForABox",
     kBase + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n",
     {"pin.0.material=[0,0.5]"},
     "--set pin.0.material=[0,0.5]: is not an array of points, such as [[0, 0.5], [0, 0.5]] for this point "
     "alone; allowed: [[u, v], [u, v]], least then greatest, numbers from -1000000 to 1000000 (m)"},
    {"SetNumbersForALine",
     kBase + "folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = 90 } ]\n",
     {"cloth.folds.0.line=[0, 1]"},
     "--set cloth.folds.0.line=[0, 1]: is not an array of points, such as [[0.5, 0], [0.5, 1]]; allowed: two "
     "different points, [[u, v], [u, v]], numbers from -1000000 to 1000000 (m)"},
    {"SetNumbersForPoints",
     kBase,
     {"obstacle.0.points=[0,0,9]"},
     "--set obstacle.0.points=[0,0,9]: is not an array of points, such as [[0, 0, 0], [1, 0, 0]]; allowed: 1 "
     "or more points [x, y, z], numbers from -1000000 to 1000000 (m)"},
    {"SetTableWithAWrongValue",
     kBase,
     {"wind={velocity=[1,0]}"},
     "--set wind={velocity=[1,0]}: wind.velocity = [1,0]: has the wrong number of entries; allowed: 3 "
     "numbers "
     "from -1000000 to 1000000 (m/s)"},
    {"SetKernel",
     kBase,
     {"solver.kernel=fast"},
     "--set solver.kernel=fast: \"fast\" is not built yet in this version; allowed: "
     "\"exact\""},
    {"SetControlCharacters",
     kBase,
     {"cloth.pattern=\"a\\u001b\""},
     "--set cloth.pattern=\"a\\u001b\": is not one of the choices; allowed: "
     "\"diagonal\", \"alternating\", \"cross\", \"unstructured\""},
    {"LongValue",
     "duration = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21]\n",
     {},
     "s.toml:1: duration = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, \342\200\246: is not "
     "a number; allowed: a number > 0 and <= 1000000 (s)"},
    {"ValueOnSeveralLines",
     "duration = 1\n[cloth]\nresolution = [2, 2]\nsize = [1,\n  2,\n  3]\n",
     {},
     "s.toml:4: cloth.size = [1,   2,   3]: has the wrong number of entries; allowed: 2 numbers from 1e-06 "
     "to 10000 (m)"},
    {"UnicodeBeforeValue",
     "cloth = { \"\303\274\" = 1 }\n",
     {},
     "s.toml:1: duration: is required and missing; allowed: a number > 0 and <= 1000000 (s)"},
};

INSTANTIATE_TEST_SUITE_P(Scene, WrongSceneTest, ::testing::ValuesIn(kWrongScenes),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace arris
