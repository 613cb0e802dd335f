// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/energy_balance.h"

#include <algorithm>
#include <cmath>

#include "geometry/tolerances.h"
#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"
#include "solver/contact/constraints.h"
#include "solver/contact/squeezed.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/feature_impulses.h"
#include "solver/velocity_solve/symmetric_product.h"

namespace arris {

namespace {

// Tolerance on the energy rise and on unforeseen energy of a step, as a share of `energy_scale`. Quiet BDF2
// stays below 1e-3; where the linearisation fails, the share is a few per cent to nearly 100 %.
constexpr double kRise = 0.003;

// Tolerance on the driven work, as a share of that work. Forces at a step's end stand for their mean over the
// step. After a jerk forces ebb away, and the work comes out too small: by 6 % where measured.
constexpr double kDriven = 0.25;

void subtract_row(const ConstraintRow& row, double multiplier, Eigen::VectorXd& impulse)
{
    for (int e = 0; e < row.count; ++e) impulse[row.coordinate[e]] -= multiplier * row.coefficient[e];
}

/// Work of pins, J. A u - b is the impulse of all constraints. Without the impulses of contacts and friction,
/// the pins' impulses remain along the pinned coordinates.
double work_of_pins(const State& state, const Workspace& work)
{
    if (work.pin_targets.empty()) return 0.0;
    Eigen::VectorXd impulse =
        symmetric_product(work.mesh.system.matrix(), work.solution.velocity) - work.mesh.system.rhs();
    for (std::size_t k = 0; k < work.problem.rows.size(); ++k)
        subtract_row(work.problem.rows[k], work.solution.row_multipliers[static_cast<Eigen::Index>(k)],
                     impulse);
    for (std::size_t p = 0; p < work.problem.friction.size(); ++p)
        for (int d = 0; d < 2; ++d)
            subtract_row(work.problem.friction[p].slip[d], work.solution.friction[p][d], impulse);
    double sum = 0.0;
    for (const PinTarget& held : work.pin_targets) {
        int coordinate = 3 * held.vertex;  // pinned axes come first
        for (int d = 0; d < 3; ++d)
            if (held.held[d])
                sum += impulse[coordinate++] * (held.target[d] - state.mesh.world[held.vertex][d]);
    }
    return sum / work.prediction.gamma;
}

/// Work of contacts, J, without the bounds of EOL vertices. A contact pushes along its normal.
double work_of_rows(const std::vector<double>& multiplier, const Workspace& work)
{
    double sum = 0.0;
    for (std::size_t c = 0; c < work.contacts.size(); ++c) {
        const Contact& contact = work.contacts[c];
        if (contact.eol >= 0) continue;
        sum += multiplier[c] * way_along(work.carriers, contact);
    }
    return sum / work.prediction.gamma;
}

/// Work of features on their EOL vertices, J. A moving feature carries a vertex with the whole impulse that
/// holds the vertex there. This includes the direction across the feature, in which material flows: cloth
/// that leaves to one side pulls at the feature. Impulses of other contacts count in `work_of_rows`. Going
/// round a wire with the cloth counts as no work: nothing drives that motion.
double work_of_features(const State& state, const std::vector<double>& multiplier, const Workspace& work)
{
    const std::vector<Vec3> impulse = find_feature_impulses(state, multiplier, work);
    double sum = 0.0;
    for (const EolCoordinates& vertex : work.eol) {
        const int v = vertex.vertex;
        const Carrier& carrier = work.carriers[state.eol[vertex.entry].on.obstacle];
        sum += impulse[v].dot(carrier.end(carrier.motion.begin[v]) - state.mesh.world[v]);
    }
    return sum / work.prediction.gamma;
}

/// Work of friction on moving obstacles, J, without EOL vertices, for which `work_of_features` includes it.
double work_of_friction(const Workspace& work)
{
    double sum = 0.0;
    for (const SlipContact& slipping : work.slip_contacts) {
        const Contact& contact = work.contacts[slipping.contact];
        if (contact.eol >= 0) continue;
        const Carrier& carrier = work.carriers[contact.obstacle];
        sum += contact.friction.force.dot(carrier.at_end(contact) - carrier.at_begin(contact));
    }
    return sum;
}

double work_of_obstacles(const State& state, const Workspace& work)
{
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    return work_of_rows(multiplier, work) + work_of_friction(work) +
           work_of_features(state, multiplier, work);
}

ClothVelocity velocity_of(const Proposal& proposal)
{
    return {proposal.velocity, proposal.material_velocity};
}

/// The workspace's elements where material has flowed to `material`.
ClothElements elements_at(const Workspace& work, const std::vector<Vec2>& material)
{
    ClothElements elements = work.mesh.elements;
    std::vector<char> is_moved(material.size(), 0);
    for (const EolCoordinates& vertex : work.eol) is_moved[vertex.vertex] = 1;
    update_elements({material, {}, work.mesh.faces_of_elements}, is_moved, elements);
    return elements;
}

/// Velocity, m/s, of the push from the positions to which the proposal's velocity leads to its own positions.
std::vector<Vec3> push_velocity(const Workspace& work, double dt)
{
    std::vector<Vec3> velocity = work.proposal.world;
    const MovingCloth from = find_end(work.prediction, velocity_of(work.proposal));
    for (std::size_t v = 0; v < velocity.size(); ++v) velocity[v] = (velocity[v] - from.world[v]) / dt;
    return velocity;
}

double total_area(const ClothElements& elements)
{
    double area = 0.0;
    for (const FaceElement& face : elements.faces) area += face.area;
    return area;
}

/// Elastic energy, J, that squeezed cloth gains over the step.
double energy_of_squeezing(const Workspace& work)
{
    if (std::none_of(work.contacts.begin(), work.contacts.end(),
                     [](const Contact& contact) { return contact.is_squeezed(); }))
        return 0.0;
    return energy_stored(work.carriers, work.contacts,
                         find_end(work.prediction, velocity_of(work.proposal)).world);
}

/// Elastic energy, J, of strains due to round-off alone, for positions as far from the origin as the cloth's.
double round_off_energy(const Scene& scene, const State& state, const ClothElements& elements)
{
    double far = 0.0;
    for (const Vec3& x : state.mesh.world) far = std::max(far, x.cwiseAbs().maxCoeff());
    const double squared_length = total_area(elements) / static_cast<double>(elements.faces.size());
    return integrate(&Material::youngs_modulus, scene.materials, elements) * kLastPlaces * kLastPlaces * far *
           far / squared_length;
}

Energies compute_potential_energy(const Workspace& work, const MovingCloth& cloth)
{
    if (work.eol.empty()) return compute_energies(work.mesh.elements, work.mesh.terms, cloth.world);
    return compute_energies(elements_at(work, cloth.material), work.mesh.terms, cloth.world);
}

}  // namespace

ClothEnergy compute_cloth_energy(const Scene& scene, const Workspace& work, const MovingCloth& cloth)
{
    if (work.eol.empty())
        return {kinetic_energy(scene.materials, work.mesh.elements, cloth.velocity.world),
                compute_energies(work.mesh.elements, work.mesh.terms, cloth.world)};
    const ClothElements elements = elements_at(work, cloth.material);
    const CornerVelocities corners =
        compute_corner_velocities(elements, cloth.world, cloth.velocity.world, cloth.velocity.material);
    return {kinetic_energy(scene.materials, elements, corners),
            compute_energies(elements, work.mesh.terms, cloth.world)};
}

ClothEnergy find_energy(const Scene& scene, const State& state, const Workspace& work)
{
    const MovingCloth& known = work.energies.known_at;
    const bool is_known = known.world == state.mesh.world && known.material == state.mesh.material &&
                          known.velocity.world == state.velocity &&
                          known.velocity.material == state.material_velocity;
    if (is_known) return work.energies.known;
    return compute_cloth_energy(
        scene, work, {state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}});
}

