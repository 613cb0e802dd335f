// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/impact_friction.h"

#include <algorithm>

namespace arris {

namespace {

constexpr int kPasses = 3;  // contacts of neighbours affect each other

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

/// Velocity that the obstacle has gained during the last step at the contact's point, m/s.
Vec3 gain_of_obstacle(const Obstacle& obstacle, const ObstacleStep& step, const State& state,
                      const Contact& contact)
{
    Vec3 gained = Vec3::Zero();
    for (int i = 0; i < 3 && contact.in_frame.vertices[i] >= 0; ++i) {
        const int v = contact.in_frame.vertices[i];
        gained += contact.in_frame.weights[i] * (obstacle.velocity_after(state.time, state.mesh.world[v]) -
                                                 obstacle.velocity_after(state.time - state.previous_dt,
                                                                         step.before(step.motion.begin[v])));
    }
    return gained;
}

}  // namespace

void flatten_friction(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps,
                      std::size_t first, const std::vector<Contact>& contacts, Prediction& prediction)
{
    for (int pass = 0; scene.friction && prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t c = first; c < contacts.size(); ++c) {
            const Contact& contact = contacts[c];
            if (!contact.was_active() || contact.eol >= 0) continue;
            const ObstacleContact& at = contact.in_frame;
            const Vec3 change = at.at(state.velocity) - at.at(state.previous_velocity);
            const Vec3 gained =
                gain_of_obstacle(scene.obstacles[contact.obstacle], steps[contact.obstacle], state, contact);
            at.shift(friction_left(scene.friction->coefficients[contact.obstacle], contact.last_friction,
                                   contact.normal.dot(change - gained), prediction.forward,
                                   prediction.forward * change,
                                   at.at(prediction.velocity) - at.at(state.velocity)),
                     prediction.velocity);
        }
}

void flatten_self_friction(const Scene& scene, const State& state, const std::vector<double>& mobility,
                           std::size_t first, const std::vector<SelfRow>& rows, Prediction& prediction)
{
    for (int pass = 0; scene.friction && prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t k = first; k < rows.size(); ++k) {
            if (!rows[k].was_active()) continue;
            const SelfContact& contact = rows[k].contact;
            const Vec3 now = contact.difference(state.velocity),
                       change = now - contact.difference(state.previous_velocity);
            contact.shift(
                friction_left(scene.friction->between_layers, rows[k].last_friction,
                              contact.normal.dot(change), prediction.forward, prediction.forward * change,
                              contact.difference(prediction.velocity) - now),
                mobility, prediction.velocity);
        }
}

}  // namespace arris
