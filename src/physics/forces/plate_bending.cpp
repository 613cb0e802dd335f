// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/plate_bending.h"

#include <cmath>
#include <utility>

#include "physics/elements/hinge_angle.h"

namespace arris {

namespace {

std::vector<double> stiffnesses_of(const std::vector<PlateMaterial>& plates)
{
    std::vector<double> stiffnesses;
    for (const PlateMaterial& plate : plates) stiffnesses.push_back(plate.stiffness);
    return stiffnesses;
}

}  // namespace

PlateBending::PlateBending(std::vector<PlateMaterial> plates)
    : plates_(std::move(plates)), crease_(stiffnesses_of(plates_))
{
}

double PlateBending::energy(const HingeState& hinge) const
{
    return hinge.element.is_crease() ? crease_.energy(hinge) : hinge.moment->energy;
}

void PlateBending::add(const HingeState& hinge, HingeSystem& system) const
{
    if (hinge.element.is_crease()) {
        crease_.add(hinge, system);
        return;
    }
    const HingeMoment& moment = *hinge.moment;
    if (const std::optional<HingeAngle> angle = find_hinge_angle(hinge.x)) {
        // ds = cos(theta/2) dtheta
        const double squared_cosine = angle->squared_cosine();
        const double cosine = std::sqrt(squared_cosine);
        const std::array<Vec3, 4> gradient = angle_gradient(*angle, hinge.x);
        for (int i = 0; i < 4; ++i) {
            system.add_elastic_force(i, -moment.moment * cosine * gradient[i]);
            if (system.damping() > 0.0)
                system.add_force(i, system.damping() * moment.excess_rate * cosine * gradient[i]);
            for (int j = 0; j <= i; ++j)
                system.add_stiffness(
                    i, j, moment.stiffness * squared_cosine * gradient[i] * gradient[j].transpose());
        }
    }
    if (!system.is_eulerian()) return;
    for (int i = 0; i < 4; ++i) system.add_material_force(i, moment.material_force[i]);
}

}  // namespace arris
