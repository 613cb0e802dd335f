// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// Inserts a 0 before each decimal point that begins a number of a vertex, normal or texture coordinate in an
/// OBJ file. The importer (assimp 5.2) does not read such a word as a number, and leaves the vertex out.
std::string spell_out_numbers(std::string_view obj);

}  // namespace arris
