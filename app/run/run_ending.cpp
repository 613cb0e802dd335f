// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_ending.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/scene/parts/cloth_pieces.h"
#include "app/text/counted.h"
#include "solver/sewing/closing.h"

namespace arris {
namespace {

constexpr const char* kOtherCloth = "other cloth";

/// Distance, m, from the vertex named, within which contacts count as pressing at its seam.
constexpr double kNearSeam = 0.05;

std::string name_vertex(const Scene& scene, std::int64_t id, const Vec3& x, const Vec2& X)
{
    return fmt::format("vertex {}, at [{:.6g}, {:.6g}, {:.6g}] (m, material {}),", id, x.x(), x.y(), x.z(),
                       material_in_words(scene, X, 6));
}

/// Describes a vertex by id and place. A vertex that the failed step inserted has only its id.
std::string name_vertex(const Scene& scene, const State& state, std::int64_t id)
{
    if (id < 0) return "the cloth";
    const auto at = std::lower_bound(state.ids.begin(), state.ids.end(), id);
    if (at == state.ids.end() || *at != id) return fmt::format("vertex {}", id);
    const auto v = static_cast<std::size_t>(at - state.ids.begin());
    return name_vertex(scene, id, state.mesh.world[v], state.mesh.material[v]);
}

std::string name_obstacle(const Scene& scene, int obstacle)
{
    return scene.obstacles[static_cast<std::size_t>(obstacle)].name();
}

/// "slab", "slab and lid", "slab and itself"; `unknown` where nothing is named.
std::string name_met(const FailurePlace& place, const Scene& scene, const char* unknown)
{
    std::vector<std::string> names;
    for (const int obstacle : place.obstacles)
        if (obstacle >= 0) names.push_back(name_obstacle(scene, obstacle));
    if (place.is_with_itself) names.push_back("itself");
    return names.empty() ? unknown : fmt::format("{}", fmt::join(names, " and "));
}

/// " at vertex 7, at [..] (m, material [..]),", or nothing where no vertex is known.
std::string name_place(const Scene& scene, const FailurePlace& place)
{
    return place.vertex < 0 ? "" : " at " + name_vertex(scene, place.vertex, place.world, place.material);
}

/// Says that friction locks the cloth where two faces close on it at too small an angle: each face's force is
/// at most atan(coefficient) off its normal, so that the two can hold any other force.
std::string explain_lock(const FailurePlace& place, const Scene& scene)
{
    constexpr double kDegree = M_PI / 180.0;
    constexpr double kParallel = kDegree;  // such faces drive cloth nowhere, with or without friction
    if (!scene.friction || place.crease[0] < 0 || !(place.crease_angle > kParallel)) return "";
    const int piece = scene.materials.piece_at(place.material);
    const double coefficient = std::min(scene.friction->with_obstacle(place.crease[0], piece),
                                        scene.friction->with_obstacle(place.crease[1], piece)),
                 locked = 2.0 * std::atan(coefficient);
    if (!(place.crease_angle < locked)) return "";
    return fmt::format(
        "; friction locks it there: with a coefficient of {:.3g} cloth does not slip out of a crease of less "
        "than {:.0f} degrees, and this one has {:.0f}; lower the coefficient, or close the crease less",
        coefficient, locked / kDegree, place.crease_angle / kDegree);
}

/// Where the velocity solve fails: the vertex that presses hardest.
std::string name_press(const FailurePlace& place, const Scene& scene)
{
    if (place.vertex < 0) return "";
    const std::string met = name_met(place, scene, "");
    return fmt::format("; {} {}{}{}", met.empty() ? "the stiffest part is" : "the cloth presses hardest at",
                       name_vertex(scene, place.vertex, place.world, place.material),
                       met.empty() ? "" : fmt::format(" on {}", met), explain_lock(place, scene));
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
            name_obstacle(scene, presser), infeasible.pin);
    else if (infeasible.pin >= 0)
        why = fmt::format("pin.{} presses it into another layer; change its motion, or release it earlier",
                          infeasible.pin);
    return fmt::format("no velocity keeps {} out of the cloth itself {}: {}",
                       name_vertex(scene, state, infeasible.vertex), place, why);
}

/// Says which pin and obstacles a vertex cannot meet together.
std::string explain_infeasible(const Infeasible& infeasible, const Scene& scene, const State& state,
                               const std::string& place)
{
    if (infeasible.is_with_itself) return explain_layers(infeasible, scene, state, place);
    const auto name = [&](int obstacle) { return name_obstacle(scene, obstacle); };
    const auto [first, second] = infeasible.obstacles;
    std::string where = "the obstacles",
                why = "a pin drives the cloth into an obstacle, or two obstacles leave it no room";
    if (second >= 0) {
        where = fmt::format("{} and {}", name(first), name(second));
        why = "these obstacles leave it no room";
    } else if (first >= 0) {
        where = name(first);
        why = "two parts of this obstacle leave it no room";
        if (scene.obstacles[static_cast<std::size_t>(first)].is_deforming())
            why += " (`deform.slit` makes some between parts of a body that come together)";
    }
    if (infeasible.pin >= 0 && first >= 0)
        why = fmt::format(
            "pin.{} holds the vertex where {} is; change the motion of one of them, or release "
            "the pin earlier",
            infeasible.pin, name(first));
    return fmt::format("no velocity keeps {} out of {} {}: {}", name_vertex(scene, state, infeasible.vertex),
                       where, place, why);
}

/// Says which number is not finite: "the pin's target of vertex 7, at [..], of pin.0", "the placement of
/// box".
std::string name_not_finite(const NotFinite& found, const Scene& scene, const State& state)
{
    if (found.what == nullptr) return "a value";
    std::string name = fmt::format("the {}", found.what);
    if (found.vertex >= 0) name += " of " + name_vertex(scene, state, found.vertex);
    if (found.pin >= 0) name += fmt::format(" of pin.{}", found.pin);
    if (found.obstacle >= 0)
        name += (found.vertex >= 0 ? " with " : " of ") + name_obstacle(scene, found.obstacle);
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
            return {RunStatus::NotConverged,
                    fmt::format("material flows over {} faster than the mesh can follow{} {}, even with 64 "
                                "times smaller steps",
                                name_met(report.place, scene, "a feature"), name_place(scene, report.place),
                                place)};
        case StepStatus::Infeasible:
            return {RunStatus::Infeasible, explain_infeasible(report.infeasible, scene, state, place) +
                                               explain_lock(report.place, scene)};
        case StepStatus::Penetration:
            return {RunStatus::Penetration,
                    fmt::format("the cloth cannot be kept out of {}{} {}, even with 64 times smaller steps",
                                name_met(report.place, scene, "an obstacle"), name_place(scene, report.place),
                                place) +
                        explain_lock(report.place, scene)};
        default:
            if (!std::isfinite(report.kkt_residual) && report.factorisations > 1)
                return {RunStatus::NotConverged,
                        fmt::format(
                            "the velocity solve found no answer {}, within a bounded number of "
                            "factorisations, even with 64 times smaller steps: too many contacts depend on "
                            "each other; use smaller cells or a simpler obstacle{}",
                            place, name_press(report.place, scene))};
            if (!std::isfinite(report.kkt_residual))
                return {RunStatus::NotConverged,
                        fmt::format(
                            "the matrix of the velocity solve cannot be factorised {}, even with 64 times "
                            "smaller steps: stiffness and mass differ by too many orders of magnitude{}",
                            place, name_press(report.place, scene))};
            return {RunStatus::NotConverged,
                    fmt::format("the velocity solve reached a residual of {:.1e}, above the tolerance "
                                "{:.1e}, {}, even with 64 times smaller steps{}",
                                report.kkt_residual, tolerance, place, name_press(report.place, scene))};
    }
}

