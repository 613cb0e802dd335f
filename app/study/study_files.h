// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/study/analysis.h"

namespace arris {

/// Where and with what the runs were made.
struct StudyProvenance {
    std::string version;  ///< with the program's fingerprint
    std::string build;    ///< compiler and flags
    std::vector<std::string> machines;
    std::string engine;
};

/// study.csv: a column for each varied key, then the columns of docs/study.md; failed runs are rows.
std::string study_csv(const Study& study, const std::vector<RunOutcome>& outcomes);

/// study.json: the sentence, the fitted slopes, the front, where it was made.
nlohmann::ordered_json study_json(const Study& study, const std::vector<RunOutcome>& outcomes,
                                  const StudyProvenance& provenance);

/// study.html, complete in itself; `svg` is the study's drawing.
std::string study_html(const Study& study, const std::vector<RunOutcome>& outcomes,
                       const StudyProvenance& provenance, const std::string& svg);

}  // namespace arris
