// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/contact_history.h"

#include <algorithm>

namespace arris {

namespace {

constexpr int kPasses = 3;  // contacts of a vertex and of its neighbours affect each other

/// Components of q~ and v~ along the contact's normal if its point had ridden on the carrier for two steps.
struct RiddenHistory {
    double position, velocity;
};

RiddenHistory find_ridden(const Carrier& carrier, const State& state, double forward, const Contact& contact)
{
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
        const int v = contact.vertices[i];
        const Vec3 gained = carrier.velocity_gained(v, state.mesh.world[v]);
        position += contact.weights[i] * ridden_position(carrier, state, forward, v);
        velocity += contact.weights[i] * (state.velocity[v] + forward * gained);
    }
    return {contact.normal.dot(position), contact.normal.dot(velocity)};
}

/// Whether the extrapolated history runs into the contact, or the contact pressed.
bool runs_into(const Carrier& carrier, const Contact& contact, double shift)
{
    if (contact.was_active()) return true;
    const auto distance = [&](const std::vector<Vec3>& place) {
        return contact.local_normal.dot(contact.at(place) - contact.local_point);
    };
    return distance(carrier.motion.begin) + shift < contact.least_gap &&
           distance(carrier.motion.end) < contact.least_gap;
}

/// Changes a field and its material counterpart by `amount` along the contact's normal, with the least
/// change.
void shift_along(const std::vector<EolCoordinates>& eol, const std::vector<double>& mobility,
                 const Contact& contact, double amount, std::vector<Vec3>& world, std::vector<Vec2>& material)
{
    if (contact.eol < 0) return contact.shift(amount * contact.normal, mobility, world);
    const EolCoordinates& at = eol[contact.eol];
    world[at.vertex] += amount * (at.basis * at.opening);
    at.for_points(amount * (at.material_basis * at.opening),
                  [&](int p, const Vec2& change) { material[p] += change; });
}

/// Change of v~ at a contact's point that takes its impact's friction out. `impact`: change of the velocity
/// off the plane in the last step, m/s. `extrapolated`: part of v~ beyond v_k, m/s. Contacts that share
/// vertices take it out once.
Vec3 friction_left(double coefficient, const ContactFriction& last, double impact, double forward,
                   const Vec3& expected, const Vec3& extrapolated)
{
    if (!(impact > 0.0) || !(last.budget > 0.0)) return Vec3::Zero();
    // friction / normal force = coefficient * force / budget
    const Vec3 friction = coefficient * impact / last.budget * last.force;
    const double size = friction.norm();
    if (!(size > 0.0)) return Vec3::Zero();
    const Vec3 direction = friction / size;
    return std::min(0.0, direction.dot(expected - extrapolated) - forward * size) * direction;
}

/// Velocity that the carrier has gained during the last step at the contact's point, m/s.
Vec3 gain_of(const Carrier& carrier, const State& state, const Contact& contact)
{
    Vec3 gained = Vec3::Zero();
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
        const int v = contact.vertices[i];
        gained += contact.weights[i] * carrier.velocity_gained(v, state.mesh.world[v]);
    }
    return gained;
}

}  // namespace

bool flatten_history(const State& state, const Carriers& carriers, const std::vector<EolCoordinates>& eol,
                     const std::vector<double>& mobility, std::size_t first,
                     const std::vector<Contact>& contacts, Prediction& prediction)
{
    bool is_changed = false;
    for (int pass = 0; prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t c = first; c < contacts.size(); ++c) {
            const Contact& contact = contacts[c];
            if (contact.is_squeezed() || contact.is_floor) continue;  // no impact
            const Carrier& carrier = carriers[contact.obstacle];
            const RiddenHistory ridden = find_ridden(carrier, state, prediction.forward, contact);
            const double shift = contact.normal.dot(contact.at(prediction.position)) - ridden.position;
            if (!runs_into(carrier, contact, shift)) continue;
            const double gained = ridden.velocity - contact.normal.dot(contact.at(prediction.velocity));
            shift_along(eol, mobility, contact, -shift, prediction.position, prediction.material);
            shift_along(eol, mobility, contact, gained, prediction.velocity, prediction.material_velocity);
            is_changed = true;
        }
    return is_changed;
}

void flatten_friction(const Scene& scene, const State& state, const Carriers& carriers,
                      const std::vector<double>& mobility, std::size_t first,
                      const std::vector<Contact>& contacts, Prediction& prediction)
{
    for (int pass = 0; scene.friction && prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t c = first; c < contacts.size(); ++c) {
            const Contact& contact = contacts[c];
            if (!contact.was_active() || contact.eol >= 0) continue;
            const Vec3 now = contact.at(state.velocity);
            const Vec3 change = now - contact.at(state.previous_velocity);
            const Vec3 gained = gain_of(carriers[contact.obstacle], state, contact);
            contact.shift(friction_left(friction_at(scene, state.mesh, contact), contact.last_friction,
                                        contact.normal.dot(change - gained), prediction.forward,
                                        prediction.forward * change, contact.at(prediction.velocity) - now),
                          mobility, prediction.velocity);
        }
}

}  // namespace arris
