// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <time.h>

namespace arris {

/// CPU seconds of this thread. Wall time would include other processes of a shared machine.
inline double thread_seconds()
{
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace arris
