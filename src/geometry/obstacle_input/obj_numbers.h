// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// The text of an OBJ file with a 0 before each decimal point that begins a number of its vertices, normals
/// and texture coordinates. The importer (assimp 5.2) takes such a word for none, and leaves the vertex out.
std::string spell_out_numbers(std::string_view obj);

}  // namespace arris
