// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of cloth on obstacles that deform have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth_run.h"
#include "tests/formula_deformation.h"

namespace arris {

/// A scene with gravity and a cotton-like cloth of this thickness, m.
Scene make_deforming_scene(double thickness);

/// An obstacle whose points move by a formula, and stand at the origin. `samples`: times (s) at which edges
/// are tested for being sharp.
MovingObstacle make_deforming(ObstacleMesh mesh, FormulaDeformation::Formula place,
                              FormulaDeformation::Formula velocity, std::vector<double> samples = {0.0});

/// A motion from 0 to 1 in `duration` (s) that starts and ends at rest.
struct SmoothRamp {
    double duration;

    double at(double time) const
    {
        return std::pow(std::sin(0.5 * M_PI * std::clamp(time / duration, 0.0, 1.0)), 2);
    }
    double rate(double time) const
    {
        if (time < 0.0 || time > duration) return 0.0;
        return 0.5 * M_PI / duration * std::sin(M_PI * time / duration);
    }
};

/// Energy of a run and what has changed it, J, from the first look on.
struct EnergyBooks {
    double first = 0.0;       ///< energy at the beginning
    double driven = 0.0;      ///< work of obstacles and pins
    double lost = 0.0;        ///< to friction
    double by_meshing = 0.0;  ///< added by changes of the mesh
    double last = 0.0;        ///< energy at the end

    /// Rise of energy that none of these explains.
    double unexplained() const { return last - first - driven + lost - by_meshing; }
};

/// Books of infinitely short steps, from those of two runs of which `fine` has steps half as long. The work
/// of a step counts the force at its end for the mean: it is too large or too small by an amount of first
/// order.
EnergyBooks extrapolate(const EnergyBooks& coarse, const EnergyBooks& fine);

/// Makes equal steps of about `dt` (s) for `duration` (s), and keeps books. `look`: called after each part of
/// a step.
EnergyBooks keep_books(ClothRun& run, double duration, double dt, const ClothRun::Look& look = {});

}  // namespace arris
