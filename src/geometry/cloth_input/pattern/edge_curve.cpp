// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/edge_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr int kParts = 64;         // of a Bezier curve's parameter, over which its length is summed
constexpr int kMostHalvings = 60;  // of a part, to find a parameter; Newton's steps mostly need four

// Gauss-Legendre's rule of five points on [-1, 1].
constexpr std::array<double, 5> kNodes = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                          0.9061798459386640};
constexpr std::array<double, 5> kWeights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                            0.4786286704993665, 0.2369268850561891};

// De Casteljau.
Vec2 bezier(std::vector<Vec2> points, double t)
{
    for (std::size_t left = points.size() - 1; left > 0; --left)
        for (std::size_t k = 0; k < left; ++k) points[k] += t * (points[k + 1] - points[k]);
    return points[0];
}

}  // namespace

EdgeCurve::EdgeCurve(const PanelEdge& edge, const Vec2& end) : begin_(edge.begin), end_(end)
{
    const Vec2 chord = end - begin_;
    if (const auto* curve = std::get_if<BezierCurve>(&edge.shape)) {
        control_ = {begin_};
        control_.insert(control_.end(), curve->control.begin(), curve->control.end());
        control_.push_back(end);
        measure();
        return;
    }
    const CircularArc& arc = std::get<CircularArc>(edge.shape);
    const double half = 0.5 * chord.norm(), radius = std::max(arc.radius, half);
    // A small arc that runs counter-clockwise has its centre on the chord's left.
    const double side = arc.is_counter_clockwise != arc.is_large ? 1.0 : -1.0;
    const Vec2 left = Vec2(-chord.y(), chord.x()) / std::max(2.0 * half, kLastPlaces * radius);
    centre_ = begin_ + 0.5 * chord + side * std::sqrt((radius - half) * (radius + half)) * left;
    const double small = 2.0 * std::asin(std::min(1.0, half / radius));
    sweep_ =
        (arc.is_large ? 2.0 * std::numbers::pi - small : small) * (arc.is_counter_clockwise ? 1.0 : -1.0);
    length_ = radius * std::abs(sweep_);
}

void EdgeCurve::measure()
{
    if (is_straight()) {
        length_ = (end_ - begin_).norm();
        return;
    }
    up_to_ = {0.0};
    for (int k = 0; k < kParts; ++k)
        up_to_.push_back(up_to_.back() + length_between(double(k) / kParts, double(k + 1) / kParts));
    length_ = up_to_.back();
}

double EdgeCurve::speed(double t) const
{
    std::vector<Vec2> differences;
    for (std::size_t k = 1; k < control_.size(); ++k) differences.push_back(control_[k] - control_[k - 1]);
    return static_cast<double>(differences.size()) * bezier(std::move(differences), t).norm();
}

double EdgeCurve::length_between(double from, double to) const
{
    double sum = 0.0;
    for (std::size_t k = 0; k < kNodes.size(); ++k)
        sum += kWeights[k] * speed(0.5 * (from + to) + 0.5 * (to - from) * kNodes[k]);
    return 0.5 * (to - from) * sum;
}

double EdgeCurve::parameter_at(double length) const
{
    const auto after = std::upper_bound(up_to_.begin() + 1, up_to_.end() - 1, length);
    const double begin = static_cast<double>(after - up_to_.begin() - 1) / kParts;
    const double target = length - *(after - 1);
    double low = begin, high = begin + 1.0 / kParts, t = 0.5 * (low + high);
    // Newton's step where it stays between the bounds, which close in on the parameter; half of them else.
    for (int k = 0; k < kMostHalvings; ++k) {
        const double excess = length_between(begin, t) - target;
        if (std::abs(excess) <= kLastPlaces * length_) break;
        (excess > 0.0 ? high : low) = t;
        const double newton = t - excess / speed(t);
        t = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return t;
}

Vec2 EdgeCurve::at(double share) const
{
    if (share <= 0.0) return begin_;
    if (share >= 1.0) return end_;
    if (is_straight()) return begin_ + share * (end_ - begin_);
    if (!control_.empty()) return bezier(control_, parameter_at(share * length_));
    const double angle = share * sweep_;
    const Vec2 from = begin_ - centre_;
    return centre_ + Vec2(std::cos(angle) * from.x() - std::sin(angle) * from.y(),
                          std::sin(angle) * from.x() + std::cos(angle) * from.y());
}

std::vector<EdgeCurve> curves_of(const Panel& panel)
{
    std::vector<EdgeCurve> curves;
    for (std::size_t e = 0; e < panel.edges.size(); ++e)
        curves.emplace_back(panel.edges[e], panel.edges[(e + 1) % panel.edges.size()].begin);
    return curves;
}

std::vector<Vec2> outline_of(const std::vector<EdgeCurve>& curves)
{
    std::vector<Vec2> outline;
    for (const EdgeCurve& curve : curves) {
        const int parts = curve.is_straight() ? 1 : kOutlineParts;
        for (int k = 0; k < parts; ++k) outline.push_back(curve.at(double(k) / parts));
    }
    return outline;
}

}  // namespace arris
