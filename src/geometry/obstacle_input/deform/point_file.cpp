// SPDX-License-Identifier: GPL-3.0-or-later
// Two formats of single-precision places at a fixed stride:
//     MDD, big-endian:     samples, vertices (int32); a time (float, s) a sample; places
//     PC2, little-endian:  "POINTCACHE2\0", version 1, vertices (int32); first frame, frames from sample to
//                          sample (float); samples (int32); places
#include "geometry/obstacle_input/deform/point_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/formats/input_file.h"

namespace arris {
namespace {

constexpr std::uint64_t kVertexBytes = 3 * sizeof(float);

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
    throw InputError(path + ": " + why);
}

template <class Number>
Number decode(const char* bytes, std::endian order)
{
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    if (order != std::endian::native) word = __builtin_bswap32(word);
    return std::bit_cast<Number>(word);
}

/// What the head of a file declares.
struct Layout {
    std::int32_t samples = 0, vertices = 0;
    std::uint64_t head_bytes = 0;  ///< before the first sample's time or place
    std::uint64_t time_bytes = 0;  ///< of a sample's time
    std::endian order = std::endian::little;

    std::uint64_t sample_bytes() const { return kVertexBytes * static_cast<std::uint64_t>(vertices); }
    std::uint64_t offset(std::size_t sample) const
    {
        return head_bytes + time_bytes * static_cast<std::uint64_t>(samples) + sample * sample_bytes();
    }
};

// Compares counts with the length. Divides, as products of counts may overflow.
void require_fit(const InputFile& file, const Layout& layout)
{
    if (layout.samples < 1)
        refuse(file.path(), fmt::format("holds {} samples; allowed: at least 1", layout.samples));
    if (layout.vertices < 1)
        refuse(file.path(), fmt::format("holds {} vertices; allowed: at least 1", layout.vertices));
    const std::uint64_t body = file.size() - layout.head_bytes;
    const std::uint64_t each = layout.time_bytes + layout.sample_bytes();
    const auto samples = static_cast<std::uint64_t>(layout.samples);
    if (body / each == samples && body % each == 0) return;
    const bool is_short = body / each < samples;
    refuse(file.path(), fmt::format("has {} bytes, {} than its {} samples of {} vertices take; it is {}",
                                    file.size(), is_short ? "fewer" : "more", layout.samples, layout.vertices,
                                    is_short ? "truncated or damaged" : "damaged, or of another format"));
}

void require_vertices(const Layout& layout, const VertexCacheRequest& request)
{
    if (layout.vertices != request.vertex_count)
        refuse(request.path,
               fmt::format("has {} vertices in each sample; allowed: {}, the number of vertices in the "
                           "obstacle's file",
                           layout.vertices, request.vertex_count));
}

/// Replaces times by multiples of one over a whole number of frames a second where single precision does not
/// tell the two apart. They then coincide with frames of the output.
void sharpen(std::vector<double>& times, double first)
{
    if (times.size() < 2 || !(times.back() > 0.0)) return;
    const double rate = std::round(static_cast<double>(times.size() - 1) / times.back());
    std::vector<double> exact;
    for (std::size_t k = 0; k < times.size(); ++k) {
        exact.push_back(static_cast<double>(k) / rate);
        const double rounding =
            std::numeric_limits<float>::epsilon() * (std::abs(first) + std::abs(first + times[k]));
        if (!(std::abs(times[k] - exact.back()) <= rounding)) return;
    }
    times = std::move(exact);
}

class PointFile : public VertexCache {
  public:
    PointFile(std::unique_ptr<InputFile> file, const Layout& layout, const SampleRange& range,
              std::vector<double> times)
        : VertexCache(std::move(times), true), file_(std::move(file)), layout_(layout), first_(range.first)
    {
    }

    std::string describe(std::size_t sample) const override
    {
        return fmt::format("{}: sample {}", file_->path(), first_ + sample);
    }

    void read(std::size_t sample, std::vector<Vec3>& vertices) override
    {
        bytes_.resize(layout_.sample_bytes());
        file_->read(layout_.offset(first_ + sample), bytes_.data(), bytes_.size());
        vertices.resize(static_cast<std::size_t>(layout_.vertices));
        const char* at = bytes_.data();
        for (Vec3& vertex : vertices)
            for (double& c : vertex) {
                c = static_cast<double>(decode<float>(at, layout_.order));
                at += sizeof(float);
            }
    }

