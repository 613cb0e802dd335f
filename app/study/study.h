// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

enum class StudyEngine { Local, Slurm };

struct StudyRequest {
    std::string study;      ///< path of the study file
    std::string directory;  ///< empty: out/<study file's stem>
    int jobs = 0;           ///< processes at a time; 0: as many as the machine has cores (slurm: no limit)
    StudyEngine engine = StudyEngine::Local;
    bool is_overwriting = false;  ///< runs again what has finished
    bool is_quick = false;        ///< the study's coarse variant
    bool is_quiet = false;
};

/// Runs a study and writes study.csv, study.json, study.svg and study.html. Returns the exit status: 0 done
/// (runs that failed are rows), 1 no run finished, 130 interrupted; finished runs are then kept, and the same
/// request goes on with the others. Throws InputError for invalid input.
int run_study(const StudyRequest& request);

}  // namespace arris
