// SPDX-License-Identifier: GPL-3.0-or-later
#include "sliding_strip.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/surgery/initial_target.h"

namespace arris {

namespace {

constexpr double kG = 9.81;
constexpr double kDensity = 0.1;        // kg/m^2
constexpr double kThickness = 1e-3;     // m
constexpr double kFeatureAngle = 10.0;  // degrees: a dihedral angle above this makes an edge sharp
constexpr double kReach = 3.0;          // m, length of the slopes, so that the strip stays on them
constexpr double kDegrees = std::numbers::pi / 180.0;

Vec3 downhill(double angle)
{
    return {std::cos(angle), 0.0, -std::sin(angle)};
}

Vec3 normal_of(double angle)
{
    return {std::sin(angle), 0.0, std::cos(angle)};
}

/// A prism; its upper edge is the y axis.
ObstacleMesh make_prism(const Slopes& slopes)
{
    ObstacleMesh mesh;
    const Vec3 back = -kReach * downhill(slopes.before), front = kReach * downhill(slopes.after);
    for (const double y : {-1.0, 1.0})
        for (const Vec3& corner : {Vec3(0.0, 0.0, 0.0), back, front})
            mesh.points.push_back(corner + y * Vec3::UnitY());
    mesh.faces = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4}, {0, 5, 3}, {0, 2, 5}, {1, 5, 2}, {1, 4, 5}};
    return mesh;
}

/// Bends the strip over the edge, at its stand-off from both slopes.
Vec3 find_bend(const Slopes& slopes)
{
    const Vec3 n1 = normal_of(slopes.before), n2 = normal_of(slopes.after);
    return kThickness / (1.0 + n1.dot(n2)) * (n1 + n2);
}

ClothMesh make_bent_strip(const StripCase& strip)
{
    ClothGrid grid;
    grid.size = Vec2(strip.length, strip.width);
    grid.resolution = strip.cells;
    grid.pattern = strip.pattern;
    grid.pattern_angle = strip.pattern_angle;
    const double fold = strip.length - strip.start;
    grid.folds = {
        {{Vec2(fold, 0.0), Vec2(fold, strip.width)}, (strip.slopes.after - strip.slopes.before) / kDegrees}};
    ClothMesh mesh = make_cloth_grid(grid);
    fold_cloth(grid.folds, mesh);
    const Mat3 lean = rotation_about(Vec3::UnitY(), strip.slopes.before / kDegrees);
    for (Vec3& x : mesh.world)
        x = strip.place(find_bend(strip.slopes) + lean * (x - Vec3(fold, 0.5 * strip.width, 0.0)));
    return strip.seam ? part_and_sew(std::move(mesh), *strip.seam) : mesh;
}

Vec3 to_edge_frame(const StripCase& strip, double time, const Vec3& world)
{
    return strip.place.inverse(world - time * strip.carried);
}

}  // namespace

SlidingChain::SlidingChain(const Slopes& slopes, double length, double start)
    : slopes_(slopes), length_(length), start_(start)
{
    const double difference = std::sin(slopes.after) - std::sin(slopes.before);
    balance_ = -length * std::sin(slopes.before) / difference;
    rate_ = std::sqrt(kG * difference / length);
}

double SlidingChain::length_after(double time) const
{
    return balance_ + (start_ - balance_) * std::cosh(rate_ * time);
}

double SlidingChain::speed(double time) const
{
    return (start_ - balance_) * rate_ * std::sinh(rate_ * time);
}

double SlidingChain::acceleration(double time) const
{
    return rate_ * rate_ * (length_after(time) - balance_);
}

double SlidingChain::tension_excess(double time) const
{
    const double x = length_after(time);
    const double tension = (length_ - x) * (acceleration(time) - kG * std::sin(slopes_.before));
    return tension - speed(time) * speed(time);
}

double SlidingChain::lift_off(double held) const
{
    double before = 0.0, after = 0.1;
    while (tension_excess(after) > -kG * held) after += 0.1;
    constexpr int kBisections = 50;
    for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (before + after);
        (tension_excess(middle) > -kG * held ? before : after) = middle;
    }
    return after;
}

double distance_from_bend(const StripCase& strip, double time, const Vec3& world)
{
    const Vec3 from = to_edge_frame(strip, time, world) - find_bend(strip.slopes);
    return std::hypot(from.x(), from.z());
}

ClothRun make_strip_run(const StripCase& strip)
{
    ClothMesh mesh = make_bent_strip(strip);
    Scene scene;
    scene.materials[0] = {kDensity, strip.youngs_modulus, 0.0, strip.bending_stiffness, 0.0, kThickness};
    scene.gravity =
        Gravity{strip.place.rotation * (kG * Vec3(0.0, std::sin(strip.lean), -std::cos(strip.lean)))};
    RigidMotion motion;
    motion.velocity = strip.carried;
    scene.obstacles.push_back(
        MovingObstacle("prism", make_prism(strip.slopes), strip.place, motion, kFeatureAngle));
    if (strip.has_eol) scene.eol = make_initial_target(mesh);
    if (strip.friction > 0.0) scene.friction = Friction{{strip.friction}};
    ClothRun run(std::move(scene), std::move(mesh), strip.carried);
    run.settings.integrator = strip.integrator;
    return run;
}

double strip_mass(const StripCase& strip)
{
    return kDensity * strip.length * strip.width;
}

double measure_length_after(const StripCase& strip, const ClothRun& run)
{
    const ClothMesh& mesh = run.state.mesh;
    const double end_u = strip.length + (strip.seam && strip.seam->axis == 0 ? strip.seam->apart : 0.0);
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.material[v].x() != end_u) continue;
        const Vec3 end = to_edge_frame(strip, run.state.time, mesh.world[v]);
        sum += downhill(strip.slopes.after).dot(end - find_bend(strip.slopes));
        ++count;
    }
    return sum / count;
}

}  // namespace arris
