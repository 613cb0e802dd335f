// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace arris {

/// The files of a ZIP archive (PKWARE's APPNOTE 6.3, with its 64-bit fields): stored or deflated, in one
/// part, not encrypted. Names are compared without regard to case, as in Office packages; a backslash
/// separates folders as a slash does. The bytes must outlive the archive. All functions throw InputError,
/// without the archive's name.
class ZipArchive {
  public:
    explicit ZipArchive(std::string_view bytes);

    bool contains(const std::string& name) const;

    /// Unpacks a file and compares its checksum. Refuses a name that two files have.
    std::string read(const std::string& name) const;

  private:
    struct Entry {
        std::uint64_t method = 0;
        std::uint64_t packed_size = 0;
        std::uint64_t size = 0;
        std::uint64_t header = 0;  // position of its local header
        std::uint64_t checksum = 0;
        bool is_encrypted = false;
        bool is_double = false;  // another file has the same name
    };

    std::uint64_t read_entry(std::uint64_t at);
    std::string_view packed(const Entry& entry) const;

    std::string_view bytes_;
    std::map<std::string, Entry> entries_;
};

}  // namespace arris
