// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Extensions (lower case, without the dot) of the mesh formats that are read.
const std::vector<std::string>& mesh_extensions();

/// Holds what the bytes of a mesh file declare against what they are, before an importer believes them:
/// counts and lengths that the file is too short for, truncation, indices out of range, content of another
/// format. Formats that an importer checks by itself (COLLADA, FBX, glTF's JSON) pass with a glance at their
/// first bytes. Throws InputError, a sentence without the file's name (with line, vertex or face where
/// known). Returns warnings about what an importer would drop without a word. Linear in the bytes.
std::vector<std::string> check_mesh_bytes(const std::string& extension, std::string_view bytes);

}  // namespace arris
