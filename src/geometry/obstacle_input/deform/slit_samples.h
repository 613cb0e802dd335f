// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/point_cache.h"

namespace arris {

/// What a slit changed, for words about it.
struct SlitSurvey {
    std::size_t samples = 0;      ///< that were changed
    double greatest_retreat = 0;  ///< m
    std::size_t greatest_at = 0;  ///< that sample
};

/// Makes a slit of `width` (m) between parts of the mesh in each sample (slit.h), and gives the samples one
/// after the other to `take`. So that the skin does not jump, a point retreats in each sample as far as it
/// must within two samples before and after it, in the mean over as many again. At most three samples and a
/// number for each point of nine are in memory.
SlitSurvey make_slit(const PoseSource& poses, const ObstacleMesh& mesh, double width,
                     const std::function<void(const std::vector<Vec3>&)>& take);

}  // namespace arris
