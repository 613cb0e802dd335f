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
    LogLines,  ///< logarithmic y; values that are not positive are left out
    Stacked,   ///< areas on top of one another; lines must have the same x, and y >= 0
};

struct Plot {
    std::string title;
    std::string unit;  ///< of y; empty for counts
    PlotKind kind = PlotKind::Lines;
    std::vector<PlotLine> lines;
    std::string note = {};  ///< one line that says what is shown; may be empty
    std::string x_label = "time (s)";
};

/// A <figure> with title, note, legend and an inline SVG, coloured by the page's CSS classes c0, c1, ...
/// Names, notes and titles are escaped. A plot without a point says so.
std::string draw_plot(const Plot& plot);

/// Round values (1, 2, 5 times a power of ten), about `count`, spanning [least, greatest]: the first is not
/// above `least`, the last not below `greatest`, but for rounding. At least two, at most 4 `count`, whatever
/// the numbers.
std::vector<double> round_ticks(double least, double greatest, int count);

}  // namespace arris
