// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <string>

namespace arris {

/// The bytes of a file after one to four random changes: cut off, a bit or byte or number replaced, a range
/// removed, repeated or moved. The same for the same state of `random`.
std::string mutate(std::string bytes, std::mt19937& random);

}  // namespace arris
