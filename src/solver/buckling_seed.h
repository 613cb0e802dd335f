// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds for cloth that is compressed in a plane.
//
// Real cloth in compression folds at once. Simulated cloth that lies in a plane to the last bit, without any
// force across it, cannot: the plane is a solution of its equations, although an unstable one. A deviation of
// any size grows by itself, as the force at q^ has its true direction (docs/method.md, Buckling). So such
// cloth gets a deviation far below every tolerance.
#pragma once

#include <vector>

#include "solver/contact/contacts.h"
#include "solver/mesh_change/mesh_cache.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/time_integration.h"

namespace arris {

/// Adds a tiny velocity along the cloth's normal to `prediction.velocity` at each vertex where the cloth is
/// compressed and exactly plane: it is in one plane, its velocity keeps it there, and neither gravity nor a
/// contact acts across. Any other force across would have shown in its velocity. Only the state and the
/// vertex's id decide. `mesh` belongs to the state. Nothing changes elsewhere, to the bit.
void seed_buckling(const Scene& scene, const State& state, MeshCache& mesh,
                   const std::vector<Contact>& contacts, Prediction& prediction);

}  // namespace arris