  private:
    std::unique_ptr<InputFile> file_;
    Layout layout_;
    std::size_t first_;
    std::vector<char> bytes_;
};

/// Times of an MDD file after the first one used.
std::vector<double> read_times(const InputFile& file, const Layout& layout, const SampleRange& range)
{
    std::vector<char> bytes(range.count * sizeof(float));
    file.read(layout.head_bytes + range.first * sizeof(float), bytes.data(), bytes.size());
    std::vector<double> times;
    const double first = static_cast<double>(decode<float>(bytes.data(), layout.order));
    for (std::size_t k = 0; k < range.count; ++k) {
        const double time =
            static_cast<double>(decode<float>(bytes.data() + k * sizeof(float), layout.order));
        if (!std::isfinite(time) || (k > 0 && !(time - first > times.back())))
            refuse(file.path(),
                   fmt::format("sample {} is at {} s{}; allowed: times that ascend; frames_per_second "
                               "replaces the file's",
                               range.first + k, time,
                               k > 0 ? fmt::format(", the one before at {} s", first + times.back()) : ""));
        times.push_back(time - first);
    }
    sharpen(times, first);
    return times;
}

}  // namespace

std::unique_ptr<VertexCache> open_mdd(const VertexCacheRequest& request)
{
    auto file = std::make_unique<InputFile>(request.path);
    std::array<char, 8> head;
    if (file->size() < head.size()) refuse(request.path, "is too short for an MDD file");
    file->read(0, head.data(), head.size());
    Layout layout{.head_bytes = head.size(), .time_bytes = sizeof(float), .order = std::endian::big};
    layout.samples = decode<std::int32_t>(&head[0], layout.order);
    layout.vertices = decode<std::int32_t>(&head[4], layout.order);
    require_fit(*file, layout);
    require_vertices(layout, request);
    const SampleRange range = find_sample_range(request, static_cast<std::size_t>(layout.samples));
    std::vector<double> times;
    if (request.frames_per_second)
        for (std::size_t k = 0; k < range.count; ++k)
            times.push_back(static_cast<double>(k) / *request.frames_per_second);
    else
        times = read_times(*file, layout, range);
    return std::make_unique<PointFile>(std::move(file), layout, range, std::move(times));
}

std::unique_ptr<VertexCache> open_pc2(const VertexCacheRequest& request)
{
    constexpr std::string_view kMagic("POINTCACHE2\0", 12);
    auto file = std::make_unique<InputFile>(request.path);
    std::array<char, 32> head;
    if (file->size() < head.size()) refuse(request.path, "is too short for a PC2 file");
    file->read(0, head.data(), head.size());
    if (!std::string_view(head.data(), head.size()).starts_with(kMagic))
        refuse(request.path, "is not a PC2 file: it does not begin with POINTCACHE2");
    Layout layout{.head_bytes = head.size(), .order = std::endian::little};
    if (const auto version = decode<std::int32_t>(&head[12], layout.order); version != 1)
        refuse(request.path, fmt::format("is of version {}; allowed: 1", version));
    layout.vertices = decode<std::int32_t>(&head[16], layout.order);
    const auto frames = static_cast<double>(decode<float>(&head[24], layout.order));
    layout.samples = decode<std::int32_t>(&head[28], layout.order);
    if (!(frames > 0.0 && std::isfinite(frames)))
        refuse(request.path,
               fmt::format("has {} frames from sample to sample; allowed: a number > 0", frames));
    require_fit(*file, layout);
    require_vertices(layout, request);
    const SampleRange range = find_sample_range(request, static_cast<std::size_t>(layout.samples));
    std::vector<double> times;
    for (std::size_t k = 0; k < range.count; ++k)
        times.push_back(static_cast<double>(k) * frames /
                        request.frames_per_second.value_or(kDefaultFramesPerSecond));
    return std::make_unique<PointFile>(std::move(file), layout, range, std::move(times));
}

}  // namespace arris
