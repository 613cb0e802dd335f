// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace arris {

/// What is wrong with a formula in t; empty if nothing is. Functions and operators are those of muParser
/// (sin, cosh, sqrt, exp, ln, ^, ...); `pi` is defined.
std::string formula_error(const std::string& formula);

/// Values of a valid formula at these times (s). Throws InputError naming the first time at which the value
/// is not finite.
std::vector<double> evaluate_formula(const std::string& formula, const std::vector<double>& times);

}  // namespace arris
