// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "app/text/html_escape.h"

namespace arris {
namespace {

constexpr double kWidth = 640, kHeight = 250;  // size of the drawing in its own units; the page scales it
constexpr double kLeft = 66, kRight = 14, kTop = 10, kBottom = 40;
constexpr double kGreatest = 1e300;  // values are clamped to this, so that differences stay finite
constexpr int kColours = 10;         // number of colours in the page's style sheet

struct Range {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void include(double value)
    {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    bool is_empty() const { return least > greatest; }
};

/// One axis: maps values to drawing units, and holds the ticks.
struct Axis {
    Range range;
    std::vector<double> ticks;    ///< inside the range
    double from = 0.0, to = 1.0;  ///< drawing units of the range's ends
    bool is_log = false;          ///< values are exponents of ten

    double operator()(double value) const
    {
        return from + (to - from) * (value - range.least) / (range.greatest - range.least);
    }
};

// As many digits as distinguish neighbouring ticks.
std::string tick_label(const Axis& axis, double tick)
{
    if (axis.is_log) return fmt::format("1e{:g}", tick);
    const double step = axis.ticks.size() < 2 ? std::abs(tick) : axis.ticks[1] - axis.ticks[0];
    if (std::abs(tick) <= 1e-6 * step) return "0";  // also for a single tick at 0, where the step is 0
    const double greatest = std::max(std::abs(axis.ticks.front()), std::abs(axis.ticks.back()));
    constexpr double kLeastPlain = 1e-3, kGreatestPlain = 1e7;
    if (step >= kLeastPlain && greatest < kGreatestPlain)
        return fmt::format("{:.{}f}", tick, static_cast<int>(std::max(0.0, -std::floor(std::log10(step)))));
    const double digits = std::ceil(std::log10(greatest / step)) + 1.0;
    return fmt::format("{:.{}g}", tick, static_cast<int>(std::clamp(digits, 3.0, 16.0)));
}

double shown(double y, PlotKind kind)
{
    return kind == PlotKind::LogLines ? std::log10(y) : std::clamp(y, -kGreatest, kGreatest);
}

// Removes points that the axis cannot show, and turns stacked lines into running sums.
std::vector<PlotLine> drawable_lines(const Plot& plot)
{
    std::vector<PlotLine> lines = plot.lines;
    for (PlotLine& line : lines) {
        if (plot.kind == PlotKind::LogLines)
            std::erase_if(line.points, [](const auto& p) { return !(p[1] > 0.0); });
        for (auto& point : line.points)
            point = {std::clamp(point[0], -kGreatest, kGreatest), shown(point[1], plot.kind)};
    }
    if (plot.kind == PlotKind::Stacked)
        for (std::size_t i = 1; i < lines.size(); ++i)
            for (std::size_t k = 0; k < lines[i].points.size(); ++k)
                lines[i].points[k][1] += lines[i - 1].points[k][1];
    return lines;
}

Range range_of(const std::vector<PlotLine>& lines, std::size_t coordinate)
{
    Range range;
    for (const PlotLine& line : lines)
        for (const auto& point : line.points) range.include(point[coordinate]);
    return range;
}

// Includes zero if that takes less than half of the axis.
void include_near_zero(Range& range)
{
    if (range.least > 0.0 && range.least < 0.5 * range.greatest) range.include(0.0);
}

// The time axis ends with the data, not at a tick, so that the curve fills the width. Only a degenerate range
// ends at ticks.
Axis make_x_axis(const std::vector<PlotLine>& lines)
{
    Range range = range_of(lines, 0);
    include_near_zero(range);
    Axis axis{range, round_ticks(range.least, range.greatest, 6), kLeft, kWidth - kRight};
    const double step = axis.ticks[1] - axis.ticks[0];
    if (!(range.greatest - range.least > step)) axis.range = {axis.ticks.front(), axis.ticks.back()};
    const double slack = 1e-6 * (axis.range.greatest - axis.range.least);
    std::erase_if(axis.ticks, [&](double tick) {
        return tick < axis.range.least - slack || tick > axis.range.greatest + slack;
    });
    return axis;
}

Axis make_y_axis(const std::vector<PlotLine>& lines, PlotKind kind)
{
    Range range = range_of(lines, 1);
    Axis axis{{}, {}, kHeight - kBottom, kTop, kind == PlotKind::LogLines};
    if (axis.is_log) {
        const double least = std::floor(range.least),
                     greatest = std::max(least + 1.0, std::ceil(range.greatest));
        const double step = std::ceil((greatest - least) / 5.0);
        for (double tick = least; tick < greatest + step; tick += step) axis.ticks.push_back(tick);
    } else {
        include_near_zero(range);
        if (kind == PlotKind::Stacked) range.include(0.0);
        axis.ticks = round_ticks(range.least, range.greatest, 5);
    }
    axis.range = {axis.ticks.front(), axis.ticks.back()};
    return axis;
}

std::string draw_text(double x, double y, const char* anchor, const std::string& text)
{
    return fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y,
                       anchor, escape_html(text));
}

std::string draw_y_grid(const Axis& y)
{
    std::string svg;
    for (const double tick : y.ticks) {
        svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kLeft, y(tick),
                           kWidth - kRight);
        svg += draw_text(kLeft - 7, y(tick) + 4, "end", tick_label(y, tick));
    }
    return svg;
}

std::string draw_x_axis(const Axis& x, const std::string& label)
{
    const double bottom = kHeight - kBottom;
    std::string svg =
        fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", kLeft, bottom, kWidth - kRight);
    for (const double tick : x.ticks) {
        svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}v4\"/>", x(tick), bottom);
        svg += draw_text(x(tick), bottom + 17, "middle", tick_label(x, tick));
    }
    return svg + draw_text((kLeft + kWidth - kRight) / 2, kHeight - 6, "middle", label);
}

