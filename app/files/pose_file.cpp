// SPDX-License-Identifier: GPL-3.0-or-later
// After the magic: a text with the version; a text with the head (points, is single, is linear, times); the
// head's CRC-32; the samples, each with its CRC-32.
#include "app/files/pose_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "app/files/atomic_file.h"
#include "app/files/binary_stream.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"
#include "geometry/input_limits.h"

namespace arris {
namespace {

constexpr std::string_view kMagic = "ARRIS poses\n";
constexpr std::string_view kVersion = "poses 1";
// s. Velocities between samples within these bounds are finite.
constexpr double kLatest = 1e12, kShortest = 1e-12;
constexpr std::size_t kCopyBytes = std::size_t{1} << 20;
constexpr std::uint64_t kChecksumBytes = sizeof(std::uint32_t);

/// A text with a length of its own, and the bytes in front of it.
constexpr std::uint64_t kVersionBytes = kMagic.size() + sizeof(std::uint64_t) + kVersion.size();

std::uint64_t point_bytes(const PoseFileHead& head)
{
    return 3 * (head.is_single ? sizeof(float) : sizeof(double));
}

std::string encode_head(const PoseFileHead& head)
{
    BinaryWriter out;
    out.number(static_cast<std::uint64_t>(head.point_count));
    out.number(static_cast<std::uint8_t>(head.is_single));
    out.number(static_cast<std::uint8_t>(head.interpolation == PoseInterpolation::Linear));
    out.list(head.times, [&](double time) { out.number(time); });
    return out.bytes();
}

template <class Number>
void encode(const std::vector<Vec3>& points, BinaryWriter& out)
{
    for (const Vec3& point : points)
        for (const double c : point) out.number(static_cast<Number>(c));
}

template <class Number>
void decode(const char* bytes, std::vector<Vec3>& points)
{
    for (Vec3& point : points)
        for (double& c : point) {
            Number number;
            std::memcpy(&number, bytes, sizeof number);
            c = static_cast<double>(number);
            bytes += sizeof number;
        }
}

[[noreturn]] void fail_write(const char* what, const std::string& path)
{
    throw std::system_error(errno, std::generic_category(), std::string(what) + " " + path);
}

}  // namespace

PoseFile::PoseFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}

PoseFile::~PoseFile()
{
    ::close(descriptor_);
}

void PoseFile::fail(const std::string& what) const
{
    throw InputError(fmt::format("{}: {}", printable(path_), what));
}

std::shared_ptr<const PoseFile> PoseFile::open(const std::string& path)
{
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        throw InputError(fmt::format("{}: {}, in which the run stored the poses of an obstacle",
                                     printable(path), errno == ENOENT ? "is missing" : std::strerror(errno)));
    const std::shared_ptr<PoseFile> file(new PoseFile(descriptor, path));
    file->read_head();
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < file->head_.times.size(); ++k) file->read(k, points);
    return file;
}

std::uint64_t PoseFile::file_bytes() const
{
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
        fail("is not a file of poses of arris");
    return static_cast<std::uint64_t>(status.st_size);
}

std::uint64_t PoseFile::size() const
{
    return head_bytes_ + head_.times.size() * (point_bytes(head_) * head_.point_count + kChecksumBytes);
}

