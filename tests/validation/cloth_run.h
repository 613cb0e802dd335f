// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/step.h"

namespace arris {

ClothMesh make_sheet(Vec2 size, std::array<int, 2> resolution, GridPattern pattern,
                     double pattern_angle = 0.0);

/// Flat, the material's origin at `corner`, m.
void lay(ClothMesh& mesh, const Vec3& corner);

/// Cloth with EOL vertices under gravity, and a table: a box of `size` (m) about `middle`.
Scene make_table_scene(const ClothMesh& mesh, const Material& material, const Vec3& size, const Vec3& middle);

/// What is at rest and then accelerated evenly BDF2 takes too far by this times h^2 times the acceleration,
/// all of it in its first step: that is made in a third and the rest, the third with implicit Euler.
inline constexpr double kBdf2StartLag = 99.0 / 720.0;

/// Everything a run needs. Cloth at rest unless `velocity` (m/s) says otherwise.
struct ClothRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;

    ClothRun(Scene a_scene, ClothMesh mesh, const Vec3& velocity = Vec3::Zero());

    using Look = std::function<void(const StepReport&)>;

    /// One step of `dt` (s); `look` is called after it, or after each of its parts. A step that does not end
    /// well fails the test.
    StepReport advance(double dt, const Look& look = {});

    /// Equal steps of about `dt`, the last one ending `duration` from now.
    void advance(double duration, double dt, const Look& look = {});
};

/// Kinetic and potential, of the run's present state.
ClothEnergy measure_energy(ClothRun& run);

/// Of kinetic and potential energy together, J.
struct EnergySpan {
    double first = 0.0, greatest = 0.0, last = 0.0;
};

/// Equal steps of at most `dt` (s) for `duration`, or until a test fails; `look` is called after each.
EnergySpan watch_energy(ClothRun& run, double duration, double dt,
                        const std::function<void(const StepReport&)>& look);

/// Brings the cloth to where its forces balance: implicit Euler steps that each start from rest, and grow
/// until they are Newton's. Fails the test where it is not still after a bounded number of them.
void settle(ClothRun& run);

}  // namespace arris
