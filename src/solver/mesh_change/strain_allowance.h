// SPDX-License-Identifier: GPL-3.0-or-later
// Limits on the strain that mesh changes may cause in a step. Strain is the elastic energy added to a patch
// of cloth, relative to the patch's kinetic energy plus its weight over one cell. The limits act one
// after another. MeshChangeGuard refuses a single operation above 1 % (kAllowedStrain; mesh_change_guard.cpp
// adds small terms, and a factor while clearing). Allowed operations may add up, so step_mesh.cpp measures
// each patch of a finished mesh after relaxation. A mesh is good up to 3 % (kPatchStrain); above, it is made
// again with more care. Up to 6 % (kTraceStrain) is accepted where less strain would lose or block EOL
// vertices. The best mesh is used up to 50 % (kMostStrain), and up to 1 % of the whole cloth
// (kMostClothStrain); above, the step keeps the mesh it has.
#pragma once

#include "solver/model/scene.h"

namespace arris {

/// Rings of faces around a mesh change that belong to its patch: they may give way. Raising it costs time,
/// and lets more strain go.
inline constexpr int kPatchRings = 2;

/// Limit for a single operation (MeshChangeGuard): the strain of one operation stays invisible. Likewise the
/// same share of the elastic energy that the patch has already.
inline constexpr double kAllowedStrain = 0.01;

/// Limit for all operations of a step on one patch. A smaller one would cost sliding traces their vertices,
/// and more energy with them.
inline constexpr double kPatchStrain = 0.03;

/// Limit for a patch where a smaller strain would cost a trace vertices. Lost vertices return a step later,
/// at a higher cost.
inline constexpr double kTraceStrain = 0.06;

/// Limit above which the step keeps the mesh it has, step after step, as long as attempts succeed. With a
/// smaller one, cloth on thin blades, whose mesh changes all the time, would be held by its old mesh.
inline constexpr double kMostStrain = 0.5;

/// Limit, likewise, for the strain of the whole cloth: what all patches gain, relative to the cloth's kinetic
/// energy plus its weight over its mean cell, or plus its elastic energy where that is greater. On coarse
/// meshes a patch is most of the cloth, and a few changes at kMostStrain would be seen as a rise of its
/// energy. With 2 %, cloth of 3 x 2 cells on a ring of wire gains 8 % of its kinetic energy; with 1 %, 3 %;
/// with less, hard cases would keep more of their meshes. Remeshing changes many patches at once, seldom
/// again, and has limits for each patch: this one would stop it.
inline constexpr double kMostClothStrain = 0.01;

/// Mass and stiffness of a part of the cloth, of one or several materials.
struct Heft {
    double mass = 0.0;       ///< kg
    double stiffness = 0.0;  ///< N: Young's modulus times area

    void add(const Material& material, double area)
    {
        mass += material.density * area;
        stiffness += material.youngs_modulus * area;
    }
};

/// Elastic energy, J, that is invisible on this cloth: that of a strain of 1e-6. Unstrained cloth at rest has
/// only round-off.
inline double unseen_energy(const Heft& heft)
{
    constexpr double kStrain = 1e-6;
    return heft.stiffness * kStrain * kStrain;
}

/// Work of gravity, J, on this cloth where it falls by `length` (m).
inline double weight_over(const Scene& scene, const Heft& heft, double length)
{
    return scene.gravity ? heft.mass * scene.gravity->acceleration.norm() * length : 0.0;
}

}  // namespace arris
