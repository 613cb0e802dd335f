// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/cloth_stars.h"
#include "solver/mesh_change/changed_patches.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

struct TransferReport {
    /// Of patches that could not give way to what strains them now: the most that elastic energy is above
    /// what it was, as a share of what moves the patch.
    double strain = 0.0;
    /// Of each of those that stay strained by more than kPatchStrain, as far as they were looked at, its
    /// vertices before, ascending.
    std::vector<std::vector<VertexId>> strained;
};

/// Brings `after`, whose new vertices have what the surface had there, to where each patch may stay: one that
/// its new mesh strains gives way, and its velocity is the nearest to the old that has the same momentum.
/// `stars_before`, `stars` are those of `before`, `after`. Stops, unfinished, at a patch that stays strained
/// by more than `most_strain`, before any velocity is fitted.
TransferReport fit_patches(const Scene& scene, const State& before, const ClothStars& stars_before,
                           const std::vector<ChangedPatch>& patches, const ClothStars& stars,
                           double most_strain, State& after);

}  // namespace arris
