// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Cuts the polygons of an importer into triangles, and counts those that cross themselves.
class FaceCutter {
  public:
    /// Triangles of a face's corners (at least three). `first_point` is the index of its first corner among
    /// the importer's points. A polygon with a defect is cut from its first corner to all others. The surface
    /// then stays closed where a polygon crosses itself, or closes a slit between other faces; the repair
    /// removes triangles without area.
    std::vector<Face> cut(const std::vector<Vec3>& corners, int first_point);

    int crossing_count() const { return crossing_; }

    /// The warning that says how many polygons cross themselves, and where the first is. `points` in metres,
    /// z up.
    std::string tell_crossing(const std::vector<Vec3>& points) const;

  private:
    int crossing_ = 0;
    int crossing_point_ = 0;
};

}  // namespace arris
