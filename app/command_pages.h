// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace arris {

// Pages made from the commands and options that the program parses, so that nothing is listed twice.

/// Names of all commands: "run, resume, ...".
std::string list_commands(const CLI::App& app);

/// A manual page (roff, section 1) with the descriptions, options and examples that --help prints.
std::string man_page(const CLI::App& app, const std::string& version);

/// A script for bash that completes commands, options, the words that an option allows, and file names.
std::string bash_completion(const CLI::App& app);

}  // namespace arris
