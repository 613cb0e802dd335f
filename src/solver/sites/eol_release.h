// SPDX-License-Identifier: GPL-3.0-or-later
// When a vertex ceases to be EOL. While material flows over a fold it has two velocities there, one a side;
// an ordinary vertex has their mean, and the cloth loses energy. And where a fold has been let go, the cloth
// bends beside the feature, so that to put a vertex there again strains it. So an EOL vertex that no longer
// presses is not let go for that alone: cloth that lifts off an edge keeps its fold, through which it flows,
// until it is flat there or a cell from the edge. But a fold off its feature is led in a plane that nothing
// is in: where what comes to it fast comes another way it is let go before.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surgery/patch_quality.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Steps without pressing, before which no vertex is let go: contact that chatters is still contact.
inline constexpr int kIdleSteps = 3;

/// Cosine of 3 degrees: cloth whose normals are within that is flat. At a vertex w is lost to less than 5e-4
/// of what moves there.
inline constexpr double kFlat = 0.9986;

/// Target lengths from its feature, beyond which a fold is let go that is led otherwise than what flows over
/// it.
inline constexpr double kAstrayCells = 0.3;

/// Whether an EOL vertex stays.
enum class EolRetention {
    None,   ///< it goes
    Loose,  ///< it goes, unless it lies on its feature between two that stay
    Firm
};

/// Of EOL vertex `entry`, at `place` in its obstacle's frame. Firm where it presses; none more than a cell
/// from its feature, or kAstrayCells where it is led astray, nor off a corner that presses on a face now;
/// firm where the cloth is folded, by more than 6 degrees.
EolRetention decide_retention(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                              const EolCoordinates& at, const Vec3& place);

/// Makes loose ones firm that lie along a trace between firm ones: a trace with a hole holds the cloth there.
/// One hold an entry of `state.eol`.
void retain_between(const Scene& scene, const State& state, const ClothStars& stars,
                    std::vector<EolRetention>& retained);

/// Whether an EOL vertex has come so near to the cloth's border that it must go.
bool is_at_border(const Scene& scene, const State& state, const ClothStars& stars, const EolVertex& eol);

/// Those that go, in the order of `state.eol`: what has no hold, has come to the end of its feature or to the
/// cloth's border, or has no coordinates any more.
std::vector<std::uint32_t> find_releases(const Scene& scene, const State& state, const ClothStars& stars);

}  // namespace arris
