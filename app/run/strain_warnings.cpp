// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/strain_warnings.h"

#include <fmt/format.h>

#include <cmath>

namespace arris {
namespace {

// Woven cloth tears at a stretch of 10 to 20 %, and folds long before it is compressed as much.
constexpr double kGreatestStrain = 0.2;

// Cloth that has room to fold is compressed by less than 1 %.
constexpr double kGreatestInPlane = 0.05;

// Rows for which plane cloth must be compressed that much. Where a pin starts with a jerk, cloth of the
// preset "cotton" folds within 10.
constexpr std::int64_t kRowsToFold = 20;

void note(const State& state, const FaceStrain& found, StrainPeak& peak)
{
    if (found.face < 0 || !(std::abs(found.strain) > std::abs(peak.strain))) return;
    peak = {found.strain, state.time};
    for (const int v : state.mesh.faces[static_cast<std::size_t>(found.face)]) {
        peak.world += state.mesh.world[static_cast<std::size_t>(v)] / 3.0;
        peak.material += state.mesh.material[static_cast<std::size_t>(v)] / 3.0;
    }
}

std::string describe(const StrainPeak& peak)
{
    return fmt::format(
        "by {:.3g} % at t = {:.6g} s, at [{:.4g}, {:.4g}, {:.4g}] (m, material [{:.4g}, {:.4g}])",
        100.0 * std::abs(peak.strain), peak.time, peak.world.x(), peak.world.y(), peak.world.z(),
        peak.material.x(), peak.material.y());
}

}  // namespace

void note_strain(const State& state, const ClothStrain& strain, StrainPeaks& peaks)
{
    note(state, strain.stretch, peaks.stretch);
    note(state, strain.compression, peaks.compression);
    peaks.plane_rows = strain.in_plane.strain < -kGreatestInPlane ? peaks.plane_rows + 1 : 0;
    if (peaks.plane_rows >= kRowsToFold) note(state, strain.in_plane, peaks.in_plane);
}

std::vector<std::string> warn_of_strain(const StrainPeaks& peaks)
{
    std::vector<std::string> lines;
    if (peaks.stretch.strain > kGreatestStrain)
        lines.push_back(
            fmt::format("the cloth was stretched {}: woven cloth tears before {:g} %; pull less, use smaller "
                        "cells, or raise "
                        "cloth.material.youngs_modulus",
                        describe(peaks.stretch), 100.0 * kGreatestStrain));
    if (-peaks.compression.strain > kGreatestStrain)
        lines.push_back(
            fmt::format("the cloth was compressed {}: real cloth folds before {:g} %; use smaller "
                        "cells, so that the mesh can fold there",
                        describe(peaks.compression), 100.0 * kGreatestStrain));
    if (-peaks.in_plane.strain > kGreatestInPlane)
        lines.push_back(
            fmt::format("the cloth was compressed {} and stayed plane: real cloth folds before "
                        "{:g} %; leave it room to fold, or use smaller cells",
                        describe(peaks.in_plane), 100.0 * kGreatestInPlane));
    return lines;
}

}  // namespace arris
