// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/infeasible.h"

#include <cmath>
#include <vector>

namespace arris {

namespace {

/// Contacts with obstacles that the step cannot meet, in the order of their constraints.
std::vector<const Contact*> list_unmet(const UnmetStep& step, const std::optional<int>& overconstrained)
{
    std::vector<const Contact*> unmet;
    if (overconstrained) {
        for (const Contact& contact : step.contacts)
            if (contact.is_squeezed() && contact.has_vertex(*overconstrained)) unmet.push_back(&contact);
        return unmet;
    }
    for (const int row : step.rows)
        for (const Contact& contact : step.contacts)
            if (contact.row == row && !contact.is_with_itself()) unmet.push_back(&contact);
    return unmet;
}

/// Pin (index) that holds the vertex; -1 without one.
int find_pin(const UnmetStep& step, int vertex)
{
    for (const PinTarget& held : step.pin_targets)
        if (held.vertex == vertex) return held.pin;
    return -1;
}

/// First pinned vertex of the contacts, else their first vertex; -1 without contacts.
int find_vertex(const UnmetStep& step, const std::vector<const Contact*>& unmet)
{
    int named = -1;
    for (const Contact* contact : unmet)
        for (const int v : contact->vertices) {
            if (v < 0 || !contact->has_vertex(v)) continue;
            if (find_pin(step, v) >= 0) return v;
            if (named < 0) named = v;
        }
    return named;
}

/// Obstacle whose contact faces `unmet` most directly at the vertex; -1 without one. A contact that is a
/// bound of the velocity solve is never among the unmet constraints.
int find_opponent(const UnmetStep& step, int vertex, const Contact& unmet)
{
    int opponent = -1;
    double least = 0.0;
    for (const Contact& contact : step.contacts) {
        const double cosine = contact.normal.dot(unmet.normal);
        if (contact.is_with_itself() || contact.obstacle == unmet.obstacle || !contact.has_vertex(vertex) ||
            !(cosine < least))
            continue;
        opponent = contact.obstacle;
        least = cosine;
    }
    return opponent;
}

/// Obstacle that presses one element of the constraint most directly towards the other; -1 without one.
int find_presser(const UnmetStep& step, const Contact& pair)
{
    int presser = -1;
    double least = 0.0;
    for (const Contact& contact : step.contacts)
        for (int i = 0; i < 4; ++i) {
            if (contact.is_with_itself() || pair.weights[i] == 0.0 || !contact.has_vertex(pair.vertices[i]))
                continue;
            const double cosine = std::copysign(1.0, pair.weights[i]) * contact.normal.dot(pair.normal);
            if (!(cosine < least)) continue;
            presser = contact.obstacle;
            least = cosine;
        }
    return presser;
}

/// Names a contact of the cloth with itself that the velocity solve could not meet; one with pins before
/// others. Without such a contact nothing is named.
Infeasible name_self_contact(const State& state, const UnmetStep& step)
{
    Infeasible named;
    for (const Contact& contact : step.contacts) {
        if (!contact.is_with_itself() || !step.is_unmet(contact.row)) continue;
        Infeasible found;
        found.is_with_itself = true;
        for (int i = 0; i < 4; ++i) {
            if (contact.weights[i] == 0.0) continue;
            const int vertex = contact.vertices[i], pin = find_pin(step, vertex);
            const bool is_first = found.vertex < 0 || (found.pin < 0 && pin >= 0);
            if (is_first) {
                found.vertex = state.ids[vertex];
                found.pin = pin;
            } else if (pin >= 0 && pin != found.pin) {
                found.layer_pin = pin;
            }
        }
        if (found.layer_pin < 0) found.obstacles[0] = find_presser(step, contact);
        const auto pins = [](const Infeasible& of) { return (of.pin >= 0) + (of.layer_pin >= 0); };
        if (!named.is_with_itself || pins(found) > pins(named)) named = found;
    }
    return named;
}

}  // namespace

Infeasible name_infeasible(const State& state, const UnmetStep& step,
                           const std::optional<int>& overconstrained)
{
    Infeasible named;
    const std::vector<const Contact*> unmet = list_unmet(step, overconstrained);
    const int vertex = overconstrained ? *overconstrained : find_vertex(step, unmet);
    const int pin = vertex < 0 ? -1 : find_pin(step, vertex);
    // An obstacle that presses free cloth against pinned cloth leaves both contacts unmet: the pin tells
    // more.
    if (pin < 0) {
        const Infeasible layers = name_self_contact(state, step);
        if (vertex < 0 || layers.pin >= 0) return layers;
    }
    named.vertex = state.ids[vertex];
    named.pin = pin;
    for (const Contact* contact : unmet) {
        if (!contact->has_vertex(vertex)) continue;
        if (named.obstacles[0] < 0) named.obstacles[0] = contact->obstacle;
        if (named.pin < 0 && named.obstacles[1] < 0)
            named.obstacles[1] = find_opponent(step, vertex, *contact);
    }
    return named;
}

}  // namespace arris
