// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/friction/friction_budget.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/cloth/cloth_cone.h"
#include "solver/contact/constraints.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

/// A side of the cloth lies on a face of the obstacle where their normals differ by less than this angle.
const double kCosOnFace = std::cos(5.0 * M_PI / 180.0);

/// Largest budget on a feature, relative to mu times its normal impulse. By the capstan's law it is at most
/// pi / 2 for cloth that turns by 180 degrees, and 1 / cos 45 degrees for cloth pressed on one face of a
/// right angle. The sides' impulses alone would give friction to a vertex that is about to lift off.
constexpr double kMostShare = 2.0;

/// One side of the cloth at a feature: unit directions in the plane across it, and its impulses, N s.
struct Side {
    Vec3 normal;   ///< outwards
    Vec3 leaving;  ///< away from the feature
    double tension, pressure;
};

bool lies_on_face(const SlippingCloth& cloth, const EolVertex& eol, const Vec3& normal)
{
    const Obstacle& obstacle = *cloth.carriers[eol.on.obstacle].obstacle;
    if (!is_on_convex_edge(obstacle, eol)) return false;
    const Mat3& rotation = cloth.carriers[eol.on.obstacle].end.rotation;
    const auto& normals = obstacle.features().edges[eol.on.index].normals;
    return std::any_of(normals.begin(), normals.end(),
                       [&](const Vec3& of_face) { return (rotation * of_face).dot(normal) > kCosOnFace; });
}

std::array<Side, 2> find_sides(const SlippingCloth& cloth, const EolCoordinates& at,
                               const TraceSides& cloth_sides)
{
    const Vec3 tangent = cloth.at.basis[at.vertex].col(1), outward = cloth.at.basis[at.vertex].col(0);
    std::array<Side, 2> sides;
    for (int k = 0; k < 2; ++k) {
        const Vec3& sum = cloth_sides.normal[k];
        Side& side = sides[k];
        side.normal = (sum - tangent.dot(sum) * tangent).stableNormalized();
        side.leaving = side.normal.cross(tangent);
        if (side.leaving.dot(cloth_sides.leaving[k]) < 0.0) side.leaving = -side.leaving;
        if (side.normal.dot(outward) < 0.0) side.normal = -side.normal;
    }
    // The force that turns the flow is no pressure on the edge.
    const Vec3 sum = sides[0].leaving + sides[1].leaving;
    constexpr double kFlat = 1e-9;
    const double flux = sum.squaredNorm() > kFlat ? -cloth_sides.flux.dot(sum) / sum.squaredNorm() : 0.0;
    for (int k = 0; k < 2; ++k) {
        sides[k].tension = -cloth_sides.impulse[k].dot(sides[k].leaving) - flux;
        const bool is_on_face = lies_on_face(cloth, cloth.state.eol[at.entry], sides[k].normal);
        sides[k].pressure = is_on_face ? std::max(0.0, cloth_sides.impulse[k].dot(sides[k].normal)) : 0.0;
    }
    return sides;
}

/// `force`: the present friction on the cloth, along and across the feature. It points to the left of the
/// trace where its second component is positive.
double capstan_budget(const std::array<Side, 2>& sides, const Vec3& outward, double mu,
                      const Eigen::Vector2d& force)
{
    const Vec3 sum = sides[0].leaving + sides[1].leaving;
    const double phi = sum.dot(outward) >= 0.0
                           ? 0.0
                           : std::acos(std::clamp(-sides[0].leaving.dot(sides[1].leaving), -1.0, 1.0));
    constexpr double kLeastCosine = 1e-3;
    const double size = force.norm();
    const double cosine = size > 0.0 ? std::max(kLeastCosine, std::abs(force[1]) / size) : 1.0;
    // Friction on the cloth points to the side from which the material comes.
    const int up = force[1] > 0.0 ? 0 : 1, down = 1 - up;
    const double turn =
        std::tanh(0.5 * mu * phi * cosine) / cosine *
        (sides[0].tension + sides[1].tension + mu * cosine * (sides[up].pressure - sides[down].pressure));
    return std::max(0.0, turn) + mu * (sides[0].pressure + sides[1].pressure);
}

/// At a corner or point: mu times the pressure's sum over that of its parts along the normal force, for a cap
/// of uniform pressure whose normals reach `beta` from outward.
double cap_factor(const SlippingCloth& cloth, const EolCoordinates& at)
{
    const int v = at.vertex;
    const Star star = look_around(cloth.state.mesh, cloth.stars, v, cloth.state.mesh.world);
    const Vec3 outward = cloth.at.basis[v].col(0);
    double least = 1.0;
    for (const StarFace& face : star.faces) least = std::min(least, std::abs(face.normal.dot(outward)));
    return 2.0 / (1.0 + least);
}

std::vector<TraceVertex> find_trace_vertices(const SlippingCloth& cloth,
                                             const std::vector<SlipContact>& slip_contacts,
                                             std::vector<int>& slot)
{
    std::vector<TraceVertex> vertices;
    slot.assign(slip_contacts.size(), -1);
    for (std::size_t r = 0; r < slip_contacts.size(); ++r) {
        if (cloth.contacts[slip_contacts[r].contact].eol < 0) continue;
        const EolCoordinates& at = cloth.eol[cloth.contacts[slip_contacts[r].contact].eol];
        if (cloth.state.eol[at.entry].on.is_fixed()) continue;
        slot[r] = static_cast<int>(vertices.size());
        vertices.push_back({at.vertex, at.trace});
    }
    return vertices;
}

}  // namespace

std::vector<double> compute_budgets(const SlippingCloth& cloth, const Terms& terms,
                                    const std::vector<SlipContact>& slip_contacts,
                                    const VelocitySolution& solution)
{
    const std::vector<double> multiplier = contact_multipliers(cloth.contacts, solution);
    std::vector<int> slot;
    const std::vector<TraceVertex> vertices = find_trace_vertices(cloth, slip_contacts, slot);
    std::vector<TraceSides> sides;
    if (!vertices.empty())
        sides = compute_trace_sides(vertices, cloth.elements, terms, cloth.at, solution.velocity);
    std::vector<double> budgets;
    for (std::size_t r = 0; r < slip_contacts.size(); ++r) {
        const Contact& contact = cloth.contacts[slip_contacts[r].contact];
        const double normal = multiplier[slip_contacts[r].contact], mu = slip_contacts[r].coefficient;
        double budget = mu * normal;
        if (normal > 0.0 && contact.eol >= 0) {
            const EolCoordinates& at = cloth.eol[contact.eol];
            if (slot[r] < 0) {
                budget *= cap_factor(cloth, at);
            } else {
                const Eigen::Vector2d& force = solution.friction[r];
                budget = std::min(
                    kMostShare * budget,
                    capstan_budget(find_sides(cloth, at, sides[slot[r]]), cloth.at.basis[at.vertex].col(0),
                                   mu, force.norm() > 0.0 ? force : Eigen::Vector2d(-solution.slip[r])));
            }
        }
        budgets.push_back(budget);
    }
    return budgets;
}

}  // namespace arris
