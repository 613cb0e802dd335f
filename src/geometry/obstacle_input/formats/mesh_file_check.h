// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Extensions (lower case, without the dot) of the mesh formats that are read.
const std::vector<std::string>& mesh_extensions();

/// The bytes without the byte-order marks that the import library does not skip. Throws InputError, without
/// the file's name, for text in UTF-16 where the library reads ASCII or UTF-8 only.
std::string without_marks(const std::string& extension, std::string bytes);

/// Compares the declarations in a mesh file with its bytes, before the import library trusts them. Rejects
/// counts and lengths beyond the file's end, truncation, and content of another format. For formats that are
/// checked elsewhere (OBJ, STL, PLY, COLLADA, glTF, 3MF) only the first bytes are looked at, if any.
/// Throws InputError, a sentence without the file's name.
void check_mesh_bytes(const std::string& extension, std::string_view bytes);

}  // namespace arris
