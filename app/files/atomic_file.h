// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// A file that appears under its name whole or not at all: it is written as `<path>.tmp` and renamed by
/// commit(). Without a commit the temporary is removed and what stood under the name before stays. A
/// temporary left by a killed process is overwritten; one that another process is writing is an error. This
/// guards against a process that stops anywhere, not against a machine that loses power (nothing is synced).
/// All members throw std::system_error naming the path and the system's reason.
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

/// The same for contents that are in memory already.
void write_atomically(const std::string& path, std::string_view bytes);

/// Writes all of `bytes` to an open file, however many calls the system needs; throws as above.
void write_fully(int descriptor, std::string_view bytes, const std::string& path);

}  // namespace arris
