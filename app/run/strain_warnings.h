// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/parts/run_config.h"
#include "solver/cloth_strain.h"
#include "solver/model/state.h"

namespace arris {

/// The greatest strain of a run so far, and where it was.
struct StrainPeak {
    double strain = 0.0;           ///< stretch - 1
    double time = 0.0;             ///< s
    Vec3 world = Vec3::Zero();     ///< m, of the vertex
    Vec2 material = Vec2::Zero();  ///< m, of the vertex
};

/// The peaks of a run. A resumed run continues with those of its checkpoint.
struct StrainPeaks {
    StrainPeak stretch, compression;
    StrainPeak in_plane;          ///< compression where the cloth stays plane
    std::int64_t plane_rows = 0;  ///< rows up to now in which plane cloth was compressed by more than 5 %
    StrainPeak last_stretch, last_compression;  ///< of the last row
};

/// Takes over the strains of a row that exceed the peaks so far. A stretch or compression counts as far as
/// the row before has it, too: where mesh changes strain a patch for a step, that says nothing about the
/// scene. Plane cloth counts only after some rows: it takes cloth some steps to fold.
void note_strain(const State& state, const ClothStrain& strain, StrainPeaks& peaks);

/// A line for each peak that cloth does not bear: stretch or compression above 20 %, and compression above 5
/// % where the cloth stays plane. Each says what of the scene causes the strain, where that can be measured.
/// Peaks with one cause share a line.
std::vector<std::string> warn_of_strain(const StrainPeaks& peaks, const RunConfig& config);

}  // namespace arris
