// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/log_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/text/html_escape.h"

namespace arris {
namespace {

constexpr double kLeft = 78, kRight = 12, kTop = 34, kPlotHeight = 290, kAxisHeight = 42, kLine = 17;
constexpr double kBottom = kTop + kPlotHeight;
constexpr std::array<const char*, 10> kColours = {"#2a6fdb", "#e07b00", "#189a63", "#c2306e", "#7a56c8",
                                                  "#0e98a8", "#a8820c", "#d9534f", "#74808f", "#8a5a44"};
constexpr std::array<const char*, 5> kDashes = {"", "6 4", "2 3", "9 3 2 3", "1 5"};
constexpr std::size_t kMostNamedTicks = 9;
constexpr double kLeastDecades = 1e-9;  // a shorter axis shows one value

/// A logarithmic axis.
struct LogAxis {
    double least = 0.0, greatest = 1.0;  ///< exponents of ten
    double from = 0.0, to = 1.0;         ///< units of the drawing

    double operator()(double value) const
    {
        return from + (to - from) * (std::log10(value) - least) / (greatest - least);
    }
};

LogAxis make_axis(const std::vector<double>& values, double from, double to)
{
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const double value : values)
        if (value > 0.0 && std::isfinite(value)) {
            least = std::min(least, std::log10(value));
            greatest = std::max(greatest, std::log10(value));
        }
    if (least > greatest) least = greatest = 0.0;
    if (greatest - least < kLeastDecades) greatest += 0.5, least -= 0.5;
    const double margin = 0.06 * (greatest - least);
    return {least - margin, greatest + margin, from, to};
}

/// Powers of ten; where these are fewer than three, also their multiples.
std::vector<double> make_ticks(const LogAxis& axis)
{
    std::vector<double> ticks;
    for (const std::vector<double>& steps :
         {std::vector<double>{1.0}, {1.0, 2.0, 5.0}, {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}}) {
        ticks.clear();
        const double first = std::floor(axis.least), last = std::ceil(axis.greatest);
        const double stride = std::ceil((last - first) / 8.0);
        for (double power = first; power <= last; power += stride)
            for (const double step : steps) {
                const double exponent = power + std::log10(step);
                if (exponent >= axis.least && exponent <= axis.greatest)
                    ticks.push_back(step * std::pow(10.0, power));
            }
        if (ticks.size() >= 3) break;
    }
    return ticks;
}

std::string tick_text(double value)
{
    return value >= 1e-3 && value < 1e5 ? fmt::format("{:.6g}", value) : fmt::format("{:.3g}", value);
}

std::string draw_text(double x, double y, const char* anchor, const std::string& text, const char* more = "")
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                       escape_html(text));
}

std::string draw_border(const std::string& title, const std::string& y_label)
{
    return draw_text(kLeft, 18, "start", title, " class=\"title\"") +
           fmt::format(
               "<text transform=\"translate(13 {:.0f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
               kTop + 0.5 * kPlotHeight, escape_html(y_label)) +
           fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", kLeft, kTop,
                       kPanelWidth - kLeft - kRight, kPlotHeight);
}

std::string draw_x_axis(const LogAxis& x, std::vector<double> named, const std::string& label)
{
    if (named.empty() || named.size() > kMostNamedTicks) named = make_ticks(x);
    std::string svg;
    for (const double tick : named) {
        svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {}V{}\"/>", x(tick), kTop, kBottom);
        svg += draw_text(x(tick), kBottom + 16, "middle", tick_text(tick));
    }
    return svg + draw_text(0.5 * (kLeft + kPanelWidth - kRight), kBottom + 34, "middle", label);
}

std::string draw_y_axis(const LogAxis& y)
{
    std::string svg;
    for (const double tick : make_ticks(y)) {
        svg +=
            fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>", kLeft, y(tick), kPanelWidth - kRight);
        svg += draw_text(kLeft - 6, y(tick) + 4, "end", tick_text(tick));
    }
    return svg;
}

