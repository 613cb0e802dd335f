// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// The tables of what follows what in a step, for docs/method.md: how rounds end, and what follows a failed
/// attempt. Markdown.
std::string step_markdown();

}  // namespace arris
