// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/energies.h"

#include "geometry/batches.h"
#include "physics/forces/membrane.h"

namespace arris {

namespace {

double& energy_of(Energies& energies, EnergyKind kind)
{
    switch (kind) {
        case EnergyKind::Gravity:
            return energies.gravity;
        case EnergyKind::Bending:
            return energies.bending;
        case EnergyKind::Seam:
            return energies.seam;
        default:
            return energies.stretch;
    }
}

/// The impulse b - A v' (N s) of one term on a corner, where vertices move with `velocity`.
Vec3 impulse_on(int i, const FaceSystem& system, const FaceElement& face, const Linearization& at,
                const std::vector<Vec3>& velocity)
{
    Vec3 impulse = system.rhs(i);
    for (int j = 0; j < 3; ++j) {
        const Vec3 relative = velocity[face.vertices[j]] - at.drift[face.vertices[j]];
        if (j <= i)
            impulse -= system.matrix(i, j) * relative;
        else
            impulse -= system.matrix(j, i).transpose() * relative;
    }
    return impulse;
}

}  // namespace

Energies& Energies::operator+=(const Energies& other)
{
    gravity += other.gravity;
    stretch += other.stretch;
    bending += other.bending;
    seam += other.seam;
    return *this;
}

Energies compute_energies(const ClothElements& elements, const Terms& terms,
                          const std::vector<Vec3>& position)
{
    const auto add = [](const auto& element_terms, const auto& state, Energies& sum) {
        for (const auto& term : element_terms)
            if (const EnergyKind kind = term->energy_kind(); kind != EnergyKind::None)
                energy_of(sum, kind) += term->energy(state);
    };
    Energies energies =
        sum_in_batches<Energies>(static_cast<int>(elements.faces.size()), [&](int first, int last) {
            Energies sum;
            for (int f = first; f < last; ++f) add(terms.faces, FaceState(elements.faces[f], position), sum);
            return sum;
        });
    energies.seam = compute_spring_energy(elements, terms, position);
    if (terms.hinges.empty()) return energies;
    const HingeStates hinges(elements, terms, position);
    energies += sum_in_batches<Energies>(static_cast<int>(elements.hinges.size()), [&](int first, int last) {
        Energies sum;
        for (int h = first; h < last; ++h) add(terms.hinges, hinges[h], sum);
        return sum;
    });
    return energies;
}

double compute_spring_energy(const ClothElements& elements, const Terms& terms,
                             const std::vector<Vec3>& position)
{
    double energy = 0.0;
    for (const SpringElement& spring : elements.springs)
        for (const auto& term : terms.springs) energy += term->energy(SpringState(spring, position));
    return energy;
}

double compute_load_work(const ClothMesh& mesh, const ClothElements& elements, const Terms& terms,
                         const Linearization& at, const std::vector<Vec3>& velocity,
                         const std::vector<Vec3>& displacement)
{
    double sum = 0.0;
    if (!terms.loads.empty()) {
        std::vector<Vec3> load(displacement.size(), Vec3::Zero());
        for (const auto& term : terms.loads) term->add(mesh, at, load);
        for (std::size_t v = 0; v < load.size(); ++v) sum += load[v].dot(displacement[v]);
    }
    for (const auto& term : terms.faces) {
        if (!term->is_drive()) continue;
        for (const FaceElement& face : elements.faces) {
            FaceSystem system(at, face.vertices, face.piece);
            term->add(FaceState(face, at.position), system);
            for (int i = 0; i < 3; ++i)
                sum +=
                    impulse_on(i, system, face, at, velocity).dot(displacement[face.vertices[i]]) / at.gamma;
        }
    }
    return sum;
}

FaceReadings compute_face_readings(const ClothElements& elements, const Terms& terms,
                                   const std::vector<Vec3>& position)
{
    FaceReadings readings;
    readings.strain.resize(elements.faces.size());
    readings.stretch_energy.assign(elements.faces.size(), 0.0);
    readings.bending_energy.assign(elements.faces.size(), 0.0);
    for_each_in_batches(static_cast<int>(elements.faces.size()), [&](int f) {
        const FaceState face(elements.faces[f], position);
        readings.strain[f] = principal_stretches(face.F)[0] - 1.0;
        for (const auto& term : terms.faces)
            if (term->energy_kind() == EnergyKind::Stretch) readings.stretch_energy[f] += term->energy(face);
    });
    if (terms.hinges.empty()) return readings;
    const HingeStates hinges(elements, terms, position);
    for (std::size_t h = 0; h < elements.hinges.size(); ++h)
        for (const auto& term : terms.hinges)
            if (term->energy_kind() == EnergyKind::Bending)
                for (const int f : elements.hinges[h].faces)
                    readings.bending_energy[f] += 0.5 * term->energy(hinges[h]);
    return readings;
}

}  // namespace arris
