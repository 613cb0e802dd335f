// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/obstacle/deformation.h"
#include "geometry/obstacle/obstacle.h"
#include "geometry/obstacle/surface_ride.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// An obstacle at one time: its shape in a frame, and that frame's placement in the world. The frame of one
/// that deforms is the world.
struct ObstaclePose {
    std::shared_ptr<const Obstacle> shape;
    Placement placement;
    std::shared_ptr<const std::vector<Vec3>> velocities = nullptr;  ///< m/s, of points that deform; else null

    operator const Obstacle&() const { return *shape; }
    const Obstacle* operator->() const { return shape.get(); }
};

/// An obstacle of a scene: the one place that knows how obstacles move. What indices of faces, edges and
/// features mean does not change in time.
class MovingObstacle {
  public:
    /// `mesh` must pass `validate`. At time 0 its frame's placement in the world is `motion.at(0) *
    /// placement`. Edges that turn by more than `feature_angle` (degrees) are sharp. `deformation` moves the
    /// mesh's points within the frame.
    MovingObstacle(std::string name, ObstacleMesh mesh, const Placement& placement, RigidMotion motion,
                   double feature_angle, std::shared_ptr<const Deformation> deformation = nullptr);

    const std::string& name() const { return name_; }

    /// Its faces, edges and features, whose indices hold at all times.
    const Obstacle& shape() const { return *shape_; }

    /// The same shape for ever where it is rigid; the last few poses are kept where it deforms.
    ObstaclePose at(double time) const;  ///< s

    /// The obstacle as it is at `time` (s), at rest for ever.
    MovingObstacle at_rest(double time) const;

    /// World velocity (m/s) just after `time` of the obstacle's material that is then at `place` (world), or
    /// of what rides there on one that deforms.
    Vec3 velocity_after(double time, const Vec3& place) const;

    /// How what rides on an obstacle that deforms, at a place of its surface, moves in the world.
    Placement way(double from, double to, const SurfacePlace& on) const;
    Vec3 velocity_after(double time, const Vec3& place, const SurfacePlace& on) const;

    /// World places of the mesh's points at `time`.
    std::vector<Vec3> points_at(double time) const;

    bool is_moving() const { return is_deforming() || motion_.is_moving(); }  ///< at any time
    bool is_deforming() const { return deformation_ != nullptr; }
    std::vector<double> jumps() const;                     ///< s: times at which its velocity jumps
    const RigidMotion& motion() const { return motion_; }  ///< for records and words about it
    /// Moves a rigid one by `motion` alone: its frame's placement in the world is `motion.at(time)`.
    void follow(RigidMotion motion)
    {
        placement_ = {};
        motion_ = std::move(motion);
    }
    /// How its mesh deforms in its frame; null for a rigid one.
    const std::shared_ptr<const Deformation>& deformation() const { return deformation_; }

  private:
    struct Posed;
    class Poses;
    std::shared_ptr<const Posed> posed_at(double time) const;
    std::vector<Vec3> deform(double time, std::vector<Vec3>& velocities) const;  ///< in the world

    std::string name_;
    std::shared_ptr<const Obstacle> shape_;
    Placement placement_;
    RigidMotion motion_;
    std::shared_ptr<const Deformation> deformation_;
    std::shared_ptr<Poses> poses_;  ///< of one that deforms; copies of the obstacle share them
};

}  // namespace arris
