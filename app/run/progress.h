// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

namespace arris {

/// Tells on standard output how far a run is: a bar with the time left on a terminal, else a plain line each
/// tenth.
class Progress {
  public:
    /// `from` and `to` in simulated seconds. Says nothing at all where `is_quiet`.
    Progress(double from, double to, bool is_quiet);

    /// `detail`: a few words on the step, such as "3281 vertices".
    void update(double time, const std::string& detail);

    /// Leaves the terminal on a fresh line.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    double from_, to_;
    bool is_quiet_, is_terminal_, is_line_open_ = false;
    int tenths_told_ = 0;
    Clock::time_point start_, last_drawn_;
};

}  // namespace arris
