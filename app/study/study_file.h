// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/setting.h"

namespace arris {

/// Definition of a run's error: the measured quantity, the reference and the norm.
struct ErrorRule {
    enum class Quantity {
        Probe,   ///< displacement of a probe since time 0 along an axis
        Column,  ///< a column of steps.csv
        Shape    ///< distance between two cloths at equal material points
    };
    enum class Reference {
        None,     ///< the quantity itself is the error
        Formula,  ///< in the time t
        File,     ///< CSV
        Finest,   ///< the finest finished run of the study with the same problem
        Run       ///< a further run with settings of its own
    };
    enum class Norm { Max, Rms, Final, Mean };

    Quantity quantity = Quantity::Probe;
    std::string probe;
    int axis = 2;
    std::string column;
    bool is_over_all_frames = false;  ///< of a shape; else the last frame alone

    Reference reference = Reference::None;
    std::string formula;                 ///< or the CSV file's path
    std::vector<Setting> reference_run;  ///< replace or add to the settings of a run
    Norm norm = Norm::Max;
};

/// A study file.
struct Study {
    std::string path;
    std::string title;
    std::string scene;                       ///< path of the scene file
    std::vector<Setting> common;             ///< of every run
    std::vector<std::string> keys;           ///< that are varied
    std::vector<std::vector<Setting>> runs;  ///< settings of varied keys, in the order of `keys`
    std::vector<std::string> telling_keys;   ///< keys without those whose values the others determine
    std::vector<std::string> axis_keys;      ///< telling keys in which alone some runs differ, with numbers
    std::optional<ErrorRule> error;
    int repeats = 1;
    bool is_quick = false;
};

/// Reads a study file; with `is_quick`, with the keys that its table `quick` has in place of its own. Throws
/// InputError naming file, line, key, value and what is allowed. Scene keys are not checked here.
Study read_study(const std::string& path, bool is_quick);

}  // namespace arris