// Lengths are compared with the file's before anything is allocated.
void PoseFile::read_head()
{
    const std::uint64_t total = file_bytes();
    constexpr std::uint64_t kFixed = kVersionBytes + sizeof(std::uint64_t);
    if (total < kFixed) fail("is not a file of poses of arris");
    std::string fixed(kFixed, '\0');
    read_bytes(0, fixed.data(), fixed.size());
    if (!fixed.starts_with(kMagic)) fail("is not a file of poses of arris");
    BinaryReader in(std::string_view(fixed).substr(kMagic.size()), path_);
    if (const std::string version = in.text(); version != kVersion)
        fail(fmt::format("was written by version {}; this is version {}", printable(version, 40), kVersion));
    const auto length = in.number<std::uint64_t>();
    if (length > total - kFixed || total - kFixed - length < kChecksumBytes) fail("is truncated or damaged");

    std::string body(length + kChecksumBytes, '\0');
    read_bytes(kFixed, body.data(), body.size());
    BinaryReader head(std::string_view(body).substr(0, length), path_);
    if (BinaryReader(std::string_view(body).substr(length), path_).number<std::uint32_t>() !=
        checksum(std::string_view(body).substr(0, length)))
        fail("is damaged: its checksum differs");
    head_.point_count = head.number<std::uint64_t>();
    head_.is_single = head.number<std::uint8_t>() != 0;
    head_.interpolation =
        head.number<std::uint8_t>() != 0 ? PoseInterpolation::Linear : PoseInterpolation::Cubic;
    head_.times = head.list<double>(sizeof(double), [&] { return head.number<double>(); });
    head_bytes_ = kFixed + body.size();

    bool is_sound = head.is_at_end() && !head_.times.empty() && head_.point_count > 0;
    for (std::size_t k = 0; k < head_.times.size(); ++k)
        is_sound = is_sound && std::abs(head_.times[k]) <= kLatest &&
                   (k == 0 || head_.times[k] - head_.times[k - 1] >= kShortest);
    if (!is_sound) fail("is damaged: its times are invalid");
    // Divides, as products of counts may overflow.
    const std::uint64_t each = (total - head_bytes_) / head_.times.size();
    if ((total - head_bytes_) % head_.times.size() != 0 || each < kChecksumBytes ||
        (each - kChecksumBytes) % point_bytes(head_) != 0 ||
        (each - kChecksumBytes) / point_bytes(head_) != head_.point_count)
        fail("is damaged: its length is not what its counts say");
}

void PoseFile::read_bytes(std::uint64_t offset, char* bytes, std::size_t count) const
{
    while (count > 0) {
        const ssize_t got = ::pread(descriptor_, bytes, count, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(std::strerror(errno));
        if (got == 0) fail("is truncated or damaged");
        bytes += got;
        offset += static_cast<std::uint64_t>(got);
        count -= static_cast<std::size_t>(got);
    }
}

void PoseFile::read(std::size_t sample, std::vector<Vec3>& points) const
{
    const std::uint64_t length = point_bytes(head_) * head_.point_count;
    bytes_.resize(length + kChecksumBytes);
    read_bytes(head_bytes_ + sample * bytes_.size(), bytes_.data(), bytes_.size());
    std::uint32_t sum = 0;
    std::memcpy(&sum, bytes_.data() + length, sizeof sum);
    if (sum != checksum(std::string_view(bytes_).substr(0, length)))
        fail(fmt::format("is damaged: the checksum of sample {} differs", sample));
    points.resize(head_.point_count);
    if (head_.is_single)
        decode<float>(bytes_.data(), points);
    else
        decode<double>(bytes_.data(), points);
    for (const Vec3& point : points)
        // A place at the bound may be rounded up.
        if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1.001 * kLargestCoordinate)
            fail(fmt::format("is damaged: sample {} has a place beyond {:g} m", sample, kLargestCoordinate));
}

void PoseFile::copy_to(const std::string& path) const
{
    AtomicFile file(path);
    std::string block;
    for (std::uint64_t at = 0, end = size(); at < end; at += block.size()) {
        block.resize(std::min<std::uint64_t>(kCopyBytes, end - at));
        read_bytes(at, block.data(), block.size());
        file.write(block);
    }
    file.commit();
}

PoseFileWriter::PoseFileWriter(PoseFileHead head) : head_(std::move(head))
{
    folder_ = std::filesystem::temp_directory_path().string();
    std::string name = folder_ + "/arris_poses_XXXXXX";
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail_write("cannot create a temporary file in", folder_);
    ::unlink(name.c_str());
    const std::string body = encode_head(head_);
    BinaryWriter out;
    out.text(kVersion);
    out.text(body);
    out.number(checksum(body));
    write_fully(descriptor_, std::string(kMagic) + out.bytes(), folder_);
}

PoseFileWriter::~PoseFileWriter()
{
    if (descriptor_ >= 0) ::close(descriptor_);
}

void PoseFileWriter::add(const std::vector<Vec3>& points)
{
    assert(points.size() == head_.point_count);
    BinaryWriter out;
    if (head_.is_single)
        encode<float>(points, out);
    else
        encode<double>(points, out);
    const std::uint32_t sum = checksum(out.bytes());
    out.number(sum);
    write_fully(descriptor_, out.bytes(), folder_);
}

std::shared_ptr<const PoseFile> PoseFileWriter::finish()
{
    std::shared_ptr<PoseFile> file(new PoseFile(std::exchange(descriptor_, -1),
                                                "the temporary file of an obstacle's poses in " + folder_));
    file->read_head();
    return file;
}

}  // namespace arris
