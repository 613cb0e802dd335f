// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/study/local_engine.h"

namespace arris {

/// Throws InputError if Slurm's sbatch or squeue is not on the PATH.
void require_slurm();

/// Runs tasks as Slurm job arrays, at most `jobs` at a time (0: as Slurm decides). Waits until all have
/// ended. How a task ended comes from the files that it leaves, not from Slurm's accounting. Tasks of an
/// earlier call that are still queued or running are waited for, not submitted again. Returns false if it was
/// interrupted; the arrays then go on. A task that leaves the queue without an exit file is reported as
/// killed. Throws std::runtime_error with Slurm's message if a submission fails.
bool run_with_slurm(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs,
                    const TaskEnded& ended);

}  // namespace arris
