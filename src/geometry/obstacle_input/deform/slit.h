// SPDX-License-Identifier: GPL-3.0-or-later
// Room for cloth between parts of a body that come together or cross, such as an arm and the trunk: the skin
// of both retreats below the surface that the pose asks for.
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle.h"
#include "geometry/vectors.h"

namespace arris {

/// Pairs of faces of one pose that cross or touch.
std::vector<std::array<int, 2>> find_crossing_faces(const ObstacleMesh& mesh,
                                                    const std::vector<Vec3>& points);

/// Finds how far the skin of a body must retreat in a pose. Parts belong together where they are no farther
/// apart than three slits along the mesh in its own pose. Immutable; queries may run in parallel.
class SlitFinder {
  public:
    /// `mesh` must pass `validate`. `width` of the slit, m, above 0.
    SlitFinder(const ObstacleMesh& mesh, double width);

    /// For each point, the way (m, >= 0) against its normal in this pose after which other parts are `width`
    /// apart from there, as far as ten rounds of retreat by half of what is missing reach, and at most by
    /// a width and half of what is missing anywhere at first. Fades over three
    /// rings of neighbours. Parts that are inside each other are recognised where they are closed.
    std::vector<double> find_retreat(const std::vector<Vec3>& points) const;

    /// The points after that way.
    std::vector<Vec3> apply(const std::vector<Vec3>& points, const std::vector<double>& retreat) const;

  private:
    std::vector<Vec3> find_normals(const std::vector<Vec3>& points) const;
    std::vector<double> spread(const std::vector<double>& values) const;
    /// Whether a face of the pose with these points belongs to the same part as a point.
    /// Whether a face of the pose with these points belongs to the same part as a point.
    bool is_one_part(const std::vector<Vec3>& points, int point, const Face& face) const;
    std::vector<char> find_inside(const Obstacle& pose, const std::vector<Vec3>& normals,
                                  const std::vector<std::array<int, 2>>& crossing) const;
    double find_missing(const Obstacle& pose, const Vec3& normal, int point, bool is_inside) const;
    std::vector<double> find_missing(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                     const std::vector<int>& candidates) const;

    Obstacle shape_;
    double width_;
    std::vector<std::vector<int>> around_;      ///< neighbours of each point, over edges of faces
    std::vector<std::vector<int>> neighbours_;  ///< and across faces near in the mesh's own pose
    std::vector<char> is_buried_;               ///< points inside another part in the mesh's own pose
};

}  // namespace arris
