// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace arris {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

[[noreturn]] void fail(const char* what, const std::string& path)
{
    throw std::system_error(errno, std::generic_category(), std::string(what) + " " + path);
}

bool is_still_named(int descriptor, const std::string& path)
{
    struct stat opened = {}, named = {};
    return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

// Some network file systems have no locks. So a failed lock is an error only if another process holds it.
bool is_locked_by_another(int descriptor)
{
    return flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

// The file is truncated only after the lock is held and the name checked: between opening and locking,
// another process may have renamed it to its final name. Then the descriptor is a finished file, and we open
// again.
int open_temporary(const std::string& path)
{
    for (int attempt = 0; attempt < 100; ++attempt) {
        const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) fail("cannot create", path);
        const bool is_locked = is_locked_by_another(descriptor);
        if (!is_locked && is_still_named(descriptor, path) && ftruncate(descriptor, 0) == 0)
            return descriptor;
        close(descriptor);
        if (is_locked) break;
    }
    errno = EBUSY;
    fail("another process is writing", path);
}

}  // namespace

void write_fully(int descriptor, std::string_view bytes, const std::string& path)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("cannot write", path);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), temporary_(path + ".tmp")
{
    descriptor_ = open_temporary(temporary_);
}

AtomicFile::~AtomicFile()
{
    if (descriptor_ < 0) return;
    unlink(temporary_.c_str());
    close(descriptor_);
}

void AtomicFile::write(std::string_view bytes)
{
    buffer_ += bytes;
    if (buffer_.size() >= kBufferBytes) flush();
}

void AtomicFile::flush()
{
    write_fully(descriptor_, buffer_, path_);
    buffer_.clear();
}

void AtomicFile::commit()
{
    flush();
    // Rename while the lock is held. Network file systems report a full disk only on closing, so close a copy
    // of the descriptor first.
    const int copy = dup(descriptor_);
    if (copy < 0 || close(copy) != 0) fail("cannot write", path_);
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot create", path_);
    close(descriptor_);
    descriptor_ = -1;
}

void write_atomically(const std::string& path, std::string_view bytes)
{
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace arris
