// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/LogStream.hpp>
#include <string>
#include <vector>

// For .cpp files of the geometry layer only: no other layer sees assimp.
namespace arris {

/// Takes assimp's warnings and errors for as long as it lives, each once, without those on materials,
/// textures and such: obstacles have no looks. One at a time in a process.
class ImportLog : public Assimp::LogStream {
  public:
    ImportLog();
    ~ImportLog() override;
    ImportLog(const ImportLog&) = delete;
    ImportLog& operator=(const ImportLog&) = delete;

    void write(const char* message) override;

    /// Throws InputError for what some readers only mention, going on with faces left out or bent to other
    /// vertices.
    void require_no_damage() const;

    /// Appends the first of what was logged, and how much more there was.
    void append_to(std::vector<std::string>& warnings) const;

  private:
    std::vector<std::string> lines_;
    std::size_t left_out_ = 0;
    std::string damage_;
};

}  // namespace arris
