// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlopt.hpp>
#include <vector>

namespace arris {

/// Runs `optimizer` from x, and leaves in x how far it came. Ending by round-off or by a "failure" is a
/// legitimate outcome here: x is updated before NLopt throws, and what it is worth is judged afterwards, by a
/// certificate.
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

/// Vectors the quasi-Newton method remembers; NLopt's default is up to 1e6/n of them and 9 times slower.
constexpr unsigned kStoredVectors = 5;

/// NLopt's methods treat 1e-8 as zero, for gradients and for distances to bounds: unknowns are scaled to be
/// typically 1e3, so that this means 1e-11 of what is typical.
constexpr double kTypicalUnknown = 1e3;

}  // namespace arris
