// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace arris {

/// Wall seconds since the last lap.
class Stopwatch {
  public:
    double lap()
    {
        const Clock::time_point now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point last_ = Clock::now();
};

}  // namespace arris
