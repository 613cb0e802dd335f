// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/report.h"

namespace arris {

struct RunRequest {
    std::string scene;                   ///< path
    std::string directory;               ///< empty: out/<scene file's stem>
    std::vector<std::string> overrides;  ///< KEY=VALUE
    bool is_overwriting = false;
    bool is_assembly_alone = false;  ///< ends when the cloth is sewn
    bool is_quiet = false;
    int threads = 0;                ///< 0: as many as the machine has
    std::string program = "arris";  ///< as it was called, for advice
};

struct ResumeRequest {
    std::string directory;
    std::optional<double> until;  ///< s, instead of the scene's duration
    bool is_quiet = false;
    int threads = 0;
    std::string program = "arris";  ///< as it was called, for advice
};

/// Simulate a scene, or continue from a checkpoint, and write the files of docs/output.md. Whatever the
/// ending, results so far and a checkpoint are kept. Throw InputError for invalid input, std::system_error if
/// nothing can be written.
RunStatus run(const RunRequest& request);
RunStatus resume(const ResumeRequest& request);

}  // namespace arris
