// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/missing_effects.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/scene/parts/scene_effects.h"
#include "app/scene/warnings/cloth_poses.h"
#include "app/scene/warnings/under_cloth.h"

namespace arris {
namespace {

constexpr const char* kMayPass = "may pass through each other";

double in_degrees(double angle)
{
    return angle * 180.0 / std::numbers::pi;
}

bool is_pulled_down(const Scene& scene)
{
    return scene.gravity && scene.gravity->acceleration.squaredNorm() > 0.0;
}

/// Whether a pin holds the cloth for the whole run.
bool is_held(const RunConfig& config)
{
    return std::any_of(config.scene.pins.begin(), config.scene.pins.end(),
                       [&](const Pin& pin) { return pin.holds(0.0, config.duration); });
}

/// Whether a pin holds the cloth at the end of the run.
bool hangs_at_end(const RunConfig& config)
{
    return std::any_of(config.scene.pins.begin(), config.scene.pins.end(),
                       [&](const Pin& pin) { return pin.holds(pin.start, config.duration); });
}

void add(std::vector<MissingEffect>& missing, const char* effect, std::string sign)
{
    missing.push_back({effect, std::move(sign)});
}

/// The cloth's own shape and pins.
void find_meetings_of_cloth(const RunConfig& config, std::vector<MissingEffect>& missing)
{
    constexpr double kFoldedBack = 120.0;  // degrees
    constexpr double kTogether = 0.1;      // of the material between two pins
    constexpr double kOnePlace = 0.1;      // of the cloth's diagonal
    if (const int pieces = count_pieces(config.cloth); pieces > 1)
        add(missing, "self_contact", fmt::format("the cloth has {} pieces, which {}", pieces, kMayPass));
    if (const double turn = in_degrees(greatest_turn(config.cloth)); turn > kFoldedBack)
        add(missing, "self_contact",
            fmt::format("parts of the cloth start turned by {:.0f} degrees against each other, and {}", turn,
                        kMayPass));
    if (const std::optional<PinMeeting> nearest = find_nearest_pins(config);
        nearest && nearest->share < kTogether)
        add(missing, "self_contact",
            fmt::format(
                "pin.{} and pin.{} come together at t = {:.3g} s, to {:.2g} % of the material between "
                "them: folds of the cloth between them {}",
                nearest->pins[0], nearest->pins[1], nearest->time, 100.0 * nearest->share, kMayPass));
    if (is_pulled_down(config.scene) && hangs_at_end(config) && spread_of_pins(config) < kOnePlace)
        add(missing, "self_contact",
            fmt::format("the cloth hangs from one place, and its folds there {}", kMayPass));
}

/// "table", "left, right and 3 more"; empty where no obstacle is as asked.
template <typename Ask>
std::string names_of(const std::vector<UnderCloth>& obstacles, const Ask& ask)
{
    constexpr int kMostNames = 5;
    std::string names;
    int count = 0;
    for (const UnderCloth& under : obstacles)
        if (ask(under) && ++count <= kMostNames) names += (count > 1 ? ", " : "") + under.name;
    return count > kMostNames ? fmt::format("{} and {} more", names, count - kMostNames) : names;
}

/// Meetings of cloth that falls or hangs over obstacles.
void find_meetings_over(const RunConfig& config, const std::vector<UnderCloth>& obstacles,
                        std::vector<MissingEffect>& missing)
{
    constexpr double kSteep = 60.0;  // degrees
    constexpr double kNarrow = 0.1;  // of the cloth
    if (obstacles.empty()) return;
    const double slope = in_degrees(mean_slope(config.cloth, obstacles.front().up));
    if (slope > kSteep && !is_held(config))
        add(missing, "self_contact",
            fmt::format("the cloth starts at {:.0f} degrees to the horizontal and falls on {}: its folds {}",
                        slope, names_of(obstacles, [](const UnderCloth&) { return true; }), kMayPass));
    const std::string narrow = names_of(
        obstacles, [](const UnderCloth& under) { return under.is_straddled && under.width < kNarrow; });
    if (!narrow.empty())
        add(missing, "self_contact",
            fmt::format(
                "the cloth hangs down on both sides of {}, less than a tenth as wide as the cloth: the "
                "sides {}",
                narrow, kMayPass));
}

bool is_missing(const std::vector<MissingEffect>& missing, const char* effect)
{
    return std::any_of(missing.begin(), missing.end(),
                       [&](const MissingEffect& one) { return one.name == effect; });
}

/// Cloth that no pin holds over what it starts above.
void find_slides(const RunConfig& config, const std::vector<UnderCloth>& obstacles,
                 std::vector<MissingEffect>& missing)
{
    constexpr double kLevel = 0.5;  // degrees
    const std::string moving =
        names_of(obstacles, [](const UnderCloth& under) { return under.is_moving_along; });
    if (!moving.empty())
        add(missing, "friction", moving + ": moving along under the cloth does not carry it along");
    if (is_held(config)) return;
    const std::string overhung =
        names_of(obstacles, [](const UnderCloth& under) { return under.is_overhung; });
    if (!overhung.empty())
        add(missing, "friction",
            fmt::format("the cloth reaches beyond {} and no pin holds it to the end: it slides off unless it "
                        "is balanced",
                        overhung));
    const std::string cornered =
        names_of(obstacles, [](const UnderCloth& under) { return under.is_around_corner; });
    if (!cornered.empty() && !is_missing(missing, "self_contact"))
        add(missing, "self_contact",
            fmt::format("the cloth drapes around corners of {} or falls off, and its folds {}", cornered,
                        kMayPass));
    const std::string sloping = names_of(obstacles, [](const UnderCloth& under) {
        return !under.is_overhung && in_degrees(under.steepest) > kLevel;
    });
    if (!sloping.empty())
        add(missing, "friction",
            fmt::format("the cloth is on slopes of {} and no pin holds it to the end: it slides down",
                        sloping));
}

/// Effects that this version has and the scene leaves out.
void find_oversights(const RunConfig& config, std::vector<MissingEffect>& missing)
{
    const Scene& scene = config.scene;
    if (!scene.gravity && !scene.obstacles.empty())
        add(missing, "gravity",
            "there are obstacles, but the cloth does not fall: [gravity] is what makes it fall");
    if (std::none_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.bending_stiffness > 0.0; }))
        add(missing, "bending",
            "the cloth folds without resistance, so its folds are as sharp and as small as its cells: "
            "cloth.material.bending_stiffness is what resists");
    if (!scene.eol && has_features(scene))
        add(missing, "eol",
            "coarse cloth may snag on sharp features: eol.enabled = true is what lets it slide");
}

}  // namespace

std::vector<MissingEffect> find_missing_effects(const RunConfig& config)
{
    std::vector<MissingEffect> missing;
    find_meetings_of_cloth(config, missing);
    if (is_pulled_down(config.scene)) {
        const std::vector<UnderCloth> obstacles = find_under_cloth(config);
        find_meetings_over(config, obstacles, missing);
        find_slides(config, obstacles, missing);
    }
    find_oversights(config, missing);
    for (const SceneEffect& effect : list_effects(config))
        if (effect.is_on)
            std::erase_if(missing, [&](const MissingEffect& one) { return one.name == effect.name; });
    return missing;
}

}  // namespace arris
