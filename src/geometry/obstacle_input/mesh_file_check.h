// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Extensions (lower case, without the dot) of the mesh formats that are read.
const std::vector<std::string>& mesh_extensions();

/// The file's text in the one spelling that importers read (canonical_obj, canonical_stl), or without its
/// byte-order mark; other bytes unchanged. Throws InputError, without the file's name, for UTF-16.
std::string canonical_bytes(const std::string& extension, std::string bytes);

/// Compares the declarations in a mesh file with its canonical bytes, before an importer trusts them. Rejects
/// counts and lengths beyond the file's end, truncation, indices out of range, and content of another format.
/// For formats that an importer checks by itself (COLLADA, FBX, glTF's JSON) only the first bytes are looked
/// at.
///
/// Throws InputError, a sentence without the file's name (with line, vertex or face where known). Returns
/// warnings about content that an importer would drop silently. Linear in the number of bytes.
std::vector<std::string> check_mesh_bytes(const std::string& extension, std::string_view bytes);

}  // namespace arris