std::string marker(double x, double y, int kind)
{
    switch (kind % 4) {
        case 0:
            return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\"/>", x, y);
        case 1:
            return fmt::format("<path d=\"M{:.1f} {:.1f}h7v7h-7z\"/>", x - 3.5, y - 3.5);
        case 2:
            return fmt::format("<path d=\"M{:.1f} {:.1f}l4.2 7.4h-8.4z\"/>", x, y - 4.6);
        default:
            return fmt::format("<path d=\"M{:.1f} {:.1f}l4.6 4.6l-4.6 4.6l-4.6 -4.6z\"/>", x, y - 4.6);
    }
}

std::string line_style(int colour, int dash)
{
    return fmt::format("stroke=\"{}\" fill=\"none\" stroke-dasharray=\"{}\"",
                       kColours[colour % kColours.size()], kDashes[dash % kDashes.size()]);
}

std::string draw_curve(const PanelCurve& curve, const LogAxis& x, const LogAxis& y)
{
    std::string data, markers;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!(curve.x[i] > 0.0) || !(curve.y[i] > 0.0)) continue;
        const double at_x = x(curve.x[i]), at_y = y(curve.y[i]);
        data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", at_x, at_y);
        markers += marker(at_x, at_y, curve.dash);
    }
    for (const double value : curve.zero_x)
        if (value > 0.0)
            markers += fmt::format("<path d=\"M{:.1f} {:.1f}h9l-4.5 8z\"/>", x(value) - 4.5, kBottom - 9);
    return fmt::format("<path class=\"curve\" {} d=\"{}\"/><g fill=\"{}\">{}</g>\n",
                       line_style(curve.colour, curve.dash), data, kColours[curve.colour % kColours.size()],
                       markers);
}

// A front is a staircase: no run is known that is better than both neighbours.
std::string draw_front(const LogPanel& panel, const LogAxis& x, const LogAxis& y)
{
    std::string data, rings;
    for (std::size_t i = 0; i < panel.front_x.size(); ++i) {
        if (!(panel.front_x[i] > 0.0) || !(panel.front_y[i] > 0.0)) continue;
        const double at_x = x(panel.front_x[i]), at_y = y(panel.front_y[i]);
        data += data.empty() ? fmt::format("M{:.1f} {:.1f}", at_x, at_y)
                             : fmt::format("H{:.1f}V{:.1f}", at_x, at_y);
        rings += fmt::format("<circle class=\"ring\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7.5\"/>", at_x, at_y);
    }
    return (panel.is_front_joined ? fmt::format("<path class=\"front\" d=\"{}\"/>", data) : "") + rings +
           "\n";
}

std::string cross(double x, double y)
{
    return fmt::format("<path class=\"failed\" d=\"M{:.1f} {:.1f}l8 8m0 -8l-8 8\"/>", x - 4, y - 4);
}

std::string draw_failed(const std::vector<double>& failed_x, const LogAxis& x)
{
    std::string svg;
    for (const double value : failed_x)
        if (value > 0.0) svg += cross(x(value), kTop + 9);
    return svg + "\n";
}

/// Lines of text below a plot, one entry a line.
class Legend {
  public:
    void add(const std::string& symbol, const std::string& text)
    {
        svg_ += fmt::format("<g transform=\"translate({} {:.1f})\">{}</g>", kLeft, y_ - 4, symbol);
        svg_ += draw_text(kLeft + (symbol.empty() ? 0 : 34), y_, "start", text);
        y_ += kLine;
    }
    PanelDrawing finish(const std::string& plot) const { return {plot + svg_, y_}; }

  private:
    std::string svg_;
    double y_ = kBottom + kAxisHeight + kLine;
};

std::vector<double> all_values(const LogPanel& panel, std::vector<double> PanelCurve::*coordinate,
                               const std::vector<double>& more)
{
    std::vector<double> values = more;
    for (const PanelCurve& curve : panel.curves)
        values.insert(values.end(), (curve.*coordinate).begin(), (curve.*coordinate).end());
    return values;
}

}  // namespace

