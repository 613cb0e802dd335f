// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

namespace arris {

struct GltfDocument;

/// Reads a file beside the mesh by its name; throws InputError.
using SiblingReader = std::function<std::string(const std::string&)>;

/// Rewrites positions that are integers (KHR_mesh_quantization) as floats in the binary chunk, as the import
/// library (assimp 5.2) copies the bytes of integers into its floats. Returns whether there were any. Throws
/// InputError, without the file's name, for data beyond a buffer's end, and for integers that are sparse or
/// compressed.
bool write_positions_as_floats(GltfDocument& document, const SiblingReader& read_sibling);

}  // namespace arris
