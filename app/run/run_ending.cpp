// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_ending.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/text/counted.h"

namespace arris {
namespace {

/// Describes a vertex by id and place. A vertex that the failed step inserted has only its id.
std::string name_vertex(const State& state, std::int64_t id)
{
    if (id < 0) return "the cloth";
    const auto at = std::lower_bound(state.ids.begin(), state.ids.end(), id);
    if (at == state.ids.end() || *at != id) return fmt::format("vertex {}", id);
    const auto v = static_cast<std::size_t>(at - state.ids.begin());
    const Vec3& x = state.mesh.world[v];
    const Vec2& X = state.mesh.material[v];
    return fmt::format("vertex {}, at [{:.6g}, {:.6g}, {:.6g}] (m, material [{:.6g}, {:.6g}]),", id, x.x(),
                       x.y(), x.z(), X.x(), X.y());
}

/// Says which pins and obstacle press two layers of the cloth into each other.
std::string explain_layers(const Infeasible& infeasible, const Scene& scene, const State& state,
                           const std::string& place)
{
    const int presser = infeasible.obstacles[0];
    std::string why = "layers, pins and obstacles leave it no room";
    if (infeasible.layer_pin >= 0)
        why = fmt::format(
            "pin.{} and pin.{} press two layers into each other; change the motion of one of them",
            infeasible.pin, infeasible.layer_pin);
    else if (infeasible.pin >= 0 && presser >= 0)
        why = fmt::format(
            "{} presses another layer into it, and pin.{} holds it; change the motion of one of them, or "
            "release the pin earlier",
            scene.obstacles[static_cast<std::size_t>(presser)].name(), infeasible.pin);
    else if (infeasible.pin >= 0)
        why = fmt::format("pin.{} presses it into another layer; change its motion, or release it earlier",
                          infeasible.pin);
    return fmt::format("no velocity keeps {} out of the cloth itself {}: {}",
                       name_vertex(state, infeasible.vertex), place, why);
}

/// Says which pin and obstacles a vertex cannot meet together.
std::string explain_infeasible(const Infeasible& infeasible, const Scene& scene, const State& state,
                               const std::string& place)
{
    if (infeasible.is_with_itself) return explain_layers(infeasible, scene, state, place);
    const auto name = [&](int obstacle) {
        return scene.obstacles[static_cast<std::size_t>(obstacle)].name();
    };
    const auto [first, second] = infeasible.obstacles;
    std::string where = "the obstacles",
                why = "a pin drives the cloth into an obstacle, or two obstacles leave it no room";
    if (second >= 0) {
        where = fmt::format("{} and {}", name(first), name(second));
        why = "these obstacles leave it no room";
    } else if (first >= 0) {
        where = name(first);
        why = "two parts of this obstacle leave it no room";
    }
    if (infeasible.pin >= 0 && first >= 0)
        why = fmt::format(
            "pin.{} holds the vertex where {} is; change the motion of one of them, or release "
            "the pin earlier",
            infeasible.pin, name(first));
    return fmt::format("no velocity keeps {} out of {} {}: {}", name_vertex(state, infeasible.vertex), where,
                       place, why);
}

/// Says which number is not finite: "the pin's target of vertex 7, at [..], of pin.0", "the placement of
/// box".
std::string name_not_finite(const NotFinite& found, const Scene& scene, const State& state)
{
    if (found.what == nullptr) return "a value";
    std::string name = fmt::format("the {}", found.what);
    if (found.vertex >= 0) name += " of " + name_vertex(state, found.vertex);
    if (found.pin >= 0) name += fmt::format(" of pin.{}", found.pin);
    if (found.obstacle >= 0)
        name += (found.vertex >= 0 ? " with " : " of ") +
                scene.obstacles[static_cast<std::size_t>(found.obstacle)].name();
    return name;
}

}  // namespace

RunEnding explain_ending(const StepReport& report, double tolerance, const Scene& scene, const State& state)
{
    const std::string place = fmt::format("in the step after t = {} s", state.time);
    switch (report.status) {
        case StepStatus::NotFinite:
            return {RunStatus::NotFinite,
                    fmt::format("{} is not finite {}, even with 64 times smaller steps",
                                name_not_finite(report.not_finite, scene, state), place)};
        case StepStatus::Overrun:
            return {RunStatus::NotConverged, fmt::format("material flows over a feature faster than the mesh "
                                                         "can follow {}, even with 64 times smaller steps",
                                                         place)};
        case StepStatus::Infeasible:
            return {RunStatus::Infeasible, explain_infeasible(report.infeasible, scene, state, place)};
        case StepStatus::Penetration:
            return {RunStatus::Penetration,
                    fmt::format("the cloth cannot be kept out of {} {}, even with 64 times smaller steps",
                                scene.self_contact ? "an obstacle or itself" : "an obstacle", place)};
        default:
            if (!std::isfinite(report.kkt_residual) && report.factorisations > 1)
                return {RunStatus::NotConverged,
                        fmt::format(
                            "the velocity solve found no answer {}, within a bounded number of "
                            "factorisations, even with 64 times smaller steps: too many contacts depend on "
                            "each other; use smaller cells or a simpler obstacle",
                            place)};
            if (!std::isfinite(report.kkt_residual))
                return {RunStatus::NotConverged,
                        fmt::format(
                            "the matrix of the velocity solve cannot be factorised {}, even with 64 times "
                            "smaller steps: stiffness and mass differ by too many orders of magnitude",
                            place)};
            return {RunStatus::NotConverged,
                    fmt::format("the velocity solve reached a residual of {:.1e}, above the tolerance "
                                "{:.1e}, {}, even with 64 times smaller steps",
                                report.kkt_residual, tolerance, place)};
    }
}

RunEnding explain_ending(const Audit& audited, const Scene& scene, const State& state)
{
    const Vec3& place = audited.found.place;
    return {
        RunStatus::Penetration,
        fmt::format("the cloth reaches {:.3g} m into {} at [{:.6g}, {:.6g}, {:.6g}], at t = {} s",
                    audited.found.depth, scene.obstacles[static_cast<std::size_t>(audited.obstacle)].name(),
                    place.x(), place.y(), place.z(), state.time)};
}

RunEnding explain_ending(const SelfCrossings& crossings, const State& state)
{
    const Vec3& place = crossings.place;
    return {
        RunStatus::Penetration,
        fmt::format("{} of faces of the cloth cross, the first at [{:.6g}, {:.6g}, {:.6g}], at t = {} s",
                    counted(crossings.count, "pair", "pairs"), place.x(), place.y(), place.z(), state.time)};
}

}  // namespace arris
