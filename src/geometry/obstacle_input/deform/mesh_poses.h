// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"
#include "geometry/obstacle_input/repair/vertex_origins.h"

namespace arris {

/// From a file's coordinates to the obstacle's frame: p -> scale (turn (metres_per_unit p)), where `turn`
/// turns the upward axis to +z (turn_to_z).
struct FileFrame {
    double metres_per_unit = 1.0;
    char up = 'z';
    double scale = 1.0;
};

/// Measurements of all poses, for words about them.
struct PoseSurvey {
    int most_collapsed = 0;              ///< most faces without area in one pose
    std::size_t collapsed_at = 0;        ///< that sample
    double greatest_move = 0.0;          ///< m, of a point from one sample to the next
    std::size_t moved_at = 0;            ///< the later of the two samples
    int moved_vertex = 0;                ///< vertex of the file, from 0
    double greatest_speed = 0.0;         ///< moves over the cache's own times, m/s
    double greatest_acceleration = 0.0;  ///< likewise, m/s^2, from three samples
    std::size_t accelerated_at = 0;      ///< the middle one
};

/// Makes poses of an obstacle's mesh from the places of its file's vertices, sample by sample, and checks
/// them.
class MeshPoses {
  public:
    /// `mesh` in the obstacle's frame, with one origin a point. Throws InputError where a point has none. All
    /// arguments but `frame` must outlive the object.
    MeshPoses(VertexCache& cache, const ObstacleMesh& mesh, const VertexOrigins& origins,
              const FileFrame& frame);

    /// Writes the points of the next sample, which `survey` then covers. Throws InputError, one line with
    /// file and sample:
    ///  - for a point that is not finite or beyond 1e6 m, and where vertices joined in the mesh part;
    ///  - at the first sample, where edges differ from the mesh's by a factor above 3 in the median, or a
    ///    closed mesh is turned inside out: the order of the vertices, the unit or the axes are other ones.
    void read_next(std::vector<Vec3>& points);

    const PoseSurvey& survey() const { return survey_; }

  private:
    Vec3 place(int vertex) const;
    void require_joined() const;
    void require_similar(const std::vector<Vec3>& points) const;
    void require_same_hand(const std::vector<Vec3>& points) const;
    void measure(const std::vector<Vec3>& points);
    [[noreturn]] void refuse(const std::string& why) const;

    VertexCache& cache_;
    const ObstacleMesh& mesh_;
    const VertexOrigins& origins_;
    FileFrame frame_;
    Mat3 turn_;
    std::size_t next_ = 0;
    std::vector<Vec3> vertices_;            // of the file, in its coordinates
    std::vector<Vec3> last_, second_last_;  // points of the two samples before
    PoseSurvey survey_;
};

}  // namespace arris