std::string colour_class(std::size_t index)
{
    return fmt::format("c{}", index % kColours);
}

std::string path_data(const PlotLine& line, const Axis& x, const Axis& y)
{
    std::string data;
    for (const auto& point : line.points)
        data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", x(point[0]), y(point[1]));
    if (line.points.size() == 1) data += "h0";  // round caps make it a dot
    return data;
}

std::string draw_line(const PlotLine& line, std::size_t index, const Axis& x, const Axis& y)
{
    const char* shape = line.points.size() == 1 ? " dot" : line.is_dashed ? " dashed" : "";
    return fmt::format("<path class=\"line{} {}\" d=\"{}\"/>", shape, colour_class(index),
                       path_data(line, x, y));
}

std::string draw_area(const PlotLine& line, std::size_t index, const Axis& x, const Axis& y)
{
    if (line.points.size() < 2) return draw_line(line, index, x, y);
    return fmt::format("<path class=\"area {}\" d=\"{}L{:.1f} {:.1f}H{:.1f}Z\"/>", colour_class(index),
                       path_data(line, x, y), x(line.points.back()[0]), kHeight - kBottom,
                       x(line.points.front()[0]));
}

std::string draw_svg(const Plot& plot)
{
    const std::vector<PlotLine> lines = drawable_lines(plot);
    const bool is_empty =
        std::all_of(lines.begin(), lines.end(), [](const auto& line) { return line.points.empty(); });
    if (is_empty) return "<p class=\"nothing\">nothing to show</p>";

    const Axis x = make_x_axis(lines), y = make_y_axis(lines, plot.kind);
    std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                                  kHeight, escape_html(plot.title));
    svg += draw_y_grid(y);
    // Draw from the largest sum down. Each area covers all below it, so only upper edges are needed.
    const bool is_stacked = plot.kind == PlotKind::Stacked;
    for (std::size_t i = 0; i < lines.size(); ++i)
        svg += is_stacked ? draw_area(lines[lines.size() - 1 - i], lines.size() - 1 - i, x, y)
                          : draw_line(lines[i], i, x, y);
    return svg + draw_x_axis(x, plot.x_label) + "</svg>";
}

const char* swatch_shape(const Plot& plot, std::size_t line)
{
    if (plot.kind == PlotKind::Stacked) return " square";
    return plot.lines[line].is_dashed ? " dashed" : "";
}

std::string draw_legend(const Plot& plot)
{
    std::string html = "<ul class=\"legend\">";
    for (std::size_t i = 0; i < plot.lines.size(); ++i)
        html += fmt::format("<li><span class=\"swatch{} {}\"></span>{}</li>", swatch_shape(plot, i),
                            colour_class(i), escape_html(plot.lines[i].name));
    return html + "</ul>";
}

}  // namespace

std::vector<double> round_ticks(double least, double greatest, int count)
{
    // Differences below this share of the value are rounding; such a range counts as constant.
    constexpr double kLeastShare = 1e-9, kLeastRange = 1e-290;
    const double size = std::max(std::abs(least), std::abs(greatest));
    const double needed = std::max(kLeastShare * size, kLeastRange);
    if (!(greatest - least > needed)) {
        const double half = size > kLeastRange ? 0.1 * size : 1.0;
        greatest = least + half;
        least -= half;
    }
    const double rough = (greatest - least) / count;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double multiple = rough / power;
    const double step = power * (multiple <= 1.0   ? 1.0
                                 : multiple <= 2.0 ? 2.0
                                 : multiple <= 5.0 ? 5.0
                                                   : 10.0);

    // Multiples of the step do not drift as sums would.
    constexpr double kSlack = 1e-6;  // steps: a value this near to a tick is that tick
    const double first = std::floor(least / step + kSlack), last = std::ceil(greatest / step - kSlack);
    std::vector<double> ticks;
    for (double i = first; i <= last && std::ssize(ticks) < 4 * count; i += 1.0) ticks.push_back(i * step);
    if (ticks.size() < 2) ticks.push_back(ticks.front() + step);
    return ticks;
}

std::string draw_plot(const Plot& plot)
{
    std::string title = "<span class=\"name\">" + escape_html(plot.title) + "</span>";
    if (!plot.unit.empty()) title += " <span class=\"unit\">" + escape_html(plot.unit) + "</span>";
    const std::string note = plot.note.empty() ? "" : "<p class=\"why\">" + escape_html(plot.note) + "</p>";
    return "<figure><figcaption>" + title + "</figcaption>" + note + draw_legend(plot) + draw_svg(plot) +
           "</figure>\n";
}

}  // namespace arris
