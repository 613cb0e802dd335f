// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle_input/gltf/gltf_accessors.h"

namespace arris {

/// Rewrites positions that are integers (KHR_mesh_quantization) as floats in the binary chunk, as the import
/// library (assimp 5.2) copies the bytes of integers into its floats. Returns whether there were any. Throws
/// InputError, without the file's name, for data beyond a buffer's end, and for integers in compressed
/// meshes.
bool write_positions_as_floats(GltfDocument& document, const SiblingReader& read_sibling);

}  // namespace arris
