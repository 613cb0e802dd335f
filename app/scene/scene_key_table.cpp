// SPDX-License-Identifier: GPL-3.0-or-later
// The table of all keys of a scene file: the one place to edit for a new key.
#include <array>

#include "app/scene/scene_keys.h"

namespace arris {
namespace {

// Bounds no cloth comes near; they keep every product of two values finite.
constexpr KeyRange kAnyNumber{-1e6, 1e6};
constexpr KeyRange kPositive{0.0, 1e6, true};
constexpr KeyRange kNotNegative{0.0, 1e6};
constexpr KeyRange kSize{1e-6, 1e4};
constexpr KeyRange kAngle{-360.0, 360.0};
constexpr KeyRange kTitle{0.0, 200.0};
constexpr KeyRange kPath{1.0, 4096.0};

constexpr std::string_view kUnits = "m|cm|mm|in";
constexpr std::string_view kAxes = "x|y|z";
constexpr std::string_view kOrigin = "[0.0, 0.0, 0.0]";
constexpr std::string_view kIdentity = R"({"axis": [0.0, 0.0, 1.0], "degrees": 0.0})";
constexpr std::string_view kNever = "null";

SceneKey table(std::string_view name, std::string_view fallback, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Table, .fallback = fallback, .sentence = sentence};
}

SceneKey tables(std::string_view name, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Tables, .sentence = sentence};
}

SceneKey number(std::string_view name, std::string_view unit, KeyRange range, std::string_view fallback,
                std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Number,
            .unit = unit,
            .range = range,
            .fallback = fallback,
            .sentence = sentence};
}

SceneKey integer(std::string_view name, KeyRange range, std::string_view fallback, std::string_view sentence)
{
    return {
        .name = name, .type = KeyType::Integer, .range = range, .fallback = fallback, .sentence = sentence};
}

SceneKey numbers(std::string_view name, int count, std::string_view unit, KeyRange range,
                 std::string_view fallback, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Numbers,
            .unit = unit,
            .range = range,
            .count = count,
            .fallback = fallback,
            .sentence = sentence};
}

SceneKey points(std::string_view name, int least, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Points,
            .unit = "m",
            .range = kAnyNumber,
            .count = least,
            .sentence = sentence};
}

SceneKey box(std::string_view name, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Box,
            .unit = "m",
            .range = kAnyNumber,
            .fallback = kRequired,
            .sentence = sentence};
}

SceneKey text(std::string_view name, KeyType type, KeyRange range, std::string_view fallback,
              std::string_view sentence)
{
    return {.name = name, .type = type, .range = range, .fallback = fallback, .sentence = sentence};
}

SceneKey axis(std::string_view name)
{
    return {.name = name,
            .type = KeyType::Axis,
            .range = kAnyNumber,
            .count = 3,
            .fallback = kRequired,
            .sentence = "Axis of the rotation, of any length but zero."};
}

SceneKey choice(std::string_view name, std::string_view choices, std::string_view fallback,
                std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Choice,
            .choices = choices,
            .fallback = fallback,
            .sentence = sentence};
}

SceneKey choices(std::string_view name, int least, std::string_view all, std::string_view fallback,
                 std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Choices,
            .count = least,
            .choices = all,
            .fallback = fallback,
            .sentence = sentence};
}

SceneKey boolean(std::string_view name, std::string_view fallback, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Boolean, .fallback = fallback, .sentence = sentence};
}

/// Marks a key, and with it everything below, as belonging to a part that is not built yet.
SceneKey not_built(SceneKey key)
{
    key.is_built = false;
    return key;
}

/// Marks single values of a key as not built yet.
SceneKey not_built(SceneKey key, std::string_view values)
{
    key.unbuilt_choices = values;
    return key;
}

