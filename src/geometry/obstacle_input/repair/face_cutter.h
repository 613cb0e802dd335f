// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Cuts the polygons of a file into triangles, and notes those that cross themselves or are not flat.
class FaceCutter {
  public:
    /// Triangles of a face's corners (at least three). `first_point` is the index of its first corner among
    /// the file's points. A polygon with a defect is cut from one corner to all others (fan_polygon). The
    /// surface then stays closed where a polygon crosses itself, or closes a slit between other faces; the
    /// repair removes triangles without area. The file enlarges the polygon by `scale` when it places it.
    std::vector<Face> cut(const std::vector<Vec3>& corners, int first_point, double scale = 1.0);

    /// Warnings that say how many polygons cross themselves, and how many are not flat, and where the first
    /// of them is. `points` in metres, z up; `unit` in metres.
    std::vector<std::string> warnings(const std::vector<Vec3>& points, double unit) const;

  private:
    int crossing_ = 0;
    int crossing_point_ = 0;
    int bent_ = 0;
    int bent_point_ = 0;          // of the most bent polygon, for its size
    double bent_distance_ = 0.0;  // of its corner from its plane, in the file's unit
    double bent_share_ = 0.0;     // that distance, relative to the polygon's size
};

}  // namespace arris
