// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/strain_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "app/run/moving_causes.h"
#include "app/scene/parts/scene_estimate.h"
#include "app/scene/parts/start_strain.h"
#include "geometry/cloth/material_region.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {
namespace {

// A cause counts if it alone strains the cloth by 5 %, a quarter of the strain at which cloth tears.
constexpr double kCounts = 0.05;

/// A possible cause: the strain that it makes alone, and how to make it smaller.
struct Cause {
    double strain = 0.0;  ///< size
    std::string what, remedy;
};

std::string percent(double strain)
{
    return fmt::format("{:.3g} %", 100.0 * strain);
}

// ---- loads: tension per width over the membrane stiffness E

/// The piece where the strain is.
struct StrainedPiece {
    const ClothPiece& piece;
    const nlohmann::ordered_json& json;
    const Material& material;
    ClothMesh mesh;  ///< its first one

    std::string key(const std::string& leaf) const { return piece.material_key + "." + leaf; }
};

StrainedPiece find_strained_piece(const RunConfig& config, const StrainPeak& peak)
{
    const int i = config.scene.materials.piece_at(peak.material);
    const auto p = static_cast<std::size_t>(i);
    return {config.pieces[p], table_of(config.as_run, config.pieces[p]), config.scene.materials[i],
            extract_piece(config, p)};
}

Cause weight_of(const RunConfig& config, const StrainedPiece& at, double length)
{
    const Material& material = at.material;
    const double g = config.scene.gravity ? config.scene.gravity->acceleration.norm() : 0.0;
    return {material.density * g * length / material.youngs_modulus,
            "its weight (density * gravity * length / youngs_modulus)",
            fmt::format("lower {}, which is in kg/m^2, or raise {}", at.key("density"),
                        at.key("youngs_modulus"))};
}

Cause wind_on(const RunConfig& config, const StrainedPiece& at, double length)
{
    if (!config.scene.wind) return {};
    const Wind& wind = *config.scene.wind;
    const double speed = wind.velocity.norm() * (1.0 + (wind.gust ? std::abs(wind.gust->amplitude) : 0.0));
    const double pressure = 0.5 * wind.air_density * wind.drag * speed * speed;
    return {pressure * length / at.material.youngs_modulus, "the wind (pressure * length / youngs_modulus)",
            fmt::format("lower wind.velocity, or raise {}", at.key("youngs_modulus"))};
}

Cause pull_on(const RunConfig& config, const StrainedPiece& at, std::size_t i, double width)
{
    const double force = config.scene.pulls[i].force.norm();
    return {force / (width * at.material.youngs_modulus),
            fmt::format("pull.{} (force / (width * youngs_modulus))", i),
            fmt::format("lower pull.{}.force, or raise {}", i, at.key("youngs_modulus"))};
}

/// The greatest of the loads.
Cause greatest_load(const RunConfig& config, const StrainedPiece& at)
{
    const Vec2 sides = material_extents(at.mesh);
    const double length = sides.maxCoeff(), width = sides.minCoeff();
    std::vector<Cause> loads = {weight_of(config, at, length), wind_on(config, at, length)};
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i)
        if (at.piece.holds(config.scene.pulls[i].material.min))
            loads.push_back(pull_on(config, at, i, width));
    return *std::max_element(loads.begin(), loads.end(),
                             [](const Cause& a, const Cause& b) { return a.strain < b.strain; });
}

std::string describe_load(const Cause& load)
{
    return fmt::format("{} alone strains it by {}: {}", load.what, percent(load.strain), load.remedy);
}

std::string describe_motion(const MovingCause& moving)
{
    return fmt::format("{}{}: {}", moving.what, moving.is_near ? " there" : "", moving.remedy);
}

// ---- the start, and seams

constexpr const char* kEase =
    "make its panel wider for the body there, or sides of its seams more alike (arris check lists their "
    "lengths)";