std::vector<SceneKey> make_scene_keys()
{
    return {
        text("title", KeyType::Text, kTitle, "(the scene file's name)", "What the run is called in reports."),
        number("duration", "s", kPositive, kRequired, "Simulated time."),

        table("time", "{}", "How time advances."),
        number("time.step", "s", kPositive, "0.005",
               "The longest step; each interval between frames and events is divided into equal steps no "
               "longer."),
        choice("time.integrator", "bdf2|implicit_euler", R"("bdf2")",
               "Second order (bdf2), or first order with more numerical damping (implicit_euler)."),

        table("cloth", "{}", "The cloth: a rectangle to be meshed, or a mesh from a file."),
        numbers("cloth.size", 2, "m", kSize, "",
                "Sides of the material rectangle, u then v; required without `file`."),
        {.name = "cloth.resolution",
         .type = KeyType::Integers,
         .range = {1.0, 5e6},
         .count = 2,
         .sentence = "Cells along u and v; required without `file`."},
        choice("cloth.pattern", "diagonal|alternating|cross|unstructured", R"("cross")",
               "How the cells are cut into triangles."),
        number("cloth.pattern_angle", "degrees", kAngle, "0.0",
               "Turn of the pattern inside the rectangle, to which it is clipped."),
        tables("cloth.folds", "Folds of the cloth at the start, bent isometrically one after the other."),
        {.name = "cloth.folds[].line",
         .type = KeyType::Line,
         .unit = "m",
         .range = kAnyNumber,
         .fallback = kRequired,
         .sentence = "Two material points; the line through them is cut into the mesh, and what lies right "
                     "of it is turned."},
        number("cloth.folds[].degrees", "degrees", {-180.0, 180.0}, kRequired,
               "How far the material right of the line is turned down about it."),
        text("cloth.file", KeyType::Path, kPath, "",
             "OBJ mesh used instead of a rectangle: its positions are the initial world positions, its UVs, "
             "in metres, "
             "the material coordinates (a flat mesh without UVs is its own chart)."),
        choice("cloth.units", kUnits, R"("m")", "Unit of the file's positions."),
        choice("cloth.up", kAxes, R"("z")", "The file's upward axis, turned to +z."),
        numbers("cloth.translate", 3, "m", kAnyNumber, kOrigin,
                "World position = translate + rotate(scale * (u, v, 0)); of a file, of its positions."),
        table("cloth.rotate", kIdentity, "Rotation of the cloth at the start."),
        axis("cloth.rotate.axis"),
        number("cloth.rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        number("cloth.scale", "", kPositive, "1.0",
               "Scale of the world positions; the material keeps its size, so cloth scaled by other than 1 "
               "starts strained."),
        numbers("cloth.velocity", 3, "m/s", kAnyNumber, kOrigin, "Velocity of the whole cloth at the start."),

        table("cloth.material", "{}", "What the cloth is made of."),
        choice("cloth.material.preset", "cotton|silk|wool|denim|leather|rubber", R"("cotton")",
               "A material to start from; the keys below override it one by one."),
        number("cloth.material.density", "kg/m^2", {0.0, 1e4, true}, "(the preset's)", "Mass per area."),
        number("cloth.material.youngs_modulus", "N/m", {0.0, 1e12, true}, "(the preset's)",
               "Membrane stiffness: tension per width at unit strain."),
        number("cloth.material.poisson_ratio", "", {0.0, 0.5}, "(the preset's)",
               "How much the sheet narrows where it is stretched."),
        number("cloth.material.bending_stiffness", "J", kNotNegative, "(the preset's)",
               "K of the hinge energy; 0 leaves bending out."),
        number("cloth.material.damping", "s", {0.0, 1e3}, "0.0",
               "Damping proportional to the elastic stiffness; 0 leaves damping out."),
        number("cloth.material.thickness", "m", {0.0, 1.0, true}, "0.001",
               "The distance kept between the cloth's surface and obstacles."),

        tables("pin", "Vertices that are held or moved; without one nothing holds the cloth."),
        box("pin[].material", "Vertices whose material coordinates lie in this box are held (inclusive)."),
        numbers("pin[].velocity", 3, "m/s", kAnyNumber, kOrigin, "Velocity at which the pin moves."),
        numbers("pin[].angular_velocity", 3, "rad/s", kAnyNumber, kOrigin,
                "Rotation of the pin about `pivot`, along its axis."),
        numbers("pin[].pivot", 3, "m", kAnyNumber, kOrigin,
                "World point that `angular_velocity` turns about."),
        tables("pin[].keyframes",
               "The pin's motion as placements in time instead: x(t) = translate + R x(0); translation "
               "linear, rotation "
               "slerp by the shorter arc, constant outside."),
        number("pin[].keyframes[].time", "s", kNotNegative, kRequired,
               "When; later than the keyframe before."),
        numbers("pin[].keyframes[].translate", 3, "m", kAnyNumber, kOrigin, "Translation then."),
        table("pin[].keyframes[].rotate", kIdentity,
              "Rotation then, about the world's origin; between keyframes by the shorter arc."),
        axis("pin[].keyframes[].rotate.axis"),
        number("pin[].keyframes[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        text("pin[].follow", KeyType::Name, {}, "",
             "Name of an obstacle that the pin rides on instead: what it holds moves as if fixed to it."),
        choices("pin[].directions", 1, kAxes, R"(["x", "y", "z"])", "Which world components are held."),
        number("pin[].release", "s", kNotNegative, kNever, "When the pin lets go."),

        table("gravity", "", "Switches gravity on."),
        numbers("gravity.acceleration", 3, "m/s^2", kAnyNumber, "[0.0, 0.0, -9.81]",
                "Acceleration of free fall."),

        table("wind", "",
              "Switches wind on: a force rho/2 drag A |w_n| w_n n on every face, w = wind - material "
              "velocity."),
        numbers("wind.velocity", 3, "m/s", kAnyNumber, kRequired, "Velocity of the air."),
        number("wind.air_density", "kg/m^3", kNotNegative, "1.2", "Density of the air."),
        number("wind.drag", "", kNotNegative, "1.0", "Drag coefficient of a face, on its world area."),
        table("wind.gust", "",
              "Makes the wind vary: times 1 + amplitude sin(2 pi frequency t + phase(seed))."),
        number("wind.gust.amplitude", "", kNotNegative, kRequired, "Share of the wind that varies."),
        number("wind.gust.frequency", "Hz", kNotNegative, kRequired, "How often it varies."),
        integer("wind.gust.seed", {0.0, 2147483647.0}, "0", "Chooses the phase."),

        tables("pull",
               "A force spread over a material box: by area, by length where it is a line, on the nearest "
               "vertex for a point."),
        box("pull[].material", "The part of the cloth that is pulled (inclusive)."),
        numbers("pull[].force", 3, "N", {-1e9, 1e9}, kRequired, "The force in all."),
        number("pull[].start", "s", kNotNegative, "0.0", "When the force begins."),
        number("pull[].stop", "s", kPositive, kNever, "When the force ends; later than `start`."),

        not_built(table("friction", "", "Switches friction with obstacles on.")),
        number("friction.coefficient", "", {0.0, 100.0}, "0.3",
               "Coulomb's coefficient; an obstacle's own overrides it."),

        not_built(table("self_contact", "", "Switches contact of the cloth with itself on.")),

        table("eol", "{}", "Eulerian-on-Lagrangian vertices on sharp features of obstacles."),
        boolean(
            "eol.enabled", "true",
            "Whether vertices are put exactly on sharp features, with the material flowing through them."),

        not_built(table("remesh", "",
                        "Switches adaptive refinement on; without it the mesh changes only near features.")),
        numbers("remesh.edge_length", 2, "m", kPositive, "[0.01, 0.1]", "Smallest and largest edge."),
        number("remesh.angle", "degrees", {0.0, 180.0, true}, "10.0", "Turn allowed over one edge."),
        number("remesh.compression", "", {0.0, 1.0, true}, "0.005",
               "Compressive strain allowed over one edge."),
        number("remesh.velocity", "m/s", kPositive, "0.5", "Velocity difference allowed over one edge."),
        number("remesh.aspect", "", {0.0, 0.8, true}, "0.2", "Least height of a face by its longest edge."),

        tables("obstacle", "A rigid obstacle: one of `file`, `box`, `points`, `wire`, `teeth`."),
        text("obstacle[].name", KeyType::Name, {}, "(obstacle0, obstacle1, …)",
             "What its frames are called; unique among obstacles and probes, not `cloth`."),
        text("obstacle[].file", KeyType::Path, kPath, "",
             "OBJ, STL, PLY, glTF/GLB, COLLADA, FBX, 3MF or 3DS mesh."),
        choice("obstacle[].units", kUnits, "(what the file declares, else m)", "Unit of the file."),
        choice("obstacle[].up", kAxes, "(what the file declares, else z)", "The file's upward axis."),
        numbers("obstacle[].box", 3, "m", kSize, "", "A box of these sizes, centred on its origin."),
        points("obstacle[].points", 1, "Nails: lone points."),
        points("obstacle[].wire", 2, "A polyline."),
        boolean("obstacle[].closed", "false", "Whether the `wire`'s end is joined to its beginning."),
        table("obstacle[].teeth", "",
              "A row of prisms along x, their ridges along y, on a base: tips at z = height, valleys at z = "
              "0, the "
              "bottom at z = -height; centred in x and y."),
        integer("obstacle[].teeth.count", {1.0, 1e4}, kRequired, "How many."),
        number("obstacle[].teeth.pitch", "m", kSize, kRequired,
               "Distance from ridge to ridge; at least a ridge's width at its foot, 2 height tan(tip_degrees "
               "/ 2)."),
        number("obstacle[].teeth.height", "m", kSize, kRequired, "Height of the ridges above the valleys."),
        number("obstacle[].teeth.width", "m", kSize, kRequired, "Length of the ridges."),
        number("obstacle[].teeth.tip_degrees", "degrees", {0.0, 179.0, true}, kRequired,
               "Angle at the ridges."),
        numbers("obstacle[].translate", 3, "m", kAnyNumber, kOrigin,
                "World position = translate + rotate(scale * position)."),
        table("obstacle[].rotate", kIdentity, "Rotation of the obstacle."),
        axis("obstacle[].rotate.axis"),
        number("obstacle[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        number("obstacle[].scale", "", kPositive, "1.0", "Scale of the obstacle, about its origin."),
        number("obstacle[].feature_angle", "degrees", {0.0, 180.0, true}, "30.0",
               "A convex edge whose faces turn by more (+ 1e-6) is sharp."),
        table("obstacle[].motion", "",
              "p(t) = pivot + velocity tau + R(angular_velocity tau)(p0 - pivot), tau = clamp(t - start, 0, "
              "stop - start)."),
        numbers("obstacle[].motion.velocity", 3, "m/s", kAnyNumber, kOrigin, "Velocity."),
        numbers("obstacle[].motion.angular_velocity", 3, "rad/s", kAnyNumber, kOrigin,
                "Rotation about `pivot`."),
        numbers("obstacle[].motion.pivot", 3, "m", kAnyNumber, kOrigin, "World point that is turned about."),
        number("obstacle[].motion.start", "s", kNotNegative, "0.0", "When the motion begins."),
        number("obstacle[].motion.stop", "s", kPositive, kNever, "When the motion ends; later than `start`."),
        tables(
            "obstacle[].keyframes",
            "Placements in time, instead of `motion`, `translate` and `rotate`: translation linear, rotation "
            "slerp by the shorter arc, constant outside."),
        number("obstacle[].keyframes[].time", "s", kNotNegative, kRequired,
               "When; later than the keyframe before."),
        numbers("obstacle[].keyframes[].translate", 3, "m", kAnyNumber, kOrigin, "Translation then."),
        table("obstacle[].keyframes[].rotate", kIdentity, "Rotation then."),
        axis("obstacle[].keyframes[].rotate.axis"),
        number("obstacle[].keyframes[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        not_built(number(
            "obstacle[].friction", "", {0.0, 100.0}, "",
            "Coulomb's coefficient of this obstacle; without [friction] it switches friction on for it.")),

        tables("probe", "A material point whose path is written to probes.csv."),
        text("probe[].name", KeyType::Name, {}, kRequired,
             "What its columns are called; unique among obstacles and probes, not `cloth`."),
        numbers("probe[].material", 2, "m", kAnyNumber, kRequired, "The material point, u and v."),

        table("solver", "{}", "Numbers of the solver."),
        number("solver.tolerance", "", {1e-14, 1e-2}, "1e-9", "Greatest relative KKT residual accepted."),
        not_built(choice("solver.kernel", "exact|fast", R"("exact")",
                         "Exact or plain floating-point geometric predicates."),
                  "fast"),

        table("output", "{}", "What a run leaves behind."),
        number("output.frames_per_second", "1/s", kNotNegative, "24.0",
               "Frames a second of simulated time; 0: no frames."),
        not_built(choices("output.formats", 0, "obj|usd|vtk|viewer|gltf|pc2", R"(["viewer"])",
                          "Formats made from the frames, besides the PLY frames that are always written."),
                  "vtk|gltf|pc2"),
    };
}

}  // namespace

const std::vector<SceneKey>& scene_keys()
{
    static const std::vector<SceneKey> keys = make_scene_keys();
    return keys;
}

}  // namespace arris
