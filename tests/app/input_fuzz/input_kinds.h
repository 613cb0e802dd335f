// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace arris {

/// A kind of file that the program reads.
struct InputKind {
    std::string name;  ///< of the kind, such as "binary STL"
    std::string file;  ///< name of its files
    std::string seed;  ///< a sound file, or what `write` makes one of
    /// Writes a file of `bytes`; may add what a reader checks first (a checksum, an archive), so that the
    /// changed bytes are read.
    std::function<void(const std::string& path, const std::string& bytes)> write;
    /// Reads the file as the program does, and checks the result. Throws InputError for a file that is
    /// refused. Returns the defect of what was accepted; empty if there is none.
    std::function<std::string(const std::string& path)> read;
};

/// All kinds. `importer`: program and arguments that import a mesh file in a separate process. Files that
/// seeds refer to are written into `folder`.
std::vector<InputKind> list_input_kinds(const std::vector<std::string>& importer, const std::string& folder);

}  // namespace arris
