// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/Importer.hpp>
#include <string>

// For .cpp files of the geometry layer only: no other layer includes assimp.
namespace arris {

/// Leaves `importer` only the reader of files with this extension. Throws InputError if there is none.
void keep_reader_of(const std::string& extension, Assimp::Importer& importer);

}  // namespace arris