/// While seams close nothing else pulls.
std::string describe_sewing()
{
    return fmt::format("its seams pull there: {}", kEase);
}

std::optional<Cause> start_of(const StrainedPiece& at)
{
    const StrainRange start = measure_strain(at.mesh);
    if (!start.is_surprising()) return std::nullopt;
    Cause cause;
    cause.strain = std::max(start.greatest, -start.least);
    cause.what = fmt::format("it starts strained, {}", in_words(start));
    const std::string& key = at.piece.key;
    const double scale = at.json["scale"].get<double>();
    if (std::abs(scale - 1.0) > kCounts) {
        cause.what +=
            fmt::format(", as {}.scale = {:g} scales its positions but not its material", key, scale);
        cause.remedy = !at.piece.panel.empty()       ? std::string("change its pattern instead")
                       : at.json.contains("file")    ? fmt::format("scale {}.uv_scale as well", key)
                       : at.json.contains("outline") ? fmt::format("change {}.outline instead", key)
                                                     : fmt::format("change {}.size instead", key);
    } else if (!at.piece.panel.empty()) {
        cause.what += ", as sewing has left it";
        cause.remedy = kEase;
    } else {
        cause.remedy = at.json.contains("file")
                           ? fmt::format("check the UVs of its file, {0}.uv_scale and {0}.units", key)
                           : "start it farther from obstacles and from the places of pins";
    }
    return cause;
}

// ---- pins: the distance between held vertices, relative to that between their material points

struct HeldVertex {
    Vec3 world;
    Vec2 material;
};

/// The vertices that a pin has held since time 0 at `time`, at most about 60 of them. Where a later pin takes
/// hold of its vertices is not known.
std::vector<HeldVertex> held_at(const RunConfig& config, const Pin& pin, double time)
{
    constexpr std::size_t kMost = 60;
    std::vector<HeldVertex> held;
    const bool holds_all = pin.held[0] && pin.held[1] && pin.held[2];
    if (!holds_all || !pin.holds(0.0, time)) return held;
    const std::vector<int> vertices = vertices_inside(config.cloth, pin.material);
    const std::size_t stride = 1 + vertices.size() / kMost;
    for (std::size_t k = 0; k < vertices.size(); k += stride) {
        const auto v = static_cast<std::size_t>(vertices[k]);
        const Vec3& placed = config.cloth.world[v];
        const SurfacePlace on = pin_surface(config.scene, pin, 0.0, placed);
        held.push_back({pin_placement(config.scene, pin, on, time)(placed), config.cloth.material[v]});
    }
    return held;
}

/// The two pins that strain the cloth between them most at `time`; `sign` 1: stretch, -1: compress.
Cause pins_at(const RunConfig& config, double time, double sign)
{
    Cause cause;
    std::vector<std::vector<HeldVertex>> held;
    for (const Pin& pin : config.scene.pins) held.push_back(held_at(config, pin, time));
    for (std::size_t i = 0; i < held.size(); ++i)
        for (std::size_t j = i + 1; j < held.size(); ++j)
            for (const HeldVertex& a : held[i])
                for (const HeldVertex& b : held[j]) {
                    const double length = (a.material - b.material).norm();
                    const Materials& materials = config.scene.materials;
                    if (!(length > 0.0) || materials.piece_at(a.material) != materials.piece_at(b.material))
                        continue;
                    const double strain = sign * ((a.world - b.world).norm() / length - 1.0);
                    if (!(strain > cause.strain)) continue;
                    cause.strain = strain;
                    cause.what = fmt::format("pin.{} and pin.{}", i, j);
                }
    return cause;
}

/// Whether the peak is next to a pin, at most two edges away.
bool is_next_to_pin(const RunConfig& config, const StrainPeak& peak, double edge)
{
    constexpr double kEdges = 2.0;
    return std::any_of(config.scene.pins.begin(), config.scene.pins.end(),
                       [&](const Pin& pin) { return pin.material.distance(peak.material) <= kEdges * edge; });
}

