// SPDX-License-Identifier: GPL-3.0-or-later
// A strip of cloth slides without friction over a straight edge, from one slope onto a steeper one, like a
// chain over a pulley.
//
//      before          x: material that has gone over the edge, measured along the slope after it
//     _________
//     (L - x)  \       x" = g (x sin b + (L - x) sin a) / L,   a, b: how steeply the slopes go down
//     strip     \ x
//                \     a table's edge: a = 0, b = 90 degrees; a ridge: a < 0
//                 after
//
// The strip is thin and stiff, so it neither stretches nor bends noticeably. It presses on the edge while its
// tension exceeds the flow of momentum around the bend, rho x'^2; then it lifts off.
#pragma once

#include <optional>

#include "cloth_run.h"
#include "tests/sewn_cloth.h"

namespace arris {

/// Angles below the horizontal, rad; before < after.
struct Slopes {
    double before = 0.0, after = 0.5 * 3.14159265358979323846;
};

/// Closed form of a chain of `length` (m) that starts at rest with `start` (m) over the edge.
class SlidingChain {
  public:
    SlidingChain(const Slopes& slopes, double length, double start);

    double length_after(double time) const;  ///< x, m
    double speed(double time) const;         ///< x', m/s
    double acceleration(double time) const;  ///< x", m/s^2

    /// Time at which the chain stops pressing on the edge, s; the chain must slide forward. The edge also
    /// carries the weight of `held` (m) of the chain, besides its tension.
    double lift_off(double held = 0.0) const;

    double balance() const { return balance_; }  ///< x of the chain in equilibrium, m

  private:
    double tension_excess(double time) const;  ///< (T - rho x'^2) / rho at the edge, m^2/s^2
    Slopes slopes_;
    double length_, start_;
    double balance_;
    double rate_;  ///< 1/s
};

struct StripCase {
    Slopes slopes = {};
    double length = 1.0, width = 0.2, start = 0.1;  ///< m
    std::array<int, 2> cells = {8, 2};
    GridPattern pattern = GridPattern::Diagonal;
    double pattern_angle = 0.0;  ///< degrees
    double youngs_modulus = 2e5, bending_stiffness = 1e-7;
    Integrator integrator = Integrator::Bdf2;
    bool has_eol = true;
    Placement place = {};          ///< moves edge, strip and gravity together: must not change the result
    Vec3 carried = Vec3::Zero();   ///< m/s, common velocity of edge and strip: must not change the result
    double friction = 0.0;         ///< coefficient
    double lean = 0.0;             ///< rad, by which gravity leans along the edge
    std::optional<Cut> seam = {};  ///< by which the strip is sewn of two
};

/// Distance of `world` from the line of the fold, m, perpendicular to the edge. That line is at the stand-off
/// from both slopes.
double distance_from_bend(const StripCase& strip, double time, const Vec3& world);

/// A run with the strip bent over the edge, at its stand-off from both slopes. The edge is the y axis before
/// `place` moves it.
ClothRun make_strip_run(const StripCase& strip);

double strip_mass(const StripCase& strip);  ///< kg

/// x of the strip's end, m.
double measure_length_after(const StripCase& strip, const ClothRun& run);

}  // namespace arris
