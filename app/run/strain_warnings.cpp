// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/strain_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/run/strain_causes.h"
#include "app/scene/parts/cloth_pieces.h"

namespace arris {
namespace {

// Woven cloth tears at a stretch of 10 to 20 %, and folds long before it is compressed as much.
constexpr double kGreatestStrain = 0.2;

// Cloth that has room to fold is compressed by less than 1 %.
constexpr double kGreatestInPlane = 0.05;

// Rows for which plane cloth must be compressed that much. Where a pin starts with a jerk, cloth of the
// preset "cotton" folds within 10.
constexpr std::int64_t kRowsToFold = 20;

StrainPeak find_peak(const State& state, const VertexStrain& found)
{
    if (found.vertex < 0) return {};
    const std::size_t v = static_cast<std::size_t>(found.vertex);
    return {found.strain, state.time, state.mesh.world[v], state.mesh.material[v]};
}

bool is_greater(const StrainPeak& a, const StrainPeak& b)
{
    return std::abs(a.strain) > std::abs(b.strain);
}

void note(const StrainPeak& found, StrainPeak& peak)
{
    if (is_greater(found, peak)) peak = found;
}

/// Notes a row's peak as far as the row before has it, too.
void note_lasting(const StrainPeak& found, StrainPeak& last, StrainPeak& peak)
{
    note(is_greater(found, last) ? last : found, peak);
    last = found;
}

std::string describe(const Scene& scene, const StrainPeak& peak)
{
    return fmt::format("by {:.3g} % at t = {:.6g} s, at [{:.4g}, {:.4g}, {:.4g}] (m, material {})",
                       100.0 * std::abs(peak.strain), peak.time, peak.world.x(), peak.world.y(),
                       peak.world.z(), material_in_words(scene, peak.material, 4));
}

/// A peak that cloth does not bear.
struct Finding {
    std::string what, limit, cause;
};

/// A line for each cause.
std::vector<std::string> join_by_cause(const std::vector<Finding>& found)
{
    std::vector<std::string> lines, causes;
    for (const Finding& one : found) {
        if (std::find(causes.begin(), causes.end(), one.cause) != causes.end()) continue;
        causes.push_back(one.cause);
        std::vector<std::string> peaks, limits;
        for (const Finding& other : found)
            if (other.cause == one.cause) {
                peaks.push_back(other.what);
                limits.push_back(other.limit);
            }
        lines.push_back(fmt::format("the cloth was {}: {}; {}", fmt::join(peaks, ", and "),
                                    fmt::join(limits, ", "), one.cause));
    }
    return lines;
}

}  // namespace

void note_strain(const State& state, const ClothStrain& strain, StrainPeaks& peaks)
{
    note_lasting(find_peak(state, strain.stretch), peaks.last_stretch, peaks.stretch);
    note_lasting(find_peak(state, strain.compression), peaks.last_compression, peaks.compression);
    peaks.plane_rows = strain.in_plane.strain < -kGreatestInPlane ? peaks.plane_rows + 1 : 0;
    if (peaks.plane_rows >= kRowsToFold) note(find_peak(state, strain.in_plane), peaks.in_plane);
}

std::vector<std::string> warn_of_strain(const StrainPeaks& peaks, const RunConfig& config)
{
    const bool stays_plane = -peaks.in_plane.strain > kGreatestInPlane;
    std::vector<Finding> found;
    if (peaks.stretch.strain > kGreatestStrain)
        found.push_back({"stretched " + describe(config.scene, peaks.stretch),
                         fmt::format("woven cloth tears before {:g} %", 100.0 * kGreatestStrain),
                         explain_stretch(config, peaks.stretch)});
    if (-peaks.compression.strain > kGreatestStrain &&
        (!stays_plane || is_greater(peaks.compression, peaks.in_plane)))
        found.push_back({"compressed " + describe(config.scene, peaks.compression),
                         fmt::format("real cloth folds before {:g} %", 100.0 * kGreatestStrain),
                         explain_compression(config, peaks.compression)});
    if (stays_plane)
        found.push_back({"compressed " + describe(config.scene, peaks.in_plane) + " and stayed plane",
                         fmt::format("real cloth folds before {:g} %", 100.0 * kGreatestInPlane),
                         explain_compression(config, peaks.in_plane)});
    return join_by_cause(found);
}

}  // namespace arris
