// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace arris {

/// A seam that is not closed where the cloth is made.
struct OpenSeam {
    std::string name;  ///< for messages
    std::int32_t order = 0;
    bool is_tie = false;  ///< is never welded: stays a row of springs
};

/// How the seams of a scene close.
struct Sewing {
    std::vector<OpenSeam> seams;
    double speed = 0.5;   ///< m/s, greatest, at which two sides come together
    double settle = 0.5;  ///< s, for the cloth to come to rest once all are closed
};

/// Vertices of the two sides of a seam that are to come together.
struct SeamPair {
    std::array<std::uint32_t, 2> vertex_ids;
    std::int32_t seam;  ///< index in the scene's sewing
    double gap;         ///< m, between them where the seam began to close; once all have closed, that is kept
};

/// The seams that close at present: those of one order.
struct Closing {
    static constexpr std::int32_t kAllClosed = std::numeric_limits<std::int32_t>::max();

    std::int32_t order = std::numeric_limits<std::int32_t>::min();
    double begin = 0.0, end = 0.0;  ///< s: gaps shrink from one to the other
};

}  // namespace arris
