// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// A file that appears under its name complete or not at all: `<path>.tmp` is written, and commit() renames
/// it. Without commit() the temporary file is removed and the previous file stays. A temporary file of a
/// killed process is overwritten; a temporary file that another process is writing is an error. Safe against
/// a killed process, not against a power failure (nothing is synced). All members throw std::system_error
/// naming the path and the system's reason.
class AtomicFile {
  public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void commit();

  private:
    void flush();

    std::string path_, temporary_;
    std::string buffer_;
    int descriptor_ = -1;
};

/// Writes a whole AtomicFile at once.
void write_atomically(const std::string& path, std::string_view bytes);

/// Writes all of `bytes` to an open file, in as many calls as needed. Throws as AtomicFile does.
void write_fully(int descriptor, std::string_view bytes, const std::string& path);

}  // namespace arris
