// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/IOSystem.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

// For .cpp files of the geometry layer only: no other layer includes assimp.
namespace arris {

/// Reads a regular file of at most `limit` bytes. Refuses a pipe, device or folder without blocking. Throws
/// InputError without the file's name.
std::string read_regular_file(const std::filesystem::path& path, std::uintmax_t limit);

/// Restricts the files that assimp may open. These are the mesh itself, under the name `main_name`, from
/// bytes already read and checked, and regular files in `folder` or below, with links followed. Any other
/// file is reported as missing, and its name is recorded.
class MeshFolderIo : public Assimp::IOSystem {
  public:
    MeshFolderIo(std::string main_name, const std::string& main_bytes, const std::filesystem::path& folder);

    bool Exists(const char* name) const override;
    char getOsSeparator() const override { return '/'; }
    /// The caller owns the stream: importers either Close or delete it.
    Assimp::IOStream* Open(const char* name, const char* mode) override;
    void Close(Assimp::IOStream* stream) override;

    /// One sentence for each file that was requested and refused, in order, without duplicates.
    const std::vector<std::string>& refusals() const { return refusals_; }

  private:
    bool is_main(const std::string& name) const;
    std::string find_inside(const std::string& name) const;
    void refuse(const std::string& name, const std::string& why) const;

    std::string main_name_;
    const std::string& main_bytes_;
    std::filesystem::path folder_;
    mutable std::vector<std::string> refusals_;
};

}  // namespace arris
