// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// For each vertex the least vertex of its connected piece of the mesh; its own index if no face has it.
std::vector<int> label_pieces(int vertex_count, const std::vector<Face>& faces);

}  // namespace arris
