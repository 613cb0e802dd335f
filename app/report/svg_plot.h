// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

namespace arris {

/// Points (x, y) in ascending x, all finite.
struct PlotLine {
    std::string name;
    std::vector<std::array<double, 2>> points;
    bool is_dashed = false;
};

enum class PlotKind {
    Lines,
    LogLines,  ///< logarithmic y; values that are not positive are omitted
    Stacked,   ///< areas on top of one another; lines must have the same x, and y >= 0
};

struct Plot {
    std::string title;
    std::string unit;  ///< unit of y; empty for counts
    PlotKind kind = PlotKind::Lines;
    std::vector<PlotLine> lines;
    std::string note = {};  ///< one line of explanation; may be empty
    std::string x_label = "time (s)";
};

/// A <figure> with title, note, legend and an inline SVG, coloured by the page's CSS classes c0, c1, ...
/// Names, notes and titles are escaped. A plot without points states that it is empty.
std::string draw_plot(const Plot& plot);

/// About `count` ticks at multiples of 1, 2 or 5 times a power of ten that span [least, greatest]: apart from
/// rounding, the first is at most `least` and the last at least `greatest`. Always 2 to 4 `count` ticks.
std::vector<double> round_ticks(double least, double greatest, int count);

}  // namespace arris
