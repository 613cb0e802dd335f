// SPDX-License-Identifier: GPL-3.0-or-later
// The table of all keys of a scene file. A new key is added here and nowhere else.
#include <deque>
#include <string>

#include "app/scene/keys/pattern_keys.h"
#include "app/scene/keys/scene_key_kinds.h"

namespace arris {
namespace {

/// Keys of a material, below "cloth.material" or "fabric[]".
std::vector<SceneKey> material_keys(const std::string& parent)
{
    static std::deque<std::string> names;  // keys refer to their names
    const auto below = [&](const char* leaf) -> std::string_view {
        return names.emplace_back(parent + "." + leaf);
    };
    return {
        choice(below("preset"), "cotton|silk|wool|denim|leather|rubber", R"("cotton")",
               "Material preset; each key below overrides one of its values."),
        number(below("density"), "kg/m^2", {0.0, 1e4, true}, "(the preset's)", "Mass per area."),
        number(below("youngs_modulus"), "N/m", {0.0, 1e12, true}, "(the preset's)",
               "Membrane stiffness: tension per width at unit strain."),
        number(below("poisson_ratio"), "", {0.0, 0.5}, "(the preset's)",
               "Poisson's ratio: lateral contraction per extension."),
        number(below("bending_stiffness"), "J", kNotNegative, "(the preset's)",
               "Bending stiffness K, bending moment per width and curvature; 0 switches bending off."),
        choice(
            below("bending_model"), "hinge|plate", R"("hinge")",
            "Bending model: every hinge for itself, with a rigidity that depends on the mesh (hinge), or a "
            "plate whose rigidity is K on any mesh (plate)."),
        number(below("damping"), "s", {0.0, 1e3}, "0.0",
               "Damping proportional to the elastic stiffness; 0 switches damping off."),
        number(below("thickness"), "m", {0.0, 1.0, true}, "0.001",
               "Distance that contacts keep between the cloth's surface and obstacles; of several pieces the "
               "greatest counts for all."),
        number(
            below("compression_modulus"), "Pa", {0.0, 1e12, true}, "1e4",
            "Pressure with which cloth between obstacles resists, per share of the thickness by which it is "
            "squeezed."),
        number(below("friction"), "", {0.0, 100.0}, "",
               "Coefficient of Coulomb friction of this cloth; without it `friction.coefficient`. That of an "
               "obstacle overrides it. Between two layers the mean of both counts. Without [friction] this "
               "key switches friction on for this cloth."),
    };
}

std::vector<SceneKey> make_scene_keys()
{
    std::vector<SceneKey> keys = {
        text("title", KeyType::Text, kTitle, "(the scene file's name)", "Title of the run in reports."),
        number("duration", "s", kPositive, kRequired, "Simulated time."),

        table("time", "{}", "Time integration."),
        number("time.step", "s", kPositive, "0.005",
               "Longest step. Each interval between frames and events is divided into equal steps, none "
               "longer than this."),
        choice(
            "time.integrator", "bdf2|implicit_euler", R"("bdf2")",
            "Integrator: second order (bdf2), or first order with more numerical damping (implicit_euler)."),

        repeatable(table(
            "cloth", "{}",
            "The cloth: a rectangle or an outline to be meshed, a mesh from a file, or panels that are sewn "
            "together. Several `[[cloth]]` are pieces of cloth, each with its own place and material.")),
        text("cloth.name", KeyType::Name, {}, "(of several: piece0, piece1, …)",
             "Name of the piece; unique among pieces, obstacles and probes, not `cloth`."),
        text("cloth.fabric", KeyType::Name, {}, "",
             "Name of a `[[fabric]]`, of which the cloth is made; instead of `[cloth.material]`."),
        numbers("cloth.size", 2, "m", kSize, "",
                "Sides of the material rectangle, u then v; required without `outline` and `file`."),
        {.name = "cloth.resolution",
         .type = KeyType::Integers,
         .range = {1.0, 5e6},
         .count = 2,
         .sentence = "Cells along u and v; required with `size`."},
        choice("cloth.pattern", "diagonal|alternating|cross|unstructured", R"("cross")",
               "Pattern in which the cells are divided into triangles."),
        number("cloth.pattern_angle", "degrees", kAngle, "0.0",
               "Rotation of the mesh pattern in the material; the pattern is clipped to the rectangle."),
        polygon("cloth.outline", KeyType::Polygon,
                "Polygon in the material instead of a rectangle, clockwise or counter-clockwise. Its sides "
                "must neither cross nor touch. Corners that are finer than `edge_length` are left out where "
                "the border moves by at most 7 % of it."),
        polygon("cloth.holes", KeyType::Polygons,
                "Holes: polygons inside the outline, clear of it and of one another."),
        number(
            "cloth.edge_length", "m", kSize, "",
            "Mean length of the mesh's edges; required with `outline` and with panels. It must be below the "
            "outline's diagonal, and change the outline's area by at most 10 %."),
        tables("cloth.folds", "Folds of the initial cloth, made one after the other without stretching it."),
        {.name = "cloth.folds[].line",
         .type = KeyType::Line,
         .unit = "m",
         .range = kAnyNumber,
         .fallback = kRequired,
         .sentence = "Two material points. The line through them becomes edges of the mesh, and the material "
                     "to the right of the line is rotated about it."},
        number("cloth.folds[].degrees", "degrees", {-179.9, 179.9}, kRequired,
               "Angle by which the material to the right of the line is rotated downward. At 180 degrees "
               "the two layers would coincide, and neither would be above the other."),
        text("cloth.file", KeyType::Path, kPath, "",
             "OBJ mesh used instead of a rectangle or an outline. Its positions are the initial world "
             "positions; its UVs, "
             "times `uv_scale`, are the material coordinates. Places with several UVs are seams, along which "
             "the "
             "cloth is sewn. A flat mesh without UVs takes the material "
             "coordinates from its positions; flat pieces in different planes, such as layers, are laid side "
             "by "
             "side along u, a tenth of the widest apart."),
        choice("cloth.units", kUnits, R"("m")", "Unit of the file's positions."),
        choice("cloth.up", kAxes, "(z; of a pattern_file y)",
               "Upward axis of the file, which is rotated to +z."),
        number("cloth.uv_scale", "m", {0.0, 1e3, true}, "1.0",
               "Length of a unit of the file's UVs. Where UVs run from 0 to 1, it is the size of the cloth."),
        numbers("cloth.translate", 3, "m", kAnyNumber, kOrigin,
                "World position = translate + rotate(scale * (u, v, 0)). For a file, its positions replace "
                "(u, v, 0)."),
        table("cloth.rotate", kIdentity, "Initial rotation of the cloth."),
        axis("cloth.rotate.axis"),
        number("cloth.rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        number("cloth.scale", "", kPositive, "1.0",
               "Scale of the world positions. The material keeps its size, so a scale other than 1 makes the "
               "cloth start strained."),
        numbers("cloth.velocity", 3, "m/s", kAnyNumber, kOrigin, "Initial velocity of the whole cloth."),

    };
    const auto append = [&](std::vector<SceneKey> more) {
        keys.insert(keys.end(), more.begin(), more.end());
    };
    append(pattern_keys());
    append({table("cloth.material", "{}", "Material properties of the cloth.")});
    append(material_keys("cloth.material"));
    append({
        tables("fabric", "A material with a name, of which any number of pieces may be made."),
        text("fabric[].name", KeyType::Name, {}, kRequired, "Name of the fabric; unique among fabrics."),
    });
    append(material_keys("fabric[]"));
    append({
        tables("pin", "Pins hold or move vertices. Without a pin nothing holds the cloth."),
        optional(
            box("pin[].material",
                "Box in the material, bounds included. The pin holds the vertices whose material coordinates "
                "lie in the box. About a line of held vertices the cloth turns freely, so a clamped edge "
                "needs a box that holds two rows of vertices. Required without `vertices` and `label`.")),
        indices(
            "pin[].vertices",
            "Vertices to hold, instead of `material`: of `cloth.file`, counted from 0 in the order of its "
            "`v` lines; without a file, of the first mesh. The pin holds the material between them, too: "
            "edges and faces whose corners all are among the vertices."),
        text("pin[].label", KeyType::Text, kTitle, "",
             "Label of edges of panels, which the pin holds instead of a box. It holds them during the "
             "assembly, too."),
        text("pin[].piece", KeyType::Name, {}, "",
             "Name of the piece of cloth that the box or the vertices are of; required where there are "
             "several."),
        text("pin[].panel", KeyType::Name, {}, "",
             "Name of the panel that the box is of; required where a piece has several."),
        numbers("pin[].velocity", 3, "m/s", kAnyNumber, kOrigin, "Velocity of the pin from its `start` on."),
        numbers("pin[].angular_velocity", 3, "rad/s", kAnyNumber, kOrigin,
                "Angular velocity of the pin about `pivot` from its `start` on; its direction is the axis."),
        numbers("pin[].pivot", 3, "m", kAnyNumber, kOrigin,
                "World point about which `angular_velocity` rotates."),
        tables("pin[].keyframes",
               "Motion of the pin as placements P(t) in time, instead of velocities: x(t) = translate + R "
               "x(0). With a later `start`, x(t) = P(t) P(start)^-1 x(start). Translations are interpolated "
               "linearly, rotations by slerp along the shorter arc; before the first and after the last "
               "keyframe the placement is constant."),
        number("pin[].keyframes[].time", "s", kNotNegative, kRequired,
               "Time of the keyframe, counted from time 0; later than the previous keyframe."),
        numbers("pin[].keyframes[].translate", 3, "m", kAnyNumber, kOrigin, "Translation at this time."),
        table("pin[].keyframes[].rotate", kIdentity, "Rotation at this time, about the world's origin."),
        axis("pin[].keyframes[].rotate.axis"),
        number("pin[].keyframes[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        text("pin[].follow", KeyType::Name, {}, "",
             "Name of an obstacle that moves the pin, instead of velocities or keyframes. The held vertices "
             "move as if fixed to the obstacle."),
        choices("pin[].directions", 1, kAxes, R"(["x", "y", "z"])",
                "Components of the world position that the pin holds."),
        number("pin[].start", "s", kNotNegative, "0.0",
               "Time at which the pin takes hold. After time 0, it holds the vertices that are then in the "
               "material (or the nearest one, where the mesh has changed) at the places where they are."),
        number("pin[].release", "s", kNotNegative, kNever,
               "Time at which the pin releases its vertices; later than `start`. Other pins that hold them "
               "then hold them where they are."),

        table("gravity", "", "Switches gravity on."),
        numbers("gravity.acceleration", 3, "m/s^2", kAnyNumber, "[0.0, 0.0, -9.81]",
                "Acceleration of free fall."),

        table("wind", "",
              "Switches wind on: a force rho/2 drag A |w_n| w_n n on every face, with w = wind - material "
              "velocity and w_n = w . n."),
        numbers("wind.velocity", 3, "m/s", kAnyNumber, kRequired, "Velocity of the air."),
        number("wind.air_density", "kg/m^3", kNotNegative, "1.2", "Density of the air."),
        number("wind.drag", "", kNotNegative, "1.0", "Drag coefficient of a face, on its world area."),
        table("wind.gust", "",
              "Multiplies the wind's velocity by 1 + amplitude sin(2 pi frequency t + phase(seed))."),
        number("wind.gust.amplitude", "", kNotNegative, kRequired,
               "Amplitude of the variation, relative to the wind's velocity."),
        number("wind.gust.frequency", "Hz", kNotNegative, kRequired, "Frequency of the variation."),
        integer("wind.gust.seed", {0.0, 2147483647.0}, "0", "Seed that determines the phase."),

        tables("pull",
               "A force spread over a box of the material: by area; by length where the box is a line; on "
               "the nearest vertex where the box is a point."),
        box("pull[].material", "Box in the material, bounds included: the part of the cloth that is pulled."),
        text("pull[].piece", KeyType::Name, {}, "",
             "Name of the piece of cloth that the box is of; required where there are several."),
        text("pull[].panel", KeyType::Name, {}, "",
             "Name of the panel that the box is of; required where a piece has several."),
        numbers("pull[].force", 3, "N", {-1e9, 1e9}, kRequired, "Total force of the pull."),
        number("pull[].start", "s", kNotNegative, "0.0", "Time at which the force begins."),
        number("pull[].stop", "s", kPositive, kNever, "Time at which the force ends; later than `start`."),

        table("friction", "", "Switches friction on."),
        number("friction.coefficient", "", {0.0, 100.0}, "0.3",
               "Coefficient of Coulomb friction with obstacles and, with `[self_contact]`, between layers; "
               "their "
               "own coefficients override it."),

        table("self_contact", "",
              "Switches contact of the cloth with itself on, and of several pieces with each other."),
        number("self_contact.thickness", "m", {0.0, 1.0, true}, "",
               "Distance kept between the middle surfaces of two layers; without it the cloth's "
               "`material.thickness`."),
        number(
            "self_contact.friction", "", {0.0, 100.0}, "",
            "Coefficient of Coulomb friction between layers; without it `friction.coefficient`, or 0 without "
            "`[friction]`."),

        choice("self_contact.start", kStarts, R"("clear")",
               "Where layers cross or touch at time 0: an error (clear), or they are moved apart by the "
               "shortest way (untangle)."),

        table("eol", "{}", "Eulerian-on-Lagrangian (EOL) vertices on sharp features of obstacles."),
        boolean("eol.enabled", "true",
                "Whether vertices of the cloth are placed exactly on sharp features, with material flowing "
                "through them."),

        table("remesh", "",
              "Switches adaptive remeshing on: cells become finer where the cloth bends, buckles or moves "
              "unevenly, and coarser elsewhere. Without it the mesh changes only near sharp features."),
        numbers("remesh.edge_length", 2, "m", kPositive, "[0.01, 0.1]",
                "Smallest and largest edge length to aim at; edges may have half the smallest, and half as "
                "much again as the largest. The largest grows where it needs more than `vertices`."),
        number("remesh.angle", "degrees", {0.0, 180.0, true}, "30.0",
               "Angle by which the surface may turn over one edge."),
        integer("remesh.vertices", {3.0, 1e7}, "",
                "Number of vertices from which on no edge is split because it is too long, and which coarser "
                "cells everywhere aim at. One step's changes and EOL vertices may exceed it, seldom by a "
                "third. Without it eight times the first mesh's."),
        number("remesh.compression", "", {0.0, 1.0, true}, "0.005",
               "Compressive strain above which cells become finer, so that the cloth can buckle."),
        number("remesh.velocity", "m/s", kPositive, "0.5", "Velocity difference allowed over one edge."),
        number("remesh.aspect", "", {0.0, 0.8, true}, "0.2",
               "Smallest height of a face relative to its longest edge; thinner faces are opened."),

        tables("obstacle",
               "An obstacle, rigid unless it has `deform`; its shape is one of `file`, `box`, `points`, "
               "`wire`, `teeth`."),
        text(
            "obstacle[].name", KeyType::Name, {}, "(obstacle0, obstacle1, …)",
            "Name of the obstacle and of its exported frames; unique among pieces, obstacles and probes, not "
            "`cloth`."),
        text("obstacle[].file", KeyType::Path, kPath, "",
             "OBJ, STL, PLY, glTF/GLB, COLLADA, FBX, 3MF or 3DS mesh."),
        choice("obstacle[].units", kUnits, "(what the file declares, else m)", "Unit of the file."),
        choice("obstacle[].up", kAxes, "(what the file declares, else z)", "Upward axis of the file."),
        table(
            "obstacle[].deform", "",
            "Positions of the file's vertices in time, in the units and axes of `file`, which is OBJ or PLY "
            "and gives faces and the vertices' order; or the animation of a glTF `file`. Before the first "
            "and "
            "after the last sample the mesh is held. Placement and motion act on top."),
        text("obstacle[].deform.file", KeyType::Path, kPath, "(the obstacle's own glTF file)",
             "MDD, PC2 or USD text (.usda) file, or OBJ files with a number in their names: `body_%04d.obj`, "
             "`body_%d.obj`. Required unless `file` is glTF, which its own animation moves."),
        text("obstacle[].deform.prim", KeyType::Text, kPath,
             "(the only Mesh with samples of points, else the only one)",
             "Path of the Mesh in a USD file, such as `/root/body`."),
        text("obstacle[].deform.animation", KeyType::Text, kTitle, "(the only one)",
             "Name of the animation in a glTF file."),
        number(
            "obstacle[].deform.frames_per_second", "1/s", kPositive,
            "(times of MDD, time codes per second of USD, else 24)",
            "Frames per second. Samples are a frame apart, in PC2 as many as the file says; in USD a frame "
            "is a time code. A glTF animation is sampled at each frame from its first to its last key."),
        number("obstacle[].deform.start", "s", kAnyNumber, "0.0", "Time of the first sample used."),
        number("obstacle[].deform.speed", "", kPositive, "1.0", "Speed of the replay."),
        integer("obstacle[].deform.first", {0.0, 1e9}, "(the first)",
                "First sample used, counted from 0; of OBJ files the number in the name."),
        integer("obstacle[].deform.last", {0.0, 1e9}, "(the last)", "Last sample used."),
        choice("obstacle[].deform.interpolation", "cubic|linear", R"("cubic")",
               "Motion between samples. With `linear` the velocity jumps at each sample, and a step ends "
               "there."),
        number("obstacle[].deform.slit", "m", kPositive, "(none)",
               "Room made for cloth between parts of the body that come together or cross, such as arm and "
               "trunk: their skin retreats until they are this far apart, at least 2.5 times the cloth's "
               "thickness."),
        numbers("obstacle[].box", 3, "m", kSize, "", "Side lengths of a box that is centred on its origin."),
        points("obstacle[].points", 1, "Nails: lone points."),
        points("obstacle[].wire", 2, "Wire: a polyline through these points."),
        boolean("obstacle[].closed", "false", "Whether the end of the `wire` is joined to its beginning."),
        table("obstacle[].teeth", "",
              "A row of prisms along x on a base, with ridges along y: ridges at z = height, valleys at z = "
              "0, bottom at z = -height; centred in x and y."),
        integer("obstacle[].teeth.count", {1.0, 1e4}, kRequired, "Number of prisms."),
        number("obstacle[].teeth.pitch", "m", kSize, kRequired,
               "Distance between neighbouring ridges; at least the width of a prism at its foot, 2 height "
               "tan(tip_degrees / 2)."),
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
        number("obstacle[].scale", "", kPositive, "1.0", "Scale of the obstacle about its origin."),
        number("obstacle[].feature_angle", "degrees", {0.0, 180.0, true}, "(14, with `deform` 45)",
               "A convex edge is sharp if the normals of its two faces differ by more than this angle (plus "
               "0.01 degrees). By default the sides of a cylinder of up to 25 sides are sharp. A smaller "
               "angle makes "
               "cloth slide better over finer cylinders, but costs more on spheres and hills."),
        table("obstacle[].motion", "",
              "Rigid motion: p(t) = pivot + velocity tau + R(angular_velocity tau)(p0 - pivot), tau = "
              "clamp(t - start, 0, stop - start)."),
        numbers("obstacle[].motion.velocity", 3, "m/s", kAnyNumber, kOrigin, "Velocity of the obstacle."),
        numbers("obstacle[].motion.angular_velocity", 3, "rad/s", kAnyNumber, kOrigin,
                "Angular velocity of the obstacle about `pivot`; its direction is the axis."),
        numbers("obstacle[].motion.pivot", 3, "m", kAnyNumber, kOrigin,
                "World point about which `angular_velocity` rotates."),
        number("obstacle[].motion.start", "s", kNotNegative, "0.0", "Time at which the motion begins."),
        number("obstacle[].motion.stop", "s", kPositive, kNever,
               "Time at which the motion ends; later than `start`."),
        tables("obstacle[].keyframes",
               "Placements in time, instead of `motion`, `translate` and `rotate`. Translations are "
               "interpolated linearly, rotations by slerp along the shorter arc; before the first and after "
               "the last keyframe the placement is constant."),
        number("obstacle[].keyframes[].time", "s", kNotNegative, kRequired,
               "Time of the keyframe; later than the previous keyframe."),
        numbers("obstacle[].keyframes[].translate", 3, "m", kAnyNumber, kOrigin, "Translation at this time."),
        table("obstacle[].keyframes[].rotate", kIdentity, "Rotation at this time."),
        axis("obstacle[].keyframes[].rotate.axis"),
        number("obstacle[].keyframes[].rotate.degrees", "degrees", kAnyNumber, kRequired,
               "Angle of the rotation, right-handed."),
        number("obstacle[].friction", "", {0.0, 100.0}, "",
               "Coefficient of Coulomb friction of this obstacle. Without [friction] this key switches "
               "friction on for the obstacle."),

        choice("obstacle[].start", kStarts, R"("clear")",
               "Where the cloth crosses the obstacle at time 0: an error (clear), or it is moved out by the "
               "shortest way (untangle)."),

        tables("probe", "A material point whose position and velocity are written to probes.csv."),
        text("probe[].name", KeyType::Name, {}, kRequired,
             "Name of the probe in the columns of probes.csv; unique among pieces, obstacles and probes, not "
             "`cloth`."),
        numbers("probe[].material", 2, "m", kAnyNumber, kRequired, "The material point, u and v."),
        text("probe[].piece", KeyType::Name, {}, "",
             "Name of the piece of cloth that the point is of; required where there are several."),
        text("probe[].panel", KeyType::Name, {}, "",
             "Name of the panel that the point is of; required where a piece has several."),

        table("solver", "{}", "Settings of the solver."),
        number("solver.tolerance", "", {1e-14, 1e-2}, "1e-9",
               "Largest relative KKT residual that is accepted."),
        not_built(choice("solver.kernel", "exact|fast", R"("exact")",
                         "Exact or plain floating-point geometric predicates."),
                  "fast"),

        table("output", "{}", "Output of a run."),
        number("output.frames_per_second", "1/s", kNotNegative, "24.0",
               "Frames per second of simulated time; 0 writes no frames."),
        choices("output.formats", 0, "obj|usd|viewer|vtk|pc2|mdd|gltf", R"(["viewer"])",
                "Formats made from the frames. The PLY frames are always written."),
    });
    return keys;
}

}  // namespace

const std::vector<SceneKey>& scene_keys()
{
    static const std::vector<SceneKey> keys = make_scene_keys();
    return keys;
}

}  // namespace arris
