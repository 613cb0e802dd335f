// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Walks a PLY file (Turk's format: text, or binary of either byte order) from its header to its last
/// element. Throws InputError, without the file's name, for a header that is none, a list or element longer
/// than what is left of the file, and faces that name a vertex out of range. Returns a warning for elements
/// `edge`, which importers leave out. Linear in the bytes; allocates nothing by the header's counts.
std::vector<std::string> check_ply(std::string_view bytes);

}  // namespace arris
