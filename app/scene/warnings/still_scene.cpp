// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/still_scene.h"

#include <algorithm>

#include "physics/elements/cloth_elements.h"
#include "physics/forces/membrane.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kUnstrained = 1e-5;  // strain from rounding in a file in single precision
constexpr double kFlat = 1e-6;        // 1 - cosine of a hinge's angle: 0.08 degrees

bool is_nonzero(const Vec3& value)
{
    return value.squaredNorm() > 0.0;
}

bool acts_between(double begin, double end, const RigidMotion& motion)
{
    const bool is_in_time = motion.keyframes.empty()
                                ? motion.start < end
                                : motion.keyframes.front().time < end && motion.keyframes.back().time > begin;
    return motion.is_moving() && is_in_time;
}

bool deforms_between(double begin, double end, const Deformation& deformation)
{
    const std::vector<double>& times = deformation.sample_times();
    return times.size() > 1 && times.front() < end && times.back() > begin;
}

bool has_load(const RunConfig& config)
{
    const Scene& scene = config.scene;
    if (scene.gravity && is_nonzero(scene.gravity->acceleration)) return true;
    if (scene.wind && is_nonzero(scene.wind->velocity) && scene.wind->drag * scene.wind->air_density > 0.0)
        return true;
    return std::any_of(scene.pulls.begin(), scene.pulls.end(), [&](const Pull& pull) {
        return is_nonzero(pull.force) && pull.start < config.duration;
    });
}

bool has_moving_bodies(const RunConfig& config)
{
    const std::vector<Pin>& pins = config.scene.pins;
    const std::vector<MovingObstacle>& obstacles = config.scene.obstacles;
    return std::any_of(
               obstacles.begin(), obstacles.end(),
               [&](const MovingObstacle& body) {
                   return acts_between(0.0, config.duration, body.motion()) ||
                          (body.is_deforming() && deforms_between(0.0, config.duration, *body.deformation()));
               }) ||
           std::any_of(pins.begin(), pins.end(), [&](const Pin& pin) {
               return acts_between(pin.start, std::min(config.duration, pin.release), pin.motion);
           });
}

bool is_relaxed(const ClothMesh& cloth, const MeshTopology& topology)
{
    const ClothElements elements = list_elements(cloth, topology, HingeUse::None);
    const bool is_unstrained =
        std::all_of(elements.faces.begin(), elements.faces.end(), [&](const FaceElement& face) {
            const Vec2 stretches = principal_stretches(FaceState(face, cloth.world).F);
            return stretches[0] - 1.0 < kUnstrained && 1.0 - stretches[1] < kUnstrained;
        });
    const auto normal = [&](int f) {
        const auto& [a, b, c] = cloth.faces[static_cast<std::size_t>(f)];
        return Vec3((cloth.world[b] - cloth.world[a]).cross(cloth.world[c] - cloth.world[a]).normalized());
    };
    return is_unstrained &&
           std::all_of(topology.hinges.begin(), topology.hinges.end(), [&](const Hinge& hinge) {
               return 1.0 - normal(hinge.face_c).dot(normal(hinge.face_d)) < kFlat;
           });
}

}  // namespace

bool stays_still(const RunConfig& config, const MeshTopology& topology)
{
    if (has_load(config) || has_moving_bodies(config) ||
        std::any_of(config.cloth_velocity.begin(), config.cloth_velocity.end(), is_nonzero))
        return false;
    // Pins may move the cloth from its placement at time 0.
    const ClothMesh start = make_state(config.scene, config.cloth, config.cloth_velocity).mesh;
    return is_relaxed(start, topology);
}

}  // namespace arris
