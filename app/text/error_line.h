// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <string>

namespace arris {

/// The message of an error in one line. For an error of the file system: the file and the reason, without the
/// name of the failed library call.
std::string error_line(const std::exception& error);

}  // namespace arris
