// SPDX-License-Identifier: GPL-3.0-or-later
// A stiff sheet slides without friction on another one: borders pass vertices of the other layer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <utility>
#include <vector>

#include "cloth_pieces.h"
#include "cloth_run.h"
#include "grid_patterns.h"

namespace arris {
namespace {

constexpr double kG = 9.81, kThickness = 1e-3;  // m/s^2, m

/// Which sheet slides on the other one, which is pinned.
enum class Slider {
    Small,  ///< its border passes over vertices
    Wide    ///< its vertices pass over a border
};

struct Slide {
    Slider slider;
    GridPattern pattern;
    double degrees, step;  ///< angle by which the upper sheet is turned; s
};

std::ostream& operator<<(std::ostream& out, const Slide& slide)
{
    return out << (slide.slider == Slider::Small ? "small " : "wide ") << name_of(slide.pattern) << " "
               << slide.degrees << " " << slide.step;
}

/// Speed that the upper sheet loses to the lower one: in one step and in all, relative to its speed.
struct Loss {
    double in_step = 0.0, in_all = 0.0;
};

Loss slide_down(const Slide& slide)
{
    constexpr double kDuration = 0.25, kStart = 0.05;  // s; before, the speed is small
    const double slope = 35.0 * std::numbers::pi / 180.0, acceleration = kG * std::sin(slope);
    const bool is_small = slide.slider == Slider::Small;
    const ClothMesh below = is_small ? make_sheet({0.6, 0.3}, {24, 12}, slide.pattern)
                                     : make_sheet({0.3, 0.2}, {9, 6}, slide.pattern),
                    above = is_small ? make_sheet({0.1, 0.1}, {3, 3}, slide.pattern)
                                     : make_sheet({0.35, 0.25}, {14, 10}, slide.pattern);
    Scene scene;
    scene.materials[0] = {0.15, 2000.0, 0.3, 0.1, 0.0, kThickness};
    scene.gravity = Gravity{kG * Vec3(std::sin(slope), 0.0, -std::cos(slope))};
    scene.self_contact = ClothContact{kThickness};
    scene.pins.push_back({.material = {{0.0, 0.0}, {0.6, 0.3}}, .motion = {}});
    ClothMesh cloth;
    add_piece(below, Vec3::Zero(), 0.0, cloth);
    const int first = cloth.vertex_count();
    add_piece(above, is_small ? Vec3(0.053, 0.102, kThickness) : Vec3(-0.113, -0.022, kThickness),
              slide.degrees, cloth);
    ClothRun run(std::move(scene), cloth);
    // Mean velocity of the upper sheet along the slope, by mass.
    const auto mean_speed = [&] {
        double sum = 0.0, area = 0.0;
        for (const Face& face : run.state.mesh.faces) {
            if (face[0] < first) continue;
            const std::vector<Vec2>& X = run.state.mesh.material;
            const double own = twice_area(X[face[0]], X[face[1]], X[face[2]]);
            for (const int v : face) sum += own / 3.0 * run.state.velocity[v].x();
            area += own;
        }
        return sum / area;
    };
    double speed = 0.0, time = 0.0;
    Loss loss;
    run.advance(kDuration, slide.step, [&](const StepReport&) {
        const double free = speed + acceleration * (run.state.time - time);
        speed = mean_speed();
        time = run.state.time;
        if (time > kStart) loss.in_step = std::max(loss.in_step, (free - speed) / free);
    });
    loss.in_all = 1.0 - speed / (acceleration * kDuration);
    return loss;
}

TEST(SelfContactSlide, PassesVerticesOfTheOtherLayerFreely)
{
    // The wide sheet hangs over the borders below, so that it bends and leans on them.
    constexpr double kLostInStep = 1e-3, kLostBySmall = 5e-4, kLostByWide = 2e-3;
    std::vector<std::pair<Slide, Loss>> losses;
    for (const Slider slider : {Slider::Small, Slider::Wide})
        for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross})
            for (const double step : {0.01, 0.005, 0.001})
                for (const double degrees : {0.0, 5.0}) {
                    const Slide slide{slider, pattern, degrees, step};
                    losses.emplace_back(slide, slide_down(slide));
                }
    for (const auto& [slide, loss] : losses) {
        EXPECT_LT(loss.in_step, kLostInStep) << slide;
        EXPECT_NEAR(loss.in_all, 0.0, slide.slider == Slider::Small ? kLostBySmall : kLostByWide) << slide;
    }
}

}  // namespace
}  // namespace arris
