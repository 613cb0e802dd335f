// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "geometry/input_error.h"

namespace arris {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
    throw InputError(path + ": " + why);
}

}  // namespace

InputFile::InputFile(std::string path) : path_(std::move(path))
{
    // Without O_NONBLOCK a pipe without a writer would block.
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) refuse(path_, errno == ENOENT ? "no such file" : std::strerror(errno));
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(descriptor_);
        refuse(path_, "not a regular file");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile()
{
    ::close(descriptor_);
}

void InputFile::read(std::uint64_t offset, char* bytes, std::size_t count) const
{
    while (count > 0) {
        const ssize_t got = ::pread(descriptor_, bytes, count, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) refuse(path_, std::strerror(errno));
        if (got == 0) refuse(path_, "has become shorter while it is read");
        bytes += got;
        offset += static_cast<std::uint64_t>(got);
        count -= static_cast<std::size_t>(got);
    }
}

}  // namespace arris
