// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

#include "app/files/frame.h"

namespace arris {

/// Two triangles over a folded edge, with numbers that are easily lost: -0, denormals, the greatest double,
/// thirds.
inline Frame make_example_frame()
{
    constexpr double kTiny = std::numeric_limits<double>::denorm_min(), kHuge = 1e308;
    Frame frame;
    frame.world = {
        {-0.0, kTiny, 1.0 / 3.0}, {0.1, 0.0, -kHuge}, {1e-7, 1.0, 123456789.123456789}, {1.0, 1.0, 0.3}};
    frame.material = {{0.0, -0.0}, {0.1, 0.0}, {1.0 / 7.0, 1.0}, {1.0, 5e-324}};
    frame.vertex_velocity = {{1.0, 2.0, 3.0}, {-1e-300, 0.0, -0.0}, {0.2, 0.3, 0.4}, {kHuge, -kHuge, kTiny}};
    frame.material_velocity = {{-1.0, -2.0, -3.0}, {0.7, 0.8, 0.9}, {0.0, 0.0, 0.0}, {1.1, 1.2, 1.3}};
    frame.ids = {0, 7, 4294967295U, 12};
    frame.eol = {0, 1, 1, 2};
    frame.contact = {0, 1, 0, 1};
    frame.faces = {{0, 1, 2}, {2, 1, 3}};
    frame.strain = {0.01, -0.0};
    frame.stretch_energy = {kTiny, 1e-3};
    frame.bending_energy = {0.0, 2.0 / 3.0};
    frame.eol_edges = {{1, 2}};
    return frame;
}

/// The same cloth at another place, as it would be in frame `i`.
inline Frame make_moved_frame(int i)
{
    Frame frame = make_example_frame();
    frame.world[1] = {0.1 * i, 0.0, -0.01 * i};
    return frame;
}

}  // namespace arris
