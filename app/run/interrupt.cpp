// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace arris {

namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_signal(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL);
    constexpr char kMessage[] =
        "\narris: stopping; a second Ctrl-C stops at once (arris resume continues in both "
        "cases)\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
}

}  // namespace

void watch_for_interrupt()
{
    interrupted = 0;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGHUP, on_signal);
}

bool is_interrupted()
{
    return interrupted != 0;
}

}  // namespace arris