double compute_driven_work(const State& state, const Workspace& work)
{
    std::vector<Vec3> displacement = find_end(work.prediction, velocity_of(work.proposal)).world;
    for (std::size_t v = 0; v < displacement.size(); ++v) displacement[v] -= state.mesh.world[v];
    return work_of_pins(state, work) + work_of_obstacles(state, work) +
           compute_load_work(state.mesh, work.mesh.elements, work.mesh.terms, work.linearization,
                             work.proposal.velocity, displacement);
}

double energy_scale(const Workspace& work)
{
    const ClothEnergy& before = work.energies.start;
    const ClothEnergy& after = work.energies.solved;
    double exchanged = 0.0, size = 0.0;
    for (const auto& [a, b] : {std::pair(before.kinetic, after.kinetic),
                               std::pair(before.potential.gravity, after.potential.gravity),
                               std::pair(before.potential.stretch, after.potential.stretch),
                               std::pair(before.potential.bending, after.potential.bending),
                               std::pair(before.potential.seam, after.potential.seam)}) {
        exchanged += std::abs(b - a);
        size += std::abs(a) + std::abs(b);
    }
    return work.energies.floor + before.kinetic + exchanged + kAccumulated * size;
}

double find_energy_rise(const Scene& scene, const State& state, const Workspace& work)
{
    double allowed = kRise * energy_scale(work);
    double rise = work.energies.solved.sum() - work.energies.start.sum() + energy_of_squeezing(work);
    if (!(rise > allowed)) return 0.0;
    allowed += round_off_energy(scene, state, work.mesh.elements);
    const double driven = compute_driven_work(state, work);
    rise -= std::max(driven, 0.0);
    allowed += kDriven * std::abs(driven);
    return rise > allowed ? rise : 0.0;
}