PanelDrawing draw_panel(const LogPanel& panel)
{
    std::vector<double> at_border = panel.failed_x;
    for (const PanelCurve& curve : panel.curves)
        at_border.insert(at_border.end(), curve.zero_x.begin(), curve.zero_x.end());
    const LogAxis x = make_axis(all_values(panel, &PanelCurve::x, at_border), kLeft, kPanelWidth - kRight);
    const LogAxis y = make_axis(all_values(panel, &PanelCurve::y, {}), kBottom, kTop);
    std::string svg = draw_y_axis(y) + draw_x_axis(x, panel.named_x, panel.x_label) +
                      draw_border(panel.title, panel.y_label);
    for (const PanelCurve& curve : panel.curves) svg += draw_curve(curve, x, y);
    svg += draw_front(panel, x, y) + draw_failed(panel.failed_x, x);
    Legend legend;
    for (const PanelCurve& curve : panel.curves)
        legend.add(fmt::format("<path class=\"curve\" {} d=\"M0 0H26\"/><g fill=\"{}\">{}</g>",
                               line_style(curve.colour, curve.dash), kColours[curve.colour % kColours.size()],
                               marker(13, 0, curve.dash)),
                   curve.name);
    if (!panel.front_x.empty())
        legend.add("<circle class=\"ring\" cx=\"13\" cy=\"0\" r=\"7.5\"/>",
                   "Pareto front: no run is cheaper and better");
    if (!panel.failed_x.empty()) legend.add(cross(13, 0), "failed run, without an error");
    for (const std::string& note : panel.notes) legend.add("", note);
    return legend.finish(svg);
}

PanelDrawing draw_panel(const SharePanel& panel)
{
    const LogAxis x = make_axis(panel.x, kLeft, kPanelWidth - kRight);
    std::string svg;
    std::vector<double> below(panel.x.size(), 0.0);
    Legend legend;
    for (std::size_t k = 0; k < panel.names.size(); ++k) {
        std::string up, down;
        for (std::size_t i = 0; i < panel.x.size(); ++i) {
            const double low = kBottom - kPlotHeight * below[i];
            below[i] += panel.shares[i][k];
            up += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x(panel.x[i]),
                              kBottom - kPlotHeight * below[i]);
            down = fmt::format("L{:.1f} {:.1f}", x(panel.x[i]), low) + down;
        }
        const char* colour = kColours[k % kColours.size()];
        svg += fmt::format("<path fill=\"{}\" d=\"{}{}Z\"/>\n", colour, up, down);
        legend.add(fmt::format("<rect width=\"12\" height=\"12\" y=\"-8\" fill=\"{}\"/>", colour),
                   panel.names[k]);
    }
    svg += draw_x_axis(x, panel.named_x, panel.x_label) + draw_border(panel.title, "share of a step (%)");
    for (const int tick : {0, 25, 50, 75, 100})
        svg += draw_text(kLeft - 6, kBottom - kPlotHeight * tick / 100.0 + 4, "end", std::to_string(tick));
    return legend.finish(svg);
}

std::string draw_page(const std::string& title, const std::vector<PanelDrawing>& panels)
{
    constexpr double kHead = 34, kGap = 14;
    std::string body;
    double y = kHead, width = kPanelWidth;
    for (std::size_t i = 0; i < panels.size(); i += 2) {
        double height = panels[i].height;
        body += fmt::format("<g transform=\"translate(0 {:.0f})\">\n{}</g>\n", y, panels[i].svg);
        if (i + 1 < panels.size()) {
            body += fmt::format("<g transform=\"translate({} {:.0f})\">\n{}</g>\n", kPanelWidth + kGap, y,
                                panels[i + 1].svg);
            height = std::max(height, panels[i + 1].height);
            width = 2 * kPanelWidth + kGap;
        }
        y += height + kGap;
    }
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
               "height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n"
               "<style>text{{font:12px 'DejaVu Sans','Noto Sans',Arial,sans-serif;fill:#3a4049}}"
               ".title,.head{{font-weight:bold;fill:#1c1e21}}.head{{font-size:15px}}"
               ".grid{{stroke:#e2e3e0;fill:none}}.frame{{stroke:#9aa0a8;fill:none}}.curve{{stroke-width:1.7}}"
               ".front{{stroke:#1c1e21;fill:none;stroke-width:1;stroke-dasharray:3 3}}"
               ".ring{{stroke:#1c1e21;fill:none;stroke-width:1.2}}.failed{{stroke:#b3261e;fill:none;stroke-"
               "width:2}}"
               "</style>\n<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
               width, y, escape_html(title)) +
           draw_text(kLeft, 22, "start", title, " class=\"head\"") + body + "</svg>\n";
}

}  // namespace arris
