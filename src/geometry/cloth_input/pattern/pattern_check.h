// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/cloth_input/cloth_outline.h"
#include "geometry/cloth_input/pattern/edge_curve.h"

namespace arris {

/// Most edges of a pattern, of all panels together: as many as find_border_defect can check in one panel if
/// all are curved. A garment has some hundreds.
inline constexpr int kMostPatternEdges = kMostOutlineCorners / kOutlineParts;

/// Extent of a panel, m, along u or v, whichever is greater: as for other cloth.
inline constexpr double kSmallestPanel = 1e-6, kLargestPanel = 1e4;

/// Most that one side of a seam is longer than the other.
inline constexpr double kMostEase = 4.0;

/// Checks all that is known without an edge length. Throws InputError, whose one line names the panel and the
/// edge, or the seam, and what is allowed: panels without a name or with another one's, fewer than three
/// corners, values that are not finite, edges of no length, loops that cross or touch themselves, sizes,
/// edges sewn twice or to themselves, ties with other seams on both sides, seams with sides of too different
/// lengths, seams from a right to a wrong side that are no ties.
void check_pattern(const SewingPattern& pattern);

/// The part of check_pattern that concerns which edges seams are on: to be known before seams become ties.
void check_seam_edges(const SewingPattern& pattern);

/// 'panel "front"', for messages.
std::string panel_in_words(const Panel& panel);

/// 'panel "front", edge 2', for messages. Edges count from 0.
std::string edge_in_words(const Panel& panel, int edge);

/// 'seam 3 (panel "front", edge 2 with panel "back", edges 0 to 1)', for messages. Seams count from 0; their
/// panels must exist.
std::string seam_in_words(const SewingPattern& pattern, int seam);

/// Length, m, of a side of a seam. `curves`: of all edges of its panel.
double length_of(const SeamSide& side, const std::vector<EdgeCurve>& curves);

}  // namespace arris
