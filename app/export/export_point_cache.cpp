// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_point_cache.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <limits>

#include "app/export/float_value.h"
#include "app/files/atomic_file.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

void append(std::string& bytes, std::uint32_t value, std::endian order)
{
    for (int k = 0; k < 4; ++k) {
        const int byte = order == std::endian::little ? k : 3 - k;
        bytes.push_back(static_cast<char>(value >> (8 * byte)));
    }
}

void append(std::string& bytes, float value, std::endian order)
{
    append(bytes, std::bit_cast<std::uint32_t>(value), order);
}

std::uint32_t require_count(const std::string& path, const char* what, std::size_t count)
{
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    if (count > kMost)
        throw InputError(fmt::format("{}: {} {}; the format allows at most {}", path, count, what, kMost));
    return static_cast<std::uint32_t>(count);
}

void write_points(AtomicFile& file, const std::string& path, const FrameSource& frames,
                  std::size_t vertex_count, std::endian order)
{
    std::string bytes;
    for (std::size_t i = 0; i < frames.count; ++i) {
        const Frame frame = frames.read(i);
        if (frame.world.size() != vertex_count)
            throw InputError(fmt::format("{}: frame {} has {} vertices, frame 0 has {}; allowed: one mesh",
                                         path, i, frame.world.size(), vertex_count));
        bytes.clear();
        for (std::size_t v = 0; v < vertex_count; ++v)
            for (const double value : frame.world[v]) append(bytes, float_value(path, i, v, value), order);
        file.write(bytes);
    }
}

}  // namespace

void write_pc2(const std::string& path, const FrameSource& frames)
{
    constexpr auto kOrder = std::endian::little;
    constexpr std::uint32_t kVersion = 1;
    constexpr float kFirstFrame = 0.0F, kFramesPerSample = 1.0F;
    const std::size_t vertex_count = frames.count > 0 ? frames.read(0).world.size() : 0;
    std::string header("POINTCACHE2\0", 12);
    append(header, kVersion, kOrder);
    append(header, require_count(path, "vertices", vertex_count), kOrder);
    append(header, kFirstFrame, kOrder);
    append(header, kFramesPerSample, kOrder);
    append(header, require_count(path, "frames", frames.count), kOrder);
    AtomicFile file(path);
    file.write(header);
    write_points(file, path, frames, vertex_count, kOrder);
    file.commit();
}

void write_mdd(const std::string& path, const FrameSource& frames, double frames_per_second)
{
    constexpr auto kOrder = std::endian::big;
    const std::size_t vertex_count = frames.count > 0 ? frames.read(0).world.size() : 0;
    std::string header;
    append(header, require_count(path, "frames", frames.count), kOrder);
    append(header, require_count(path, "vertices", vertex_count), kOrder);
    for (std::size_t i = 0; i < frames.count; ++i)
        append(header, static_cast<float>(static_cast<double>(i) / frames_per_second), kOrder);
    AtomicFile file(path);
    file.write(header);
    write_points(file, path, frames, vertex_count, kOrder);
    file.commit();
}

}  // namespace arris
