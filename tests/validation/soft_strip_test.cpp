// SPDX-License-Identifier: GPL-3.0-or-later
// A soft strip over a ridge is released unstretched at the place where a stiff strip would be in equilibrium.
// It settles, oscillates and slides. The reference is an elastic bar along the slopes, solved here by small
// explicit steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "refinement.h"
#include "sliding_strip.h"

namespace arris {
namespace {

constexpr double kG = 9.81;
constexpr double kDegrees = std::numbers::pi / 180.0;
constexpr double kDuration = 0.5;  // s

/// Linear elements along the strip. `place_` is the coordinate along the slopes past the ridge, m.
class Bar {
  public:
    Bar(const StripCase& strip, int cells)
        : before_(kG * std::sin(strip.slopes.before)),
          after_(kG * std::sin(strip.slopes.after)),
          cell_(strip.length / cells),
          stiffness_(strip.youngs_modulus / (strip_mass(strip) / (strip.length * strip.width))),
          place_(cells + 1),
          speed_(cells + 1, 0.0),
          force_(cells + 1)
    {
        for (int i = 0; i <= cells; ++i) place_[i] = i * cell_ - (strip.length - strip.start);
    }

    double end() const { return place_.back(); }

    /// Leapfrog steps at 40 % of the time in which sound crosses a cell.
    void advance(double duration)
    {
        const int steps = static_cast<int>(std::ceil(duration / (0.4 * cell_ / std::sqrt(stiffness_))));
        const double dt = duration / steps;
        find_force();
        for (int k = 0; k < steps; ++k) {
            kick(0.5 * dt);
            for (std::size_t i = 0; i < place_.size(); ++i) place_[i] += dt * speed_[i];
            find_force();
            kick(0.5 * dt);
        }
    }

  private:
    void kick(double dt)
    {
        for (std::size_t i = 0; i < place_.size(); ++i) {
            const bool is_end = i == 0 || i + 1 == place_.size();
            speed_[i] += dt * force_[i] / (is_end ? 0.5 * cell_ : cell_);
        }
    }

    /// Force over density: elasticity, and gravity by exact integrals, also where the ridge is inside an
    /// element.
    void find_force()
    {
        std::fill(force_.begin(), force_.end(), 0.0);
        for (std::size_t i = 0; i + 1 < place_.size(); ++i) {
            const double length = place_[i + 1] - place_[i];
            const double tension = stiffness_ * (length / cell_ - 1.0);
            // Share of the element before the ridge.
            const double q = std::clamp(-place_[i] / length, 0.0, 1.0);
            const double steeper = cell_ * (after_ - before_);
            force_[i] += tension + 0.5 * cell_ * before_ + 0.5 * steeper * (1.0 - q) * (1.0 - q);
            force_[i + 1] += -tension + 0.5 * cell_ * before_ + 0.5 * steeper * (1.0 - q * q);
        }
    }

    double before_, after_;  ///< m/s^2 down the slopes
    double cell_, stiffness_;
    std::vector<double> place_, speed_, force_;
};

StripCase soft_strip()
{
    StripCase strip;
    strip.slopes = {-20.0 * kDegrees, 45.0 * kDegrees};
    strip.start = SlidingChain(strip.slopes, strip.length, 0.0).balance();
    strip.youngs_modulus = 50.0;
    return strip;
}

TEST(SoftStrip, SlidesAsAnElasticBar)
{
    const StripCase soft = soft_strip();
    std::vector<double> slips;
    for (const int cells : {100, 200, 400}) {
        Bar bar(soft, cells);
        bar.advance(kDuration);
        slips.push_back(bar.end() - soft.start);
    }
    const double exact = slips.back();
    EXPECT_NEAR(slips[1] / exact, 1.0, 1e-3) << "the bar has converged";

    // Steps far below the period of the oscillation, 0.1 s, as BDF2 damps it.
    constexpr double kStep = 0.000625;  // s
    Table table("sliding_soft", {"cells", "pattern", "slip in 0.5 s", "error"});
    for (const auto& [cells, tolerance] : {std::pair{7, 0.02}, {16, 0.005}, {32, 0.005}, {64, 0.005}})
        for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross}) {
            if (cells > 16 && !is_deep()) continue;
            StripCase strip = soft;
            strip.cells = {cells, std::max(cells / 5, 1)};
            strip.pattern = pattern;
            ClothRun run = make_strip_run(strip);
            run.advance(kDuration, kStep);
            const double slip = measure_length_after(strip, run) - strip.start;
            EXPECT_NEAR(slip / exact, 1.0, tolerance) << cells << " cells";
            table.add({fmt::format("{}", cells), pattern == GridPattern::Cross ? "cross" : "diagonal",
                       fmt::format("{:.3f} mm", 1e3 * slip),
                       fmt::format("{:.2f} %", 100.0 * (slip / exact - 1.0))});
        }
}

}  // namespace
}  // namespace arris
