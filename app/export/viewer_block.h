// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

// How a block of data in the viewer's page is packed (viewer/README.md).

using Bytes = std::vector<std::uint8_t>;

/// zlib. std::runtime_error where there is no memory for it.
Bytes deflated(const Bytes& raw);

/// Differences of successive numbers modulo 65536, first the high bytes of all, then the low ones.
void append_planes(const std::vector<std::uint16_t>& numbers, Bytes& out);

/// Numbers of 32 bits: first the highest byte of all, then the next, ...
void append_planes(const std::vector<std::uint32_t>& numbers, Bytes& out);

/// Indices of triangles, pairs and points, each as the difference to the one before, zigzag, 32 bits.
void append_indices(const std::vector<Face>& faces, const std::vector<std::array<int, 2>>& pairs,
                    const std::vector<int>& points, Bytes& out);

std::string base64(const Bytes& bytes);

}  // namespace arris
