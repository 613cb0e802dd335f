// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace arris {

// What counts as equal, by where the difference comes from. All are shares; the place of use names the whole.

// --- differences by computing

/// Rounding of the scalar product of a unit vector and a difference of points, relative to the difference.
/// The product rounds 4 times, the difference once, an interpolation 3 times, each by half an epsilon. The
/// factor 2 covers the normal's own rounding. Raising it costs proofs that two elements are apart.
inline constexpr double kProductRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// Some units in the last place of a number: what is left where terms of its size cancel. Relative to that
/// size. Raising it takes small differences for none.
inline constexpr double kLastPlaces = 1e-15;

/// Lengths and times that differ by less, relative to their scale, differ by the rounding of some dozens of
/// operations. Far above the rounding of one difference (1e-14). Raising it takes small lengths for none.
inline constexpr double kComputed = 1e-12;

/// Positions in space also carry the rounding of what came before: earlier steps, earlier folds. Elements
/// nearer than this share of their boxes' size count as touching. Raising it stops cloth farther off.
inline constexpr double kTouching = 1e-11;

/// Energies, gaps and directions that have gone through sums over elements or a linear solve carry more
/// rounding, relative to their size. Raising it takes small changes for none.
inline constexpr double kAccumulated = 1e-9;

/// Distance, in the cloth's thicknesses, within which a point lies on a surface or in a plane. Raising it
/// takes cloth just beside a feature for cloth on it.
inline constexpr double kOnSurface = 1e-6;

// --- differences by the numbers in a file

/// Files in single precision are exact to 6e-8 of their size; exporters lose another digit. Relative to a
/// mesh's or polygon's size, or the angle (rad) by which that turns a face. Raising it welds fine detail.
inline constexpr double kSinglePrecision = 1e-6;

/// Files round numbers to three digits at worst: a larger difference is meant. Raising it hides shape.
inline constexpr double kThreeDigits = 1e-3;

// --- directions

/// Sine of an angle below which the side of a plane or line that a direction leads to is rounding.
inline constexpr double kLevel = 1e-6;

/// Sine of a bend below which a polyline is straight: its two edges share their contacts and vertices.
/// Raising it drops contacts at weak bends.
inline constexpr double kStraight = 1e-4;

/// Sine of the angle below which two edges count as parallel (1 degree): their cross product is no reliable
/// direction. Raising it leaves more crossings to the contacts of vertices.
inline constexpr double kParallel = 0.0175;

}  // namespace arris
