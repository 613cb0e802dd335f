// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/cloth_input/pattern/sewing_pattern.h"

namespace arris {

/// The order in which a panel turns about the fixed axes by its three angles.
enum class RotationOrder {
    XThenYThenZ,  ///< as GarmentCode's simulation reads its files
    ZThenYThenX,  ///< as GarmentCode's programs of garments write them
};

struct GarmentCodeOptions {
    char up = 'y';  ///< the file's upward axis, which is turned to +z: 'x', 'y' or 'z'
    RotationOrder order = RotationOrder::XThenYThenZ;
};

struct GarmentCodePattern {
    SewingPattern pattern;           ///< panels by name, ascending; seams as the file's stitches
    std::vector<std::string> notes;  ///< without the file's name: what may surprise
};

/// Reads a pattern in GarmentCode's format (Korosteleva and Sorkine-Hornung 2023; *_specification.json), as
/// far as panels, curvatures of the kinds quadratic, cubic and circle, stitches and labels go. Lengths become
/// metres by units_in_meter. A panel's right side is that from which its loop runs counter-clockwise. A
/// stitch joins the end of one edge to the other's beginning, or both beginnings where it is "right_wrong";
/// panels are then turned over until right sides join right sides, and what remains is a tie
/// (agree_on_sides).
///
/// Throws InputError, one line with the file, the place in it, the value, and what is allowed; the pattern
/// has passed check_pattern. Time and memory are bounded (json_place.h, kMostPatternEdges).
GarmentCodePattern read_garment_code(const std::string& path, const GarmentCodeOptions& options = {});

/// As read_garment_code, from a text; `file` names it in messages.
GarmentCodePattern parse_garment_code(const std::string& file, const std::string& text,
                                      const GarmentCodeOptions& options = {});

}  // namespace arris
