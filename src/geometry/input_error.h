// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace arris {

/// Bad input (a file, a scene key, an argument). `what()` is one line that names the file, the field, the
/// value and what is allowed. Only `main` catches it: it prints the line and returns 2.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& line) : std::runtime_error(line) {}
};

}  // namespace arris
