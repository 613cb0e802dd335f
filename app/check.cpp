// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/check.h"

#include <fmt/format.h>

#include <cmath>

#include "app/printable.h"
#include "app/scene_estimate.h"

namespace arris {
namespace {

using Lines = std::vector<std::string>;

std::string in_words(const Vec3& v)
{
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x(), v.y(), v.z());
}

std::string in_words(const MaterialBox& box)
{
    return fmt::format("[[{:.6g}, {:.6g}], [{:.6g}, {:.6g}]]", box.min.x(), box.min.y(), box.max.x(),
                       box.max.y());
}

std::string counted(std::size_t count, std::string_view one, std::string_view many)
{
    return fmt::format("{} {}", count, count == 1 ? one : many);
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

double material_area(const ClothMesh& cloth)
{
    double twice = 0.0;
    for (const Face& f : cloth.faces)
        twice += twice_area(cloth.material[f[0]], cloth.material[f[1]], cloth.material[f[2]]);
    return twice / 2.0;
}

void describe_cloth(const RunConfig& config, Lines& lines)
{
    const ClothMesh& cloth = config.cloth;
    const Material& material = config.scene.material;
    const double area = material_area(cloth);
    lines.push_back(fmt::format("cloth: {} of material, {:.6g} m^2, {:.4g} kg; {} vertices, {} faces",
                                extent(cloth.material), area, material.density * area, cloth.vertex_count(),
                                cloth.face_count()));
    lines.push_back(fmt::format("  placed within {} of the world", extent(cloth.world)));
    lines.push_back(fmt::format(
        "  {}: density {:g} kg/m^2, membrane {:g} N/m, Poisson ratio {:g}, bending {:g} J, damping {:g} s, "
        "thickness {:g} m",
        config.as_run["cloth"]["material"]["preset"].get<std::string>(), material.density,
        material.youngs_modulus, material.poisson_ratio, material.bending_stiffness, material.damping,
        material.thickness));
}

void describe_effects(const RunConfig& config, Lines& lines)
{
    lines.push_back("simulated:");
    for (const SceneEffect& effect : list_effects(config))
        if (effect.is_on) lines.push_back(fmt::format("  {}: {}", effect.name, effect.reason));
    lines.push_back("not simulated:");
    for (const SceneEffect& effect : list_effects(config))
        if (!effect.is_on) lines.push_back(fmt::format("  {}: {}", effect.name, effect.reason));
}

std::string pin_motion(const Pin& pin)
{
    if (!pin.motion.keyframes.empty()) return counted(pin.motion.keyframes.size(), "keyframe", "keyframes");
    return pin.motion.is_moving() ? "moving" : "at rest";
}

void describe_meetings(const RunConfig& config, Lines& lines)
{
    const Scene& scene = config.scene;
    for (std::size_t i = 0; i < scene.pins.size(); ++i) {
        const Pin& pin = scene.pins[i];
        const std::string until =
            std::isfinite(pin.release) ? fmt::format(", until {:g} s", pin.release) : "";
        lines.push_back(
            fmt::format("pin.{}: {} in {}, {}{}", i,
                        counted(vertices_in_box(config.cloth, pin.material).size(), "vertex", "vertices"),
                        in_words(pin.material), pin_motion(pin), until));
    }
    for (std::size_t i = 0; i < scene.pulls.size(); ++i) {
        const Pull& pull = scene.pulls[i];
        lines.push_back(
            fmt::format("pull.{}: {} N on {} of {}", i, in_words(pull.force),
                        counted(spread_over_box(config.cloth, pull.material).size(), "vertex", "vertices"),
                        in_words(pull.material)));
    }
    for (const Probe& probe : config.probes)
        lines.push_back(fmt::format("probe {}: material point [{:.6g}, {:.6g}], in face {}", probe.name,
                                    probe.material.x(), probe.material.y(),
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
    lines.push_back(fmt::format("expected: about {} of memory (this machine has {}), {} of disk",
                                human_bytes(estimate.memory_bytes), human_bytes(machine_memory_bytes()),
                                human_bytes(estimate.disk_bytes)));
}

SceneEffect by_table(const RunConfig& config, const std::string& table, bool is_list)
{
    const bool is_on = config.as_run.contains(table) && !config.as_run[table].empty();
    const std::string name = is_list ? fmt::format("[[{}]]", table) : fmt::format("[{}]", table);
    if (!is_on) return {table, false, "no " + name};
    if (!is_list) return {table, true, name + " is there"};
    return {table, true, fmt::format("{} {}", config.as_run[table].size(), name)};
}

SceneEffect by_value(const std::string& name, const std::string& key, double value, std::string_view unit)
{
    const bool is_on = value > 0.0;
    return {name, is_on, fmt::format("{} is {:g} {}", key, value, unit)};
}

}  // namespace

std::vector<SceneEffect> list_effects(const RunConfig& config)
{
    const Material& material = config.scene.material;
    return {
        by_value("bending", "cloth.material.bending_stiffness", material.bending_stiffness, "J"),
        by_value("damping", "cloth.material.damping", material.damping, "s"),
        by_table(config, "gravity", false),
        by_table(config, "wind", false),
        by_table(config, "pull", true),
        by_table(config, "pin", true),
        by_table(config, "obstacle", true),
        {"eol", false, "no obstacle has sharp features"},
        {"remesh", false, "no [remesh]; the mesh does not change"},
        by_table(config, "friction", false),
        {"self_contact", false, "not in this version: the cloth may pass through itself"},
    };
}

std::vector<std::string> describe_scene(const RunConfig& config)
{
    Lines lines = {fmt::format("title: {}", config.title)};
    describe_cloth(config, lines);
    describe_effects(config, lines);
    describe_meetings(config, lines);
    describe_run(config, lines);
    for (const std::string& warning : config.warnings) lines.push_back(fmt::format("warning: {}", warning));
    for (std::string& line : lines) line = printable(line);
    return lines;
}

}  // namespace arris
