// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace arris {

namespace {

volatile std::sig_atomic_t interrupted = 0;
std::string_view told;  // written before handlers are installed

void on_signal(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL);
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, told.data(), told.size());
}

}  // namespace

void watch_for_interrupt(std::string_view message)
{
    interrupted = 0;
    told = message;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGHUP, on_signal);
}

bool is_interrupted()
{
    return interrupted != 0;
}

}  // namespace arris
