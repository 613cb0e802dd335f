// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace arris {

/// 16 hexadecimal digits (FNV-1a) that differ for different lists of texts, but for chance. Not a
/// cryptographic hash.
std::string fingerprint(const std::vector<std::string>& texts);

/// Fingerprint of a file's bytes; of a file that cannot be read, of its absence.
std::string file_fingerprint(const std::string& path);

}  // namespace arris
