// SPDX-License-Identifier: GPL-3.0-or-later
#include "deforming_cloth.h"

#include <memory>
#include <utility>

#include "solver/energy_balance.h"

namespace arris {

Scene make_deforming_scene(double thickness)
{
    Scene scene;
    scene.materials[0] = {0.15, 2000.0, 0.3, 1e-5, 0.0, thickness};
    scene.gravity = Gravity{};
    return scene;
}

MovingObstacle make_deforming(ObstacleMesh mesh, FormulaDeformation::Formula place,
                              FormulaDeformation::Formula velocity, std::vector<double> samples)
{
    const auto deformation = std::make_shared<FormulaDeformation>(mesh.points, std::move(place),
                                                                  std::move(velocity), std::move(samples));
    return MovingObstacle("it", std::move(mesh), {}, {}, 30.0, deformation);
}

EnergyBooks extrapolate(const EnergyBooks& coarse, const EnergyBooks& fine)
{
    EnergyBooks limit;
    for (const auto number : {&EnergyBooks::first, &EnergyBooks::driven, &EnergyBooks::lost,
                              &EnergyBooks::by_meshing, &EnergyBooks::last})
        limit.*number = 2.0 * fine.*number - coarse.*number;
    return limit;
}

EnergyBooks keep_books(ClothRun& run, double duration, double dt, const ClothRun::Look& look)
{
    EnergyBooks books;
    books.first = measure_energy(run).sum();
    run.advance(duration, dt, [&](const StepReport& report) {
        // The step's mesh where the step began: the commit has moved its places and velocities on.
        State before = run.state;
        before.mesh.world = run.state.previous_world;
        before.mesh.material = run.state.previous_material;
        run.work.proposal.velocity = run.state.velocity;
        run.work.proposal.material_velocity = run.state.material_velocity;
        books.driven += compute_driven_work(before, run.work);
        books.lost += report.friction_work;
        books.by_meshing += report.remesh_energy;
        if (look) look(report);
    });
    books.last = measure_energy(run).sum();
    return books;
}

}  // namespace arris
