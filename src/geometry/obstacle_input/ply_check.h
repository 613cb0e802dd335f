// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Walks a PLY file (Turk's format: text, or binary of either byte order) from its header to its last
/// element. Throws InputError, without the file's name, for an invalid header and for faces that name a
/// vertex out of range. Also throws for a list or element longer than the rest of the file. Returns a warning
/// for elements `edge`, which importers leave out. Linear in the number of bytes; no allocation depends on
/// the header's counts.
std::vector<std::string> check_ply(std::string_view bytes);

}  // namespace arris
