// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

enum class Integrator { ImplicitEuler, Bdf2 };

/// Numbers a user may choose.
struct Settings {
    Integrator integrator = Integrator::Bdf2;
    double step = 0.005;      ///< s, the longest step
    double tolerance = 1e-9;  ///< greatest relative KKT residual accepted; lower is free down to about 1e-12
};

}  // namespace arris
