// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/study/study_file.h"

namespace arris {

/// One run of a study.
struct StudyRun {
    std::string name;               ///< of its folder; depends on its settings alone
    std::vector<Setting> settings;  ///< of the varied keys; of a further run also those of the reference
    bool is_further = false;        ///< runs only as a reference
    std::string
        problem;  ///< settings that change the problem, where the reference is a run: only equal ones compare
    nlohmann::ordered_json scene;  ///< as run, defaults included, before rules between keys
};

/// Fineness of a run: "finest" is the greatest.
struct Fineness {
    double cells = 0.0;       ///< cloth.resolution; 0 for cloth from a file or an outline
    double least_step = 0.0;  ///< s
};
Fineness fineness_of(const StudyRun& run);

/// The runs of a study in its order, then the further runs for references. Throws InputError if a setting is
/// not valid for the scene, or if the error's probe, column or reference file does not exist.
std::vector<StudyRun> list_runs(const Study& study);

/// "KEY=VALUE" of all settings of a run, those common to all runs first.
std::vector<std::string> list_overrides(const Study& study, const StudyRun& run);

}  // namespace arris
