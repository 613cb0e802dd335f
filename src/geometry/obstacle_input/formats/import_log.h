// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/LogStream.hpp>
#include <string>
#include <vector>

// For .cpp files of the geometry layer only: no other layer includes assimp.
namespace arris {

/// Collects assimp's warnings and errors while it exists, without duplicates. Omits messages on materials and
/// textures, which obstacles do not use. At most one instance per process.
class ImportLog : public Assimp::LogStream {
  public:
    ImportLog();
    ~ImportLog() override;
    ImportLog(const ImportLog&) = delete;
    ImportLog& operator=(const ImportLog&) = delete;

    void write(const char* message) override;

    /// Throws InputError for damage that some readers only log. Such readers go on with faces left out or
    /// assigned to wrong vertices.
    void require_no_damage() const;

    /// Appends the first messages, and the number of further ones.
    void append_to(std::vector<std::string>& warnings) const;

  private:
    std::vector<std::string> lines_;
    std::size_t left_out_ = 0;
    std::string damage_;
};

}  // namespace arris
