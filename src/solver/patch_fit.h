// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/changed_patches.h"
#include "solver/eol_coordinates.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

struct TransferReport {
    double energy_gain = 0.0;  ///< kinetic, J
    int patches = 0;           ///< on which velocity was fitted
    bool is_strained = false;  ///< a patch could not give way to what strains it now
};

/// What follows on a patch that could not give way: to stop leaves the patches after it as they are.
enum class OnStrain { GoOn, Stop };

/// Brings `after`, whose new vertices have what the surface had there, to where each patch may stay: one that
/// its new mesh strains gives way, and its velocity is the nearest to the old that has the same momentum.
/// `stars` are those of `after`.
TransferReport fit_patches(const Scene& scene, const State& before, const std::vector<ChangedPatch>& patches,
                           const ClothStars& stars, OnStrain on_strain, State& after);

}  // namespace arris
