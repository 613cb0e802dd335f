// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlopt.hpp>
#include <vector>

namespace arris {

/// Runs `optimizer` from x and stores the last iterate in x. Ending by round-off or by a "failure" is a
/// legitimate outcome: NLopt updates x before it throws, and a certificate judges the result later.
inline void improve(nlopt::opt& optimizer, std::vector<double>& x)
{
    double value = 0.0;
    try {
        optimizer.optimize(x, value);
    } catch (const nlopt::roundoff_limited&) {
    } catch (const nlopt::forced_stop&) {
    } catch (const std::runtime_error&) {
    }
}

/// Vectors that the quasi-Newton method stores. NLopt's default is up to 1e6/n vectors, which is 9 times
/// slower.
constexpr unsigned kStoredVectors = 5;

/// NLopt's methods treat 1e-8 as zero, for gradients and for distances to bounds. Unknowns are scaled to
/// about 1e3, so that 1e-8 is 1e-11 of a typical unknown.
constexpr double kTypicalUnknown = 1e3;

}  // namespace arris
