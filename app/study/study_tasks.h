// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/study/study_runs.h"
#include "app/study/task.h"

namespace arris {

/// The tasks of all runs and their repetitions: `arris run` with one thread. A task's fingerprint covers the
/// program's bytes, the scene's text, the mesh files that it names, and all settings.
std::vector<Task> make_tasks(const Study& study, const std::vector<StudyRun>& runs, const TaskFolder& folder);

/// Version and fingerprint of this program.
std::string describe_version();

}  // namespace arris
