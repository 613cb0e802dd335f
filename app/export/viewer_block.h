// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

// Packing of a block of data in the viewer's page (viewer/README.md).

using Bytes = std::vector<std::uint8_t>;

/// Compresses with zlib. Throws std::runtime_error if there is too little memory.
Bytes deflated(const Bytes& raw);

/// Appends differences of successive numbers modulo 65536: first all high bytes, then all low bytes.
void append_planes(const std::vector<std::uint16_t>& numbers, Bytes& out);

/// The box around points, m.
struct ViewerBox {
    Vec3 least, greatest;

    Vec3 size() const { return greatest - least; }
    Vec3 centre() const { return (least + greatest) / 2.0; }
};

/// `points` must not be empty.
ViewerBox find_box(const std::vector<Vec3>& points);

/// The level of `value` among 65536 from `least` to `least + range`; 0 if `range` is 0.
std::uint16_t to_level(double value, double least, double range);

/// Appends x of all points, y, z, as levels in the box.
void append_points(const std::vector<Vec3>& points, const ViewerBox& box, Bytes& out);

/// Appends 32-bit numbers: first the highest byte of all numbers, then the next byte, ...
void append_planes(const std::vector<std::uint32_t>& numbers, Bytes& out);

/// Appends indices of triangles, pairs and points as 32-bit zigzag differences to the previous index.
void append_indices(const std::vector<Face>& faces, const std::vector<std::array<int, 2>>& pairs,
                    const std::vector<int>& points, Bytes& out);

std::string base64(const Bytes& bytes);

}  // namespace arris
