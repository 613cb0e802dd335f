// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// `text` as one printable word of a shell command: in single quotes where it has blanks or other characters
/// that a shell reads.
std::string shell_word(std::string_view text);

/// The command that continues the run in `directory`; `program` as it was called.
std::string resume_command(std::string_view program, std::string_view directory);

}  // namespace arris
