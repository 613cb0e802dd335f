// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace arris {

namespace {

std::string format_duration(double seconds)
{
    const long whole =
        std::lround(std::clamp(seconds, 1.0, 359999.0));  // "0 s left" would say that it is over
    if (whole >= 3600) return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
    if (whole >= 60) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} s", whole);
}

}  // namespace

Progress::Progress(double from, bool is_quiet)
    : from_(from), is_quiet_(is_quiet), is_terminal_(isatty(STDOUT_FILENO) == 1), start_(Clock::now())
{
}

void Progress::update(double time, double to, const std::string& detail)
{
    if (is_quiet_ || !(to > from_)) return;
    const double share = std::clamp(time / to, 0.0, 1.0);
    const double own = std::clamp((time - from_) / (to - from_), 0.0, 1.0);  // share of this process
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    std::string left;
    if (share < 1.0) left = "  " + (own > 0.0 ? format_duration(elapsed * (1.0 - own) / own) : "?") + " left";

    if (!is_terminal_) {
        constexpr auto kSilence = std::chrono::minutes(1);
        const int tenths = static_cast<int>(10.0 * share);
        if (tenths <= tenths_told_ && now - last_told_ < kSilence) return;
        tenths_told_ = std::max(tenths, tenths_told_);
        last_told_ = now;
        fmt::print("{:3.0f} %  t = {:.3f} s  {}{}\n", 100.0 * share, time, detail, left);
        std::fflush(stdout);
        return;
    }
    constexpr auto kRedraw = std::chrono::milliseconds(100);
    if (share < 1.0 && now - last_told_ < kRedraw) return;
    last_told_ = now;
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(kWidth * share);
    // \x1b[K clears the rest of a longer previous line.
    fmt::print("\r[{}{}] {:3.0f} %  t = {:.3f} s  {}{}\x1b[K", std::string(filled, '#'),
               std::string(kWidth - filled, '.'), 100.0 * share, time, detail, left);
    std::fflush(stdout);
    is_line_open_ = true;
}

void Progress::finish()
{
    if (is_line_open_) fmt::print("\n");
    std::fflush(stdout);
    is_line_open_ = false;
}

}  // namespace arris