/// The whole weight on the vertices that pins hold, each with one edge of width.
Cause weight_on_pins(const RunConfig& config, const StrainedPiece& at, const StrainPeak& peak, double edge)
{
    std::size_t count = 0;
    for (const Pin& pin : config.scene.pins)
        if (pin.start <= peak.time && pin.holds(pin.start, peak.time))
            count += vertices_inside(at.mesh, pin.material).size();
    if (count == 0 || !config.scene.gravity || !is_next_to_pin(config, peak, edge)) return {};
    const Material& material = at.material;
    const double weight =
        material.density * material_area(at.mesh) * config.scene.gravity->acceleration.norm();
    return {weight / (static_cast<double>(count) * edge * material.youngs_modulus),
            fmt::format("its whole weight on {} stretches it",
                        count == 1 ? "one pinned vertex" : fmt::format("{} pinned vertices", count)),
            "let pins hold a larger part of the cloth"};
}

double mean_edge(const ClothMesh& mesh)
{
    return measure_edges(mesh, make_topology(mesh.vertex_count(), mesh.faces)).mean;
}

}  // namespace

std::string explain_stretch(const RunConfig& config, const StrainPeak& peak)
{
    if (config.is_assembly) return describe_sewing();
    const StrainedPiece at = find_strained_piece(config, peak);
    if (const std::optional<Cause> start = start_of(at))
        return fmt::format("{}: {}", start->what, start->remedy);
    if (const Cause pins = pins_at(config, peak.time, 1.0); pins.strain > kCounts)
        return fmt::format("{} are then {} farther apart than the material between them: move them less far",
                           pins.what, percent(pins.strain));
    const Cause load = greatest_load(config, at);
    const double edge = mean_edge(at.mesh);
    const Cause hung = weight_on_pins(config, at, peak, edge);
    const MovingCause moving = find_moving_cause(config, peak, edge);
    const bool is_moved = moving.strain > kCounts;
    if (is_moved && moving.is_near && moving.strain > std::max(load.strain, hung.strain))
        return describe_motion(moving);
    if (load.strain > kCounts) return describe_load(load);
    if (hung.strain > kCounts)
        return fmt::format("{} by {} there: {}", hung.what, percent(hung.strain), hung.remedy);
    if (is_moved) return describe_motion(moving);
    if (!(load.strain > 0.0)) return "no load or pin of the scene explains it";
    return fmt::format("no load or pin of the scene explains it, the greatest being {}: {}", load.what,
                       percent(load.strain));
}

std::string explain_compression(const RunConfig& config, const StrainPeak& peak)
{
    if (config.is_assembly) return describe_sewing();
    const StrainedPiece at = find_strained_piece(config, peak);
    if (const std::optional<Cause> start = start_of(at))
        return fmt::format("{}: {}", start->what, start->remedy);
    const Cause load = greatest_load(config, at);
    if (load.strain > kCounts) return describe_load(load);
    if (const Cause pins = pins_at(config, peak.time, -1.0); pins.strain > kCounts)
        return fmt::format(
            "{} are then {} nearer than the material between them: leave it room to fold, and "
            "let something bend it out of its plane, such as cloth.folds",
            pins.what, percent(pins.strain));
    if (const Cause pins = pins_at(config, peak.time, 1.0); pins.strain > kCounts)
        return fmt::format(
            "{} are then {} farther apart than the material between them, and pulled cloth contracts across "
            "the pull: move them less far",
            pins.what, percent(pins.strain));
    const double edge = mean_edge(at.mesh);
    const MovingCause moving = find_moving_cause(config, peak, edge);
    if (moving.strain > kCounts && moving.is_near) return describe_motion(moving);
    return fmt::format("a fold needs several edges of the mesh, whose mean edge is {:.2g} m", edge);
}

}  // namespace arris
