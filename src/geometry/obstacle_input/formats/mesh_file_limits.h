// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace arris {

// What a mesh file may hold. More is damage or malice, and would cost minutes or all memory.

/// Bytes of a mesh file, and of a file of materials, buffers or textures beside it.
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{2} << 30;
inline constexpr std::uintmax_t kLargestSecondary = kLargestFile / 2;

inline constexpr std::size_t kMostFaces = 10'000'000;

/// Nodes of a scene, or objects that a 3MF file places.
inline constexpr std::size_t kMostNodes = 1'000'000;

/// Notes of one kind that a message lists.
inline constexpr std::size_t kMostNotes = 10;

}  // namespace arris
