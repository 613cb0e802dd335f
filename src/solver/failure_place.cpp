// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/failure_place.h"

#include <algorithm>
#include <cmath>

#include "solver/eol/eol_coordinates.h"

namespace arris {

namespace {

void add_obstacle(int obstacle, FailurePlace& place)
{
    if (obstacle == kClothItself) {
        place.is_with_itself = true;
        return;
    }
    for (int& named : place.obstacles) {
        if (named == obstacle) return;
        if (named >= 0) continue;
        named = obstacle;
        return;
    }
}

/// Names the vertex (index), and what is in contact with it.
void name_vertex(const State& state, const Workspace& work, int vertex, FailurePlace& place)
{
    place.vertex = state.ids[vertex];
    place.world = state.mesh.world[vertex];
    place.material = state.mesh.material[vertex];
    for (const Contact& contact : work.contacts)
        if (contact.has_vertex(vertex)) add_obstacle(contact.obstacle, place);
}

/// The first vertex of a face that meets something on its way; nothing where the proposal is clean.
FailurePlace find_meeting(const State& state, const Workspace& work, const Violations& violations)
{
    FailurePlace place;
    const std::vector<int>* faces = violations.self_faces.empty() ? nullptr : &violations.self_faces;
    for (std::size_t o = violations.faces.size(); o-- > 0;)
        if (!violations.faces[o].empty()) faces = &violations.faces[o];
    if (faces == nullptr) return place;
    for (int o = 0; o < static_cast<int>(violations.faces.size()); ++o)
        if (!violations.faces[o].empty()) add_obstacle(o, place);
    if (!violations.self_faces.empty()) place.is_with_itself = true;
    // A contact of the check tells which of the face's vertices meets the obstacle.
    const Face& face = state.mesh.faces[faces->front()];
    int vertex = face[0];
    for (const Contact& contact : violations.contacts)
        if (const auto met =
                std::find_if(face.begin(), face.end(), [&](int v) { return contact.has_vertex(v); });
            met != face.end()) {
            vertex = *met;
            break;
        }
    name_vertex(state, work, vertex, place);
    return place;
}

/// The EOL vertex that takes too much material from its faces.
FailurePlace find_overrun(const State& state, const Workspace& work, const std::vector<Overrun>& overrun)
{
    FailurePlace place;
    if (overrun.empty()) return place;
    const auto fastest = std::max_element(
        overrun.begin(), overrun.end(),
        [](const Overrun& a, const Overrun& b) { return a.flow.squaredNorm() < b.flow.squaredNorm(); });
    for (const EolCoordinates& eol : work.eol)
        if (eol.vertex == fastest->vertex) add_obstacle(state.eol[eol.entry].on.obstacle, place);
    name_vertex(state, work, fastest->vertex, place);
    return place;
}

/// Multiplier of the last solve, N s; 0 where the contact was not part of it.
double solved_multiplier(const Contact& contact, const VelocitySolution& solution)
{
    if (contact.bound >= 0 && contact.bound < solution.multipliers.size())
        return solution.multipliers[contact.bound];
    if (contact.row >= 0 && contact.row < solution.row_multipliers.size())
        return solution.row_multipliers[contact.row];
    return 0.0;
}

/// The vertex of the contact that presses hardest, in the last solve or before it. Without contacts, the
/// vertex with the stiffest coordinate.
FailurePlace find_hardest_press(const State& state, const Workspace& work)
{
    FailurePlace place;
    double most = 0.0;
    int vertex = -1;
    for (const Contact& contact : work.contacts) {
        const double press = std::max(solved_multiplier(contact, work.solution), contact.last_multiplier);
        if (vertex >= 0 && !(press > most)) continue;
        most = press;
        vertex = contact.vertices[0];
    }
    if (vertex < 0 && work.problem.matrix != nullptr) {
        Eigen::Index stiffest = 0;
        const Eigen::VectorXd diagonal = work.problem.matrix->diagonal();
        if (diagonal.size() > 0) diagonal.maxCoeff(&stiffest);
        vertex = static_cast<int>(stiffest / 3);
    }
    if (vertex >= 0 && vertex < state.mesh.vertex_count()) name_vertex(state, work, vertex, place);
    return place;
}

/// Names the two obstacles that close most on the vertex (id) of a failed step, and the angle between them.
void name_crease(const State& state, const std::vector<Contact>& contacts, std::int64_t id,
                 FailurePlace& place)
{
    const auto at = std::lower_bound(state.ids.begin(), state.ids.end(), id);
    if (at == state.ids.end() || *at != id) return;
    const int vertex = static_cast<int>(at - state.ids.begin());
    std::vector<const Contact*> met;
    for (const Contact& contact : contacts)
        if (!contact.is_with_itself() && !contact.is_fold_plane() && contact.has_vertex(vertex))
            met.push_back(&contact);
    double least = 0.0;  // cosine between the normals
    for (std::size_t i = 0; i < met.size(); ++i)
        for (std::size_t j = i + 1; j < met.size(); ++j) {
            const double cosine = met[i]->normal.dot(met[j]->normal);
            if (!(cosine < least)) continue;
            least = cosine;
            place.crease = {met[i]->obstacle, met[j]->obstacle};
            place.crease_angle = std::acos(std::clamp(-cosine, -1.0, 1.0));
        }
}

FailurePlace find_place(const State& state, const Workspace& work, const Violations& violations,
                        const std::vector<Overrun>& overrun, StepStatus status)
{
    switch (status) {
        case StepStatus::Penetration:
            return find_meeting(state, work, violations);
        case StepStatus::Overrun:
            return find_overrun(state, work, overrun);
        default:
            return find_hardest_press(state, work);
    }
}

}  // namespace

void name_failure(const State& state, const Workspace& work, const Violations& violations,
                  const std::vector<Overrun>& overrun, StepReport& report)
{
    if (report.status == StepStatus::Done || report.status == StepStatus::NotFinite) return;
    report.place = find_place(state, work, violations, overrun, report.status);
    const bool is_named = report.status == StepStatus::Infeasible && report.infeasible.vertex >= 0;
    name_crease(state, work.contacts, is_named ? report.infeasible.vertex : report.place.vertex,
                report.place);
    if (report.status != StepStatus::Infeasible || is_named) return;
    report.infeasible.vertex = report.place.vertex;
    report.infeasible.obstacles = report.place.obstacles;
    report.infeasible.is_with_itself = report.place.is_with_itself && report.place.obstacles[0] < 0;
}

}  // namespace arris
