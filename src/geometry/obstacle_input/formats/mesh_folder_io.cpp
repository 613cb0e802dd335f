// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/mesh_folder_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

std::string read_descriptor(int fd, std::uintmax_t limit)
{
    struct stat status {};
    if (::fstat(fd, &status) != 0) throw InputError(std::strerror(errno));
    if (!S_ISREG(status.st_mode)) throw InputError("not a regular file");
    const auto size = static_cast<std::uintmax_t>(status.st_size);
    if (size > limit) throw InputError(fmt::format("{} bytes; allowed are at most {}", size, limit));
    std::string bytes(size, '\0');
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw InputError(std::strerror(errno));
        if (got == 0) throw InputError("became shorter while it was read");
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

// Reads bytes that are owned by the stream or by its creator.
class BytesStream : public Assimp::IOStream {
  public:
    explicit BytesStream(std::string owned) : owned_(std::move(owned)), bytes_(owned_) {}
    explicit BytesStream(std::string_view bytes) : bytes_(bytes) {}
    BytesStream(const BytesStream&) = delete;
    BytesStream& operator=(const BytesStream&) = delete;

    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override
    {
        if (size == 0) return 0;
        const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
        if (whole > 0) std::memcpy(buffer, bytes_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }

    // Some importers seek back by a negative offset, which wraps around.
    aiReturn Seek(std::size_t offset, aiOrigin origin) override
    {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        const std::size_t target = origin == aiOrigin_END ? base - offset : base + offset;
        if (target > bytes_.size()) return aiReturn_FAILURE;
        at_ = target;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return at_; }
    std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::string owned_;
    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace

std::string read_regular_file(const fs::path& path, std::uintmax_t limit)
{
    // Without O_NONBLOCK, opening a pipe would block.
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) throw InputError(errno == ENOENT ? "no such file" : std::strerror(errno));
    try {
        std::string bytes = read_descriptor(fd, limit);
        ::close(fd);
        return bytes;
    } catch (...) {
        ::close(fd);
        throw;
    }
}

MeshFolderIo::MeshFolderIo(std::string main_name, const std::string& main_bytes, const fs::path& folder)
    : main_name_(std::move(main_name)), main_bytes_(main_bytes), folder_(fs::canonical(folder))
{
}

bool MeshFolderIo::is_main(const std::string& name) const
{
    return fs::path(name).lexically_normal() == main_name_;
}

// The resolved path of `name`, links followed. Empty, with a refusal recorded, where that is not inside the
// folder.
std::string MeshFolderIo::find_inside(const std::string& name) const
{
    const fs::path asked(name);
    const bool climbs = std::find(asked.begin(), asked.end(), "..") != asked.end();
    if (asked.is_absolute() || climbs || name.find('\\') != std::string::npos) {
        refuse(name, "is not inside the mesh's own folder");
        return {};
    }
    std::error_code error;
    const fs::path real = fs::canonical(folder_ / asked, error);
    if (error) return {};
    const auto [end, unused] = std::mismatch(folder_.begin(), folder_.end(), real.begin(), real.end());
    if (end != folder_.end()) {
        refuse(name, "leads out of the mesh's own folder");
        return {};
    }
    return real.string();
}

void MeshFolderIo::refuse(const std::string& name, const std::string& why) const
{
    const std::string sentence = fmt::format("'{}' {} and was not read", name, why);
    if (refusals_.size() < kMostNotes &&
        std::find(refusals_.begin(), refusals_.end(), sentence) == refusals_.end())
        refusals_.push_back(sentence);
}

bool MeshFolderIo::Exists(const char* name) const
{
    if (is_main(name)) return true;
    std::error_code error;
    const std::string real = find_inside(name);
    return !real.empty() && fs::is_regular_file(real, error);
}

Assimp::IOStream* MeshFolderIo::Open(const char* name, const char* mode)
{
    if (mode != nullptr && std::strpbrk(mode, "wa+") != nullptr) return nullptr;
    if (is_main(name)) return std::make_unique<BytesStream>(std::string_view(main_bytes_)).release();
    const std::string real = find_inside(name);
    if (real.empty()) return nullptr;
    try {
        return std::make_unique<BytesStream>(read_regular_file(real, kLargestSecondary)).release();
    } catch (const InputError& error) {
        refuse(name, error.what());
        return nullptr;
    }
}

void MeshFolderIo::Close(Assimp::IOStream* stream)
{
    const std::unique_ptr<Assimp::IOStream> owned(stream);
}

}  // namespace arris
