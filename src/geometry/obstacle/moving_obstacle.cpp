// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/moving_obstacle.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <utility>

namespace arris {

/// One that deforms at one time, in the world.
struct MovingObstacle::Posed {
    double time;
    Obstacle shape;
    std::vector<Vec3> velocities;  ///< of the points, m/s
};

/// The poses asked for last: of the start of the last step, both ends of this one, time 0 from which pins
/// ride, and of a part.
class MovingObstacle::Poses {
  public:
    template <class Make>
    std::shared_ptr<const Posed> find(double time, const Make& make)
    {
        const std::scoped_lock lock(mutex_);
        const auto known = std::find_if(latest_.begin(), latest_.end(),
                                        [&](const auto& posed) { return posed->time == time; });
        if (known != latest_.end()) {
            std::rotate(latest_.begin(), known, std::next(known));
            return latest_.front();
        }
        latest_.insert(latest_.begin(), make());
        if (latest_.size() > kMost) latest_.pop_back();
        return latest_.front();
    }

  private:
    static constexpr std::size_t kMost = 6;
    std::mutex mutex_;
    std::vector<std::shared_ptr<const Posed>> latest_;  ///< the latest asked for first
};

namespace {

/// A visitor of a deformation's samples, in the obstacle's frame.
VisitPoses visit_samples(const ObstacleMesh& mesh, const Deformation& deformation)
{
    return [&](const PoseVisitor& use) {
        ObstacleMesh pose = mesh;
        ObstacleTopology topology = make_topology(mesh);
        std::vector<Vec3> velocities;
        for (const double time : deformation.sample_times()) {
            deformation.find(time, pose.points, velocities);
            update_normals(pose, topology);
            use(pose, topology);
        }
    };
}

std::shared_ptr<const Obstacle> make_shape(ObstacleMesh mesh, double feature_angle,
                                           const Deformation* deformation)
{
    if (!deformation) return std::make_shared<Obstacle>(std::move(mesh), feature_angle);
    const ObstacleMesh own = mesh;
    return std::make_shared<Obstacle>(std::move(mesh), feature_angle, visit_samples(own, *deformation));
}

}  // namespace

MovingObstacle::MovingObstacle(std::string name, ObstacleMesh mesh, const Placement& placement,
                               RigidMotion motion, double feature_angle,
                               std::shared_ptr<const Deformation> deformation)
    : name_(std::move(name)),
      shape_(make_shape(std::move(mesh), feature_angle, deformation.get())),
      placement_(placement),
      motion_(std::move(motion)),
      deformation_(std::move(deformation)),
      poses_(deformation_ ? std::make_shared<Poses>() : nullptr)
{
}

std::vector<Vec3> MovingObstacle::deform(double time, std::vector<Vec3>& velocities) const
{
    std::vector<Vec3> points;
    deformation_->find(time, points, velocities);
    const Placement frame = motion_.at(time) * placement_;
    for (std::size_t p = 0; p < points.size(); ++p) {
        points[p] = frame(points[p]);
        velocities[p] = frame.rotation * velocities[p] + motion_.velocity_after(time, points[p]);
    }
    return points;
}

std::shared_ptr<const MovingObstacle::Posed> MovingObstacle::posed_at(double time) const
{
    return poses_->find(time, [&] {
        std::vector<Vec3> velocities;
        std::vector<Vec3> points = deform(time, velocities);
        return std::make_shared<const Posed>(
            Posed{time, Obstacle(*shape_, std::move(points)), std::move(velocities)});
    });
}

ObstaclePose MovingObstacle::at(double time) const
{
    if (!deformation_) return {shape_, motion_.at(time) * placement_};
    const std::shared_ptr<const Posed> posed = posed_at(time);
    return {{posed, &posed->shape}, Placement(), {posed, &posed->velocities}};
}

MovingObstacle MovingObstacle::at_rest(double time) const
{
    const ObstaclePose pose = at(time);
    MovingObstacle still = *this;
    still.shape_ = pose.shape;
    still.placement_ = pose.placement;
    still.motion_ = {};
    still.deformation_ = nullptr;
    still.poses_ = nullptr;
    return still;
}

Vec3 MovingObstacle::velocity_after(double time, const Vec3& place) const
{
    if (!deformation_) return motion_.velocity_after(time, place);
    const std::shared_ptr<const Posed> posed = posed_at(time);
    const auto on = find_nearest(posed->shape, place);
    return on ? riding_velocity(posed->shape, posed->velocities, *on, place) : Vec3(Vec3::Zero());
}

Placement MovingObstacle::way(double from, double to, const SurfacePlace& on) const
{
    return find_way(posed_at(from)->shape, posed_at(to)->shape, on);
}

Vec3 MovingObstacle::velocity_after(double time, const Vec3& place, const SurfacePlace& on) const
{
    const std::shared_ptr<const Posed> posed = posed_at(time);
    return riding_velocity(posed->shape, posed->velocities, on, place);
}

std::vector<Vec3> MovingObstacle::points_at(double time) const
{
    std::vector<Vec3> points, velocities;
    if (deformation_) return deform(time, velocities);
    const Placement frame = at(time).placement;
    for (const Vec3& point : shape_->mesh().points) points.push_back(frame(point));
    return points;
}

std::vector<double> MovingObstacle::jumps() const
{
    std::vector<double> times = motion_.jumps();
    if (!deformation_) return times;
    const std::vector<double> own = deformation_->jumps();
    std::vector<double> all;
    std::set_union(times.begin(), times.end(), own.begin(), own.end(), std::back_inserter(all));
    return all;
}

}  // namespace arris
