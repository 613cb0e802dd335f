// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/placement_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/scene/parts/scene_obstacles.h"
#include "geometry/cloth/material_box.h"

namespace arris {
namespace {

// A file in centimetres is 100 times too large, beside a cloth that may be 5 times smaller or larger.
constexpr double kSurprisingRatio = 20.0;

// Diagonals (m) of obstacles that no unit need explain: from a pin's head to a floor of 10 m x 10 m. A rod of
// some millimetres beside cloth of some metres is as plausible as a table beside a napkin.
constexpr double kSmallest = 1e-3, kLargest = 15.0;

Box3 box_around(const std::vector<Vec3>& points)
{
    Box3 box;
    for (const Vec3& x : points) box.extend(x);
    return box;
}

void check_units(const RunConfig& config, std::size_t i, double cloth, Warnings& warnings)
{
    if (!config.as_run["obstacle"][i].contains("file")) return;
    const double size = config.scene.obstacles[i].shape().bounds().diagonal().norm();
    if (size >= kSmallest && size <= kLargest) return;
    if (size < kSurprisingRatio * cloth && cloth < kSurprisingRatio * size) return;
    const std::string units = fmt::format("obstacle.{}.units", i);
    const bool has_units = warnings.is_written(units);
    warnings.note(has_units ? units : fmt::format("obstacle.{}.file", i),
                  fmt::format("the obstacle is {:.3g} m in size and the cloth {:.3g} m: {}", size, cloth,
                              has_units ? "check this unit, and 'scale'"
                                        : "a file that is not in metres needs 'units' or 'scale'"));
}

/// Warns of gravity that points sideways or up, mostly taken over from a program in which y is up.
void check_gravity(const RunConfig& config, Warnings& warnings)
{
    if (!config.scene.gravity) return;
    const Vec3& g = config.scene.gravity->acceleration;
    if (g.z() < 0.0 || !(g.norm() > 0.0)) return;
    warnings.note("gravity.acceleration",
                  fmt::format("does not point down: up is +z, so that gravity is [0, 0, {:.4g}]; a file with "
                              "y up needs up = \"y\"",
                              -g.norm()));
}

/// Whether gravity alone moves the cloth, and no obstacle moves.
bool only_falls(const RunConfig& config)
{
    const Scene& scene = config.scene;
    return scene.gravity && scene.pins.empty() && scene.pulls.empty() && !scene.wind &&
           std::all_of(config.cloth_velocity.begin(), config.cloth_velocity.end(),
                       [](const Vec3& velocity) { return velocity.isZero(0.0); }) &&
           std::none_of(scene.obstacles.begin(), scene.obstacles.end(),
                        [](const MovingObstacle& obstacle) { return obstacle.is_moving(); });
}

/// Whether a point that moves from `from` by `way` enters `box`.
bool enters(const Box3& box, const Vec3& from, const Vec3& way)
{
    double begin = 0.0, end = 1.0;  // the part of the way inside the slabs so far
    for (int d = 0; d < 3; ++d) {
        const double least = box.min()[d] - from[d], greatest = box.max()[d] - from[d];
        if (std::abs(way[d]) * 1e12 <= greatest - least) {  // parallel to this slab
            if (least > 0.0 || greatest < 0.0) return false;
            continue;
        }
        begin = std::max(begin, std::min(least / way[d], greatest / way[d]));
        end = std::min(end, std::max(least / way[d], greatest / way[d]));
    }
    return begin <= end;
}

/// Warns of cloth that falls past all obstacles, or not as far as the first one. Boxes stand for the
/// obstacles and for the cloth, which may also spread from folds, so that only a clear miss is a warning.
void check_reach(const RunConfig& config, Warnings& warnings)
{
    constexpr double kSpread = 0.05;  // of the cloth's size
    if (config.scene.obstacles.empty() || !only_falls(config)) return;
    const Box3 cloth = box_around(config.cloth.world);
    double size = 0.0;  // of the largest piece
    for (std::size_t i = 0; i < config.pieces.size(); ++i)
        size = std::max(size, material_size(extract_piece(config, i).material));
    const double spread =
        config.scene.materials.thickness() + kSpread * size + std::max(0.0, size - cloth.diagonal().norm());
    const Vec3 reach = 0.5 * cloth.sizes() + Vec3::Constant(spread);
    const Vec3 way = 0.5 * config.duration * config.duration * config.scene.gravity->acceleration;
    std::vector<std::string> names;
    for (const MovingObstacle& obstacle : config.scene.obstacles) {
        Box3 box = bounds_at(obstacle, 0.0);
        box = Box3(box.min() - reach, box.max() + reach);
        if (enters(box, cloth.center(), way)) return;
        names.push_back(obstacle.name());
    }
    const Vec3 at = cloth.center();
    warnings.note(
        fmt::format("the cloth reaches none of: {}: it only falls, by {:.3g} m in {:g} s from [{:.4g}, "
                    "{:.4g}, {:.4g}]; check "
                    "'translate', 'up' and 'units', and the duration",
                    fmt::join(names, ", "), way.norm(), config.duration, at.x(), at.y(), at.z()));
}

}  // namespace

void check_placement(const RunConfig& config, Warnings& warnings)
{
    const double cloth = box_around(config.cloth.world).diagonal().norm();
    for (std::size_t i = 0; i < config.scene.obstacles.size(); ++i) check_units(config, i, cloth, warnings);
    check_gravity(config, warnings);
    check_reach(config, warnings);
}

}  // namespace arris
