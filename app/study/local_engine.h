// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "app/study/task.h"

namespace arris {

/// Called when a task has ended.
using TaskEnded = std::function<void(const Task& task, const TaskEnd& end)>;

/// Runs tasks as child processes, `jobs` at a time, each with one thread. Returns false if it was interrupted
/// (interrupt.h); then all children have ended. Children die with the calling thread. Throws
/// std::system_error if no process can be started.
bool run_locally(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs, const TaskEnded& ended);

}  // namespace arris
