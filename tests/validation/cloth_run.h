// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/step.h"
#include "tests/failures_since.h"

namespace arris {

ClothMesh make_sheet(Vec2 size, std::array<int, 2> resolution, GridPattern pattern,
                     double pattern_angle = 0.0);

/// Lays the cloth flat in the world plane of `corner` (m), which is where the material's origin goes.
void lay(ClothMesh& mesh, const Vec3& corner);

/// A scene with gravity, EOL vertices and one obstacle: a box of `size` (m) about `middle` as a table.
Scene make_table_scene(const ClothMesh& mesh, const Material& material, const Vec3& size, const Vec3& middle);

/// BDF2's error of position from rest under constant acceleration, over h^2 times the acceleration. All of
/// the error arises in the first step. That step is split into one third with implicit Euler and two thirds
/// with BDF2.
inline constexpr double kBdf2StartLag = 99.0 / 720.0;

/// Everything a run needs. The cloth is at rest unless `velocity` (m/s) is given.
struct ClothRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    FailuresSince failures;  ///< a run with failures makes no further steps

    ClothRun(Scene a_scene, ClothMesh mesh, const Vec3& velocity = Vec3::Zero());

    using Look = std::function<void(const StepReport&)>;

    /// Makes one step of `dt` (s). `look` is called after the step, or after each of its parts if it is
    /// halved. The test fails if the step does.
    StepReport advance(double dt, const Look& look = {});

    /// Makes equal steps of about `dt`; the last one ends `duration` from now.
    void advance(double duration, double dt, const Look& look = {});
};

/// Kinetic and potential energy of the run's present state.
ClothEnergy measure_energy(ClothRun& run);

/// Sum of kinetic and potential energy over a run, J.
struct EnergySpan {
    double first = 0.0, greatest = 0.0, last = 0.0;
};

/// Makes equal steps of at most `dt` (s) for `duration`, or until a test fails. `look` is called after each
/// step.
EnergySpan watch_energy(ClothRun& run, double duration, double dt,
                        const std::function<void(const StepReport&)>& look);

/// Brings the cloth to static equilibrium by implicit Euler steps that each start from rest. The steps grow
/// until they are Newton steps. The test fails if the cloth still moves after a bounded number of steps.
void settle(ClothRun& run);

}  // namespace arris
