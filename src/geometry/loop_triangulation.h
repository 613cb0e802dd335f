// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <optional>

#include "geometry/cgal.h"

// For .cpp files only: slow to compile.
namespace arris {

/// A triangulation with the sides of closed loops as constraints. It allows a corner on another side, and
/// throws where two sides cross. A vertex has its corner's index; a face has what the loops around it add up
/// to, once that is known.
using LoopTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<
        CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>,
        CGAL::Triangulation_face_base_with_info_2<std::optional<int>, Kernel,
                                                  CGAL::Constrained_triangulation_face_base_2<Kernel>>>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

}  // namespace arris
