// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vectors.h"

/// Bytes of files of positions in time, written independently of the program's own writers.
namespace arris::cache_files {

using Samples = std::vector<std::vector<Vec3>>;

inline void append(std::string& bytes, std::uint32_t word, std::endian order)
{
    for (int k = 0; k < 4; ++k)
        bytes.push_back(static_cast<char>(word >> 8 * (order == std::endian::little ? k : 3 - k)));
}

inline void append(std::string& bytes, double value, std::endian order)
{
    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), order);
}

inline void append(std::string& bytes, const Samples& samples, std::endian order)
{
    for (const std::vector<Vec3>& sample : samples)
        for (const Vec3& p : sample)
            for (const double c : p) append(bytes, c, order);
}

inline std::uint32_t vertex_count(const Samples& samples)
{
    return samples.empty() ? 1U : static_cast<std::uint32_t>(samples[0].size());
}

inline std::string mdd(const Samples& samples, const std::vector<float>& times,
                       std::endian order = std::endian::big)
{
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(samples.size()), order);
    append(bytes, vertex_count(samples), order);
    for (const float time : times) append(bytes, static_cast<double>(time), order);
    append(bytes, samples, order);
    return bytes;
}

inline std::string pc2(const Samples& samples, double frames, std::endian order = std::endian::little)
{
    std::string bytes("POINTCACHE2\0", 12);
    append(bytes, std::uint32_t{1}, order);
    append(bytes, vertex_count(samples), order);
    append(bytes, 0.0, order);
    append(bytes, frames, order);
    append(bytes, static_cast<std::uint32_t>(samples.size()), order);
    append(bytes, samples, order);
    return bytes;
}

}  // namespace arris::cache_files
