// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"

namespace arris {

/// By what share of what moves a patch of cloth (its kinetic energy, and its weight over a cell) an operation
/// on its mesh may raise its elastic energy: nobody sees that.
inline constexpr double kAllowedStrain = 0.01;

/// The same of all operations of a step on a patch, each within what it may. Less would cost a sliding trace
/// its vertices, and more energy with them.
inline constexpr double kPatchStrain = 0.03;

/// The same, where less would cost a trace vertices: those come back a step later, at more cost.
inline constexpr double kTraceStrain = 0.06;

/// The same, beyond which the mesh rather stays as it is, step after step, as long as these can be made. With
/// less cloth on thin blades, whose mesh changes all the time, comes to be held by the mesh it has.
inline constexpr double kMostStrain = 0.5;

/// What gravity gives cloth of `area` (material, m^2) that falls by `length` (m), J.
inline double weight_over(const Scene& scene, double area, double length)
{
    return scene.gravity ? scene.material.density * area * scene.gravity->acceleration.norm() * length : 0.0;
}

}  // namespace arris
