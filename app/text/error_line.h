// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <string>

namespace arris {

/// One line for a person: of an error of the file system the file and what is wrong, not the library's call
/// that met it.
std::string error_line(const std::exception& error);

}  // namespace arris
