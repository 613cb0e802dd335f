// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

namespace arris {

/// Prints the progress of a run on standard output: on a terminal a bar with the time left, else a plain line
/// after each 10 %, and each minute.
class Progress {
  public:
    /// `from`: simulated seconds at which this process begins, from which the time left is judged. Prints
    /// nothing if `is_quiet`.
    Progress(double from, bool is_quiet);

    /// Tells that the run has come to `time` of `to`, simulated seconds from 0. `detail`: a few words on the
    /// step, such as "3281 vertices".
    void update(double time, double to, const std::string& detail);

    /// Ends the terminal line of the bar.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    double from_;
    bool is_quiet_, is_terminal_, is_line_open_ = false;
    int tenths_told_ = 0;
    Clock::time_point start_, last_told_ = start_;
};

}  // namespace arris
