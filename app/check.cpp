// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/parts/scene_effects.h"
#include "app/scene/parts/scene_estimate.h"
#include "app/scene/parts/scene_obstacles.h"
#include "app/scene/warnings/missing_effects.h"
#include "app/text/counted.h"
#include "app/text/printable.h"
#include "geometry/cloth/material_locator.h"
#include "geometry/cloth/mesh_pieces.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/sort_unique.h"
#include "physics/elements/cloth_elements.h"

namespace arris {
namespace {

using Lines = std::vector<std::string>;

std::string in_words(const Vec3& v)
{
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x(), v.y(), v.z());
}

/// A box in the plane of all pieces, in the coordinates of its own.
std::string in_words(const Scene& scene, const MaterialBox& box)
{
    const PiecePlace& piece = scene.pieces[static_cast<std::size_t>(scene.materials.piece_at(box.min))];
    const Vec2 min = piece.from_plane(box.min), max = piece.from_plane(box.max);
    return fmt::format("[[{:.6g}, {:.6g}], [{:.6g}, {:.6g}]]{}", min.x(), min.y(), max.x(), max.y(),
                       piece.name.empty() ? "" : " of " + piece.name);
}

std::string in_words(const Scene& scene, const std::vector<MaterialBox>& parts)
{
    if (parts.size() == 1) return in_words(scene, parts.front());
    return fmt::format("{} places, the first {}", parts.size(), in_words(scene, parts.front()));
}

template <typename Point>
std::string extent(const std::vector<Point>& points)
{
    Point least = points.front(), greatest = least;
    for (const Point& p : points) {
        least = least.cwiseMin(p);
        greatest = greatest.cwiseMax(p);
    }
    std::string words;
    for (const double side : Point(greatest - least))
        words += fmt::format("{}{:.6g}", words.empty() ? "" : " x ", side);
    return words + " m";
}

void describe_material(const Material& material, const std::string& name, Lines& lines)
{
    lines.push_back(fmt::format(
        "  {}: density {:g} kg/m^2, membrane {:g} N/m, Poisson ratio {:g}, bending {:g} J, damping {:g} s, "
        "thickness {:g} m",
        name, material.density, material.youngs_modulus, material.poisson_ratio, material.bending_stiffness,
        material.damping, material.thickness));
}

/// "  sewn along 1.2 m of seams, from 2 islands".
std::string describe_seams(const ClothMesh& cloth)
{
    const ClothElements elements =
        list_elements(cloth, make_topology(cloth.vertex_count(), cloth.faces), HingeUse::Terms);
    double length = 0.0;
    for (const HingeElement& hinge : elements.hinges)
        if (hinge.is_seam) length += (cloth.world[hinge.vertices[0]] - cloth.world[hinge.vertices[1]]).norm();
    std::vector<int> islands = label_pieces(static_cast<int>(cloth.material.size()), cloth.face_points);
    sort_unique(islands);
    return fmt::format("  sewn along {:.4g} m of seams, from {}", length,
                       counted(islands.size(), "island of UVs", "islands of UVs"));
}

/// "  seam front with back: 0.43 m and 0.45 m, open by 0.3 m".
std::string describe_open_seam(const RunConfig& config, const SceneSeam& seam)
{
    std::array<double, 2> lengths{};
    double widest = 0.0, reversed = 0.0;
    for (std::size_t k = 0; k < seam.pairs.size(); ++k) {
        widest = std::max(widest, distance_of(config, seam.pairs[k]));
        reversed = std::max(
            reversed, distance_of(config, {seam.pairs[k][0], seam.pairs[seam.pairs.size() - 1 - k][1]}));
        for (std::size_t side = 0; side < 2 && k > 0; ++side)
            lengths[side] += distance_of(config, {seam.pairs[k - 1][side], seam.pairs[k][side]});
    }
    constexpr double kNearer = 0.8;
    return fmt::format(
        "  {}: {:.3g} m and {:.3g} m, open by {:.3g} m{}{}{}", seam.name, lengths[0], lengths[1], widest,
        reversed < kNearer * widest ? fmt::format(" ({:.3g} m with one side reversed)", reversed) : "",
        seam.order == 0 ? "" : fmt::format(", order {}", seam.order), seam.is_tie ? ", a tie" : "");
}

/// One line for each panel of a cloth.
void describe_panels(const RunConfig& config, int table, Lines& lines)
{
    double area = 0.0;
    for (std::size_t i = 0; i < config.pieces.size(); ++i) {
        const ClothPiece& piece = config.pieces[i];
        if (piece.table != table) continue;
        const ClothMesh cloth = extract_piece(config, i);
        const nlohmann::ordered_json& material = material_of(config.as_run, piece);
        area += material_area(cloth);
        lines.push_back(fmt::format(
            "panel {}: {} of material, {:.6g} m^2; {}; {}{}", piece.name,
            extent(std::vector<Vec2>{Vec2::Zero(), material_extents(cloth)}), material_area(cloth),
            counted(cloth.face_count(), "face", "faces"),
            material.contains("name") ? "fabric " + material["name"].get<std::string>() + ", " : "",
            material["preset"].get<std::string>()));
    }
    lines.push_back(fmt::format("cloth of these panels: {:.6g} m^2 of material", area));
}

void describe_piece(const RunConfig& config, std::size_t i, Lines& lines)
{
    if (!config.pieces[i].panel.empty()) {
        const int table = config.pieces[i].table;
        if (i == 0 || config.pieces[i - 1].table != table) describe_panels(config, table, lines);
        return;
    }
    const ClothMesh cloth = extract_piece(config, i);
    const Material& material = config.scene.materials[static_cast<int>(i)];
    const nlohmann::ordered_json& json = material_of(config.as_run, config.pieces[i]);
    const EdgeLengths edges = measure_edges(cloth, make_topology(cloth.vertex_count(), cloth.faces));
    const double area = material_area(cloth);
    const std::string& name = config.pieces[i].name;
    const std::vector<Vec2> box = {Vec2::Zero(), material_extents(cloth)};
    lines.push_back(fmt::format(
        "cloth{}: {}{} of material, {:.6g} m^2, {:.4g} kg; {}, {}", name.empty() ? "" : " " + name,
        cloth.has_seams() ? "panels within " : "", extent(box), area, material.density * area,
        counted(cloth.vertex_count(), "vertex", "vertices"), counted(cloth.face_count(), "face", "faces")));
    lines.push_back(
        fmt::format("  mesh edges: mean {:.4g} m, from {:.4g} to {:.4g} m; least angle {:.3g} degrees",
                    edges.mean, edges.least, edges.greatest, least_material_angle(cloth)));
    lines.push_back(fmt::format("  initial extent: {}", extent(cloth.world)));
    if (cloth.has_seams()) lines.push_back(describe_seams(cloth));
    const std::string preset = json["preset"].get<std::string>();
    describe_material(material,
                      json.contains("name")
                          ? fmt::format("fabric {} ({})", json["name"].get<std::string>(), preset)
                          : preset,
                      lines);
}

void describe_effects(const RunConfig& config, Lines& lines)
{
    lines.push_back("simulated:");
    for (const SceneEffect& effect : list_effects(config))
        if (effect.is_on) lines.push_back(fmt::format("  {}: {}", effect.name, effect.reason));
    lines.push_back("not simulated:");
    for (const SceneEffect& effect : list_effects(config))
        if (!effect.is_on) lines.push_back(fmt::format("  {}: {}", effect.name, effect.reason));
    const std::vector<MissingEffect> missing = find_missing_effects(config);
    if (!missing.empty()) lines.push_back("not simulated, and would show:");
    for (const MissingEffect& effect : missing)
        lines.push_back(fmt::format("  {}: {}", effect.name, effect.sign));
}

std::string pin_motion(const Scene& scene, const Pin& pin)
{
    if (pin.follows) return "moves with " + scene.obstacles[static_cast<std::size_t>(*pin.follows)].name();
    if (!pin.motion.keyframes.empty()) return counted(pin.motion.keyframes.size(), "keyframe", "keyframes");
    return pin.motion.is_moving() ? "moving" : "at rest";
}

/// "box", "file table.obj".
std::string shape_in_words(const nlohmann::ordered_json& obstacle)
{
    if (obstacle.contains("file")) return "file " + obstacle["file"].get<std::string>();
    for (const char* shape : {"box", "points", "wire"})
        if (obstacle.contains(shape)) return shape;
    return "teeth";
}

/// "12 triangles (1 solid), 3 wire segments".
std::string elements_in_words(const Obstacle& obstacle)
{
    const ObstacleMesh& mesh = obstacle.mesh();
    const std::vector<char>& is_solid = obstacle.topology().is_solid;
    const auto solids = static_cast<std::size_t>(
        std::count_if(is_solid.begin(), is_solid.end(), [](char s) { return s != 0; }));
    const std::size_t sheets = is_solid.size() - solids;
    Lines parts;
    if (!mesh.faces.empty()) {
        Lines kinds;
        if (solids > 0) kinds.push_back(counted(solids, "closed surface", "closed surfaces"));
        if (sheets > 0) kinds.push_back(counted(sheets, "open sheet", "open sheets"));
        parts.push_back(fmt::format("{} in {}", counted(mesh.faces.size(), "triangle", "triangles"),
                                    fmt::join(kinds, " and ")));
    }
    if (!mesh.segments.empty())
        parts.push_back(counted(mesh.segments.size(), "wire segment", "wire segments"));
    if (!mesh.lone_points.empty())
        parts.push_back(counted(mesh.lone_points.size(), "lone point", "lone points"));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// Describes the features, with lengths relative to `cell`, the cloth's mean edge (m).
std::string features_in_words(const Obstacle& obstacle, double cell)
{
    const ObstacleFeatures& features = obstacle.features();
    Lines parts;
    if (!features.polylines.empty()) {
        double least = std::numeric_limits<double>::infinity(), sum = 0.0;
        for (const FeaturePolyline& line : features.polylines) {
            least = std::min(least, line.length);
            sum += line.length;
        }
        parts.push_back(fmt::format(
            "{} in {}, {:.6g} m in all, the shortest line {:.4g} m, {:.3g} times the cloth's mean edge",
            counted(features.edges.size(), "edge", "edges"),
            counted(features.polylines.size(), "line", "lines"), sum, least, least / cell));
    }
    if (!features.corners.empty())
        parts.push_back(counted(features.corners.size(), "corner or point", "corners or points"));
    return parts.empty() ? "no sharp features" : fmt::format("sharp features: {}", fmt::join(parts, "; "));
}

std::string motion_in_words(const RigidMotion& motion)
{
    if (!motion.keyframes.empty())
        return fmt::format("{} from {:g} s to {:g} s{}",
                           counted(motion.keyframes.size(), "keyframe", "keyframes"),
                           motion.keyframes.front().time, motion.keyframes.back().time,
                           motion.is_moving() ? "" : ", at rest");
    if (!motion.is_moving()) return "at rest";
    std::string words = "moves";
    if (motion.velocity.squaredNorm() > 0.0) words += fmt::format(" at {} m/s", in_words(motion.velocity));
    if (motion.angular_velocity.squaredNorm() > 0.0)
        words += fmt::format(" rotating at {} rad/s about {}", in_words(motion.angular_velocity),
                             in_words(motion.pivot));
    words += fmt::format(" from {:g} s", motion.start);
    return std::isfinite(motion.stop) ? words + fmt::format(" to {:g} s", motion.stop) : words + " on";
}

std::string motion_in_words(const MovingObstacle& obstacle)
{
    const std::string motion = motion_in_words(obstacle.motion());
    if (!obstacle.is_deforming()) return motion;
    const std::vector<double>& times = obstacle.deformation()->sample_times();
    const std::string words = times.size() == 1
                                  ? "one pose"
                                  : fmt::format("deforms from {:g} s to {:g} s", times.front(), times.back());
    return obstacle.motion().is_moving() ? words + "; " + motion : words;
}

/// Whether EOL vertices can lie on a wire.
bool has_eol_wires(const Scene& scene)
{
    return scene.eol &&
           std::any_of(scene.obstacles.begin(), scene.obstacles.end(), [](const MovingObstacle& obstacle) {
               return !obstacle.shape().mesh().segments.empty();
           });
}

void describe_obstacles(const RunConfig& config, const EdgeLengths& edges, Lines& lines)
{
    for (std::size_t i = 0; i < config.scene.obstacles.size(); ++i) {
        const MovingObstacle& obstacle = config.scene.obstacles[i];
        const Box3 bounds = bounds_at(obstacle, 0.0);
        const Vec3 sizes = bounds.sizes();
        lines.push_back(fmt::format("obstacle {}: {}, {}", obstacle.name(),
                                    shape_in_words(config.as_run["obstacle"][i]),
                                    elements_in_words(obstacle.shape())));
        lines.push_back(fmt::format("  extent at time 0: {:.6g} x {:.6g} x {:.6g} m, from {} to {}",
                                    sizes.x(), sizes.y(), sizes.z(), in_words(Vec3(bounds.min())),
                                    in_words(Vec3(bounds.max()))));
        lines.push_back("  " + features_in_words(obstacle.shape(), edges.mean));
        lines.push_back("  " + motion_in_words(obstacle));
    }
    if (has_eol_wires(config.scene))
        lines.push_back(
            "known limit: where cloth is folded over a wire, its two sides do not cross the fold plane "
            "behind the wire (docs/method.md, Wires)");
    for (std::size_t i = 1; i < config.intersections.size();
         ++i)  // the caller throws the first one as an error
        lines.push_back("intersection: " + config.intersections[i]);
    if (!config.scene.obstacles.empty() && config.intersections.empty())
        lines.push_back("the cloth is clear of all obstacles at time 0");
}

void describe_meetings(const RunConfig& config, Lines& lines)
{
    const Scene& scene = config.scene;
    for (std::size_t i = 0; i < scene.pins.size(); ++i) {
        const Pin& pin = scene.pins[i];
        const std::string from = pin.start > 0.0 ? fmt::format(", from {:g} s", pin.start) : "";
        const std::string until =
            std::isfinite(pin.release) ? fmt::format(", until {:g} s", pin.release) : "";
        lines.push_back(
            fmt::format("pin.{}: {} in {}, {}{}{}", i,
                        counted(vertices_inside(config.cloth, pin.material).size(), "vertex", "vertices"),
                        in_words(scene, pin.material.parts()), pin_motion(scene, pin), from, until));
    }
    for (std::size_t i = 0; i < scene.pulls.size(); ++i) {
        const Pull& pull = scene.pulls[i];
        lines.push_back(
            fmt::format("pull.{}: {} N on {} of {}", i, in_words(pull.force),
                        counted(spread_over_box(config.cloth, pull.material).size(), "vertex", "vertices"),
                        in_words(scene, pull.material)));
    }
    for (const Probe& probe : config.probes)
        lines.push_back(fmt::format("probe {}: material point {}, in face {}", probe.name,
                                    material_in_words(config.scene, probe.material, 6),
                                    locate(config.cloth, probe.material).face));
}

SceneEstimate estimate_run(const RunConfig& config)
{
    SceneEstimate estimate;
    estimate.vertices = config.cloth.vertex_count();
    estimate.faces = config.cloth.face_count();
    estimate.frames = count_frames(config.duration, config.output.frames_per_second);
    estimate.steps = count_steps(config.duration, config.settings.step, config.output.frames_per_second,
                                 input_jumps(config.scene));
    add_obstacles(config.scene.obstacles, estimate);
    estimate_bytes(config.output.formats, estimate);
    return estimate;
}

void describe_run(const RunConfig& config, Lines& lines)
{
    const SceneEstimate estimate = estimate_run(config);
    lines.push_back(fmt::format("run: {:g} s, {} in {:.0f} steps of at most {:g} s; {:.0f} frames",
                                config.duration,
                                config.settings.integrator == Integrator::Bdf2 ? "BDF2" : "implicit Euler",
                                estimate.steps, config.settings.step, estimate.frames));
    lines.push_back(fmt::format(
        "expected: about {} of memory{} (this machine has {}), {} of disk",
        human_bytes(estimate.memory_bytes),
        config.scene.friction ? ", some hundred MB more where friction acts in thousands of contacts" : "",
        human_bytes(machine_memory_bytes()), human_bytes(estimate.disk_bytes)));
}

}  // namespace

std::vector<std::string> describe_scene(const RunConfig& config)
{
    Lines lines = {fmt::format("title: {}", config.title)};
    const EdgeLengths edges =
        measure_edges(config.cloth, make_topology(config.cloth.vertex_count(), config.cloth.faces));
    for (std::size_t i = 0; i < config.pieces.size(); ++i) describe_piece(config, i, lines);
    if (!config.seams.empty())
        lines.push_back(
            fmt::format("{} to close before time 0", counted(config.seams.size(), "seam", "seams")));
    for (const SceneSeam& seam : config.seams) lines.push_back(describe_open_seam(config, seam));
    describe_obstacles(config, edges, lines);
    describe_effects(config, lines);
    describe_meetings(config, lines);
    describe_run(config, lines);
    for (const std::string& note : config.notes) lines.push_back(fmt::format("note: {}", note));
    for (std::string& line : lines) line = printable(line);
    return lines;
}

}  // namespace arris
