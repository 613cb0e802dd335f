// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace arris {

/// One curve of a panel; points with a coordinate that is not positive are not drawn.
struct PanelCurve {
    std::string name;
    int colour = 0;
    int dash = 0;  ///< line and marker: curves of one colour differ in it
    std::vector<double> x, y;
    std::vector<double> zero_x;  ///< points with y = 0: triangles at the lower border
};

/// A drawing with two logarithmic axes, 560 x 400 units, with its legend below.
struct LogPanel {
    std::string title, x_label, y_label;
    std::vector<PanelCurve> curves;
    std::vector<double> front_x, front_y;  ///< the Pareto front, by ascending x; ringed and joined by steps
    bool is_front_joined = true;
    std::vector<double> failed_x;    ///< crosses at the upper border
    std::vector<double> named_x;     ///< ticks of x; empty: powers of ten
    std::vector<std::string> notes;  ///< lines below the legend
};

/// Shares of a whole, stacked, by a logarithmic x.
struct SharePanel {
    std::string title, x_label;
    std::vector<std::string> names;
    std::vector<double> x;                    ///< ascending, positive
    std::vector<std::vector<double>> shares;  ///< for each x, one for each name; the sum is 1
    std::vector<double> named_x;              ///< ticks of x; empty: powers of ten
};

/// A fragment of SVG with its size.
struct PanelDrawing {
    std::string svg;
    double height = 0.0;
};

inline constexpr double kPanelWidth = 560.0;

PanelDrawing draw_panel(const LogPanel& panel);
PanelDrawing draw_panel(const SharePanel& panel);

/// A whole SVG file: panels beside each other in pairs, on white, under a title.
std::string draw_page(const std::string& title, const std::vector<PanelDrawing>& panels);

}  // namespace arris