RunEnding explain_unsewn(const Scene& scene, const State& state)
{
    std::vector<SeamGap> open = find_open_seams(scene, state);
    const std::size_t waiting = std::erase_if(open, [&](const SeamGap& gap) {
        return scene.sewing->seams[static_cast<std::size_t>(gap.seam)].order > state.closing.order;
    });
    if (open.empty()) return {RunStatus::Unsewn, "the seams have not had the time to close"};
    const SeamGap& worst = *std::max_element(
        open.begin(), open.end(), [](const SeamGap& a, const SeamGap& b) { return a.widest < b.widest; });
    const std::string place = name_vertex(scene, state, state.ids[static_cast<std::size_t>(worst.vertex)]),
                      seam = scene.sewing->seams[static_cast<std::size_t>(worst.seam)].name;
    std::set<std::string> pressing;
    for (const ActiveContact& contact : state.active)
        for (const std::uint32_t id : contact.vertex_ids)
            if (const int v = state.index_of(id);
                v >= 0 && (state.mesh.world[static_cast<std::size_t>(v)] -
                           state.mesh.world[static_cast<std::size_t>(worst.vertex)])
                                  .norm() <= std::max(worst.widest, kNearSeam))
                pressing.insert(contact.obstacle == kClothItself ? kOtherCloth
                                                                 : name_obstacle(scene, contact.obstacle));
    const bool is_held =
        std::any_of(state.anchors.begin(), state.anchors.end(), [&](const PinAnchor& anchor) {
            return std::any_of(state.seam_pairs.begin(), state.seam_pairs.end(), [&](const SeamPair& pair) {
                return pair.seam == worst.seam &&
                       (pair.vertex_ids[0] == anchor.vertex_id || pair.vertex_ids[1] == anchor.vertex_id);
            });
        });
    std::string why;
    for (const std::string& name : pressing) why += (why.empty() ? "" : " and ") + name;
    const std::string cause =
        worst.pairs == 0 ? "where its two sides meet, but would cross as they become one"
        : is_held        ? "which a pin by its 'label' holds there"
        : why.empty()    ? "where nothing touches it: its sides are too unlike, or too tight"
                         : fmt::format("where {} {}{}", why, pressing.size() == 1 ? "presses" : "press",
                                    pressing.contains(kOtherCloth)
                                           ? "; panels that get in each other's way close one after the "
                                             "other if one of their seams has a later 'order'"
                                           : "");
    return {
        RunStatus::Unsewn,
        fmt::format("{} did not close in {:.3g} s: {}, {} of it are apart, by up to {:.3g} m at {} {}{}",
                    counted(open.size(), "seam", "seams"), state.time, seam,
                    counted(worst.pairs, "pair of vertices", "pairs of vertices"), worst.widest, place, cause,
                    waiting == 0 ? "" : fmt::format("; {} of a later order wait for that", waiting))};
}

RunEnding explain_ending(const Audit& audited, const Scene& scene, const State& state)
{
    const Vec3& place = audited.found.place;
    return {RunStatus::Penetration,
            fmt::format("the cloth reaches {:.3g} m into {} at [{:.6g}, {:.6g}, {:.6g}], at t = {} s",
                        audited.found.depth, name_obstacle(scene, audited.obstacle), place.x(), place.y(),
                        place.z(), state.time)};
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
