// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/cloth_stars.h"
#include "solver/mesh_change/changed_patches.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

struct TransferReport {
    /// Largest strain of a patch that could not give way: its rise in elastic energy, relative to its kinetic
    /// energy plus its weight over one cell.
    double strain = 0.0;
    /// Strain of the whole cloth: the sum of the patches' rises, relative to the cloth's kinetic energy plus
    /// its weight over its mean cell, or plus its elastic energy where that is greater.
    double cloth_strain = 0.0;
    /// Old vertices, ascending, of each tested patch whose strain stays above kPatchStrain.
    std::vector<std::vector<VertexId>> strained;
};

/// Adjusts the patches of `after`, whose new vertices have the interpolated state of the old surface. A patch
/// strained by its new mesh gives way. Its velocity is the nearest to the old one with the same momentum.
/// `stars_before` and `stars` belong to `before` and `after`. Stops at a patch that stays strained by more
/// than `most_strain`, before any velocity is fitted; `after` is then unfinished.
TransferReport fit_patches(const Scene& scene, const State& before, const ClothStars& stars_before,
                           const std::vector<ChangedPatch>& patches, const ClothStars& stars,
                           double most_strain, State& after);

}  // namespace arris