double find_unforeseen_energy(const Scene& scene, const State& state, const Workspace& work)
{
    // A third difference over thirds of the way is 4/9 of a fourth-order term and 2/9 of a third-order term.
    // The stretch of cloth that moves across itself is of fourth order.
    const double least = kRise * energy_scale(work) + round_off_energy(scene, state, work.mesh.elements);
    const Energies &before = work.energies.start.potential, &after = work.energies.solved.potential;
    const ClothVelocity& from = work.expansion;
    const ClothVelocity to = velocity_of(work.proposal);
    const auto potential_at = [&](const ClothVelocity& velocity) {
        return compute_potential_energy(work, find_end(work.prediction, velocity));
    };
    const Energies at_expansion = potential_at(from);
    // Oscillating cloth overshoots at v^ and has up to three times its elastic energy there.
    constexpr double kFarMore = 5.0;
    const double far_more = at_expansion.elastic() - kFarMore * (after.elastic() + before.elastic());
    if (far_more > least) return far_more;
    const double third = after.sum() - at_expansion.sum() +
                         3.0 * (potential_at(blend(from, to, 1.0 / 3.0)).sum() -
                                potential_at(blend(from, to, 2.0 / 3.0)).sum());
    const double unforeseen = 9.0 / 4.0 * std::abs(third);
    return unforeseen > least ? unforeseen : 0.0;
}

void measure_start_energy(const Scene& scene, const State& state, Workspace& work)
{
    // Share of m g L that counts as a change: cloth at rest moves by round-off and as constraints give way.
    // In a stack of layers, where other constraints press in each step, all of it moves by up to 2e-8 of its
    // size. Without this share, changes at rest would be compared with themselves.
    constexpr double kRest = 1e-5;
    const ClothElements& elements = work.mesh.elements;
    work.energies.floor = scene.gravity
                              ? kRest * integrate(&Material::density, scene.materials, elements) *
                                    scene.gravity->acceleration.norm() * std::sqrt(total_area(elements))
                              : 0.0;
    work.energies.start = find_energy(scene, state, work);
    // Springs of seams become shorter: the energy that they take up so is work done on the cloth.
    work.energies.start.potential.seam = compute_spring_energy(elements, work.mesh.terms, state.mesh.world);
}

void measure_proposal_energy(const Scene& scene, double dt, Workspace& work)
{
    // Push that counts as none, as a share of the cloth's size: above round-off, and a third of kRise of what
    // `measure_start_energy` takes for rest.
    constexpr double kStill = 1e-8;
    const double still = kStill * std::sqrt(total_area(work.mesh.elements)) / dt;
    const Proposal& proposal = work.proposal;
    MovingCloth end = find_end(work.prediction, velocity_of(proposal));
    double fastest = 0.0;
    if (end.world != proposal.world)  // contacts or pins have moved the proposal
        for (const Vec3& v : push_velocity(work, dt)) fastest = std::max(fastest, v.squaredNorm());
    if (fastest > still * still) work.energies.solved = compute_cloth_energy(scene, work, end);
    end.world = proposal.world;
    work.energies.proposed = compute_cloth_energy(scene, work, end);
    if (!(fastest > still * still)) work.energies.solved = work.energies.proposed;
}

bool does_push_out_strain(const Scene& scene, double dt, const Workspace& work)
{
    const Energies& before = work.energies.solved.potential;
    const Energies& after = work.energies.proposed.potential;
    const double cost = after.elastic() - before.elastic();
    const double unseen = kRise * (work.energies.solved.kinetic + before.elastic());
    if (!(cost > unseen)) return false;
    const double push = kinetic_energy(scene.materials, work.mesh.elements, push_velocity(work, dt));
    return cost > push + unseen;
}

double compute_step_objective(const Scene& scene, const Workspace& work, const ClothVelocity& velocity)
{
    MovingCloth end = find_end(work.prediction, velocity);
    for (std::size_t v = 0; v < end.world.size(); ++v) end.velocity.world[v] -= work.prediction.velocity[v];
    for (std::size_t p = 0; p < end.material.size(); ++p)
        end.velocity.material[p] -= work.prediction.material_velocity[p];
    return compute_cloth_energy(scene, work, end).sum();
}

}  // namespace arris
