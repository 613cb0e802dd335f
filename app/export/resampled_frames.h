// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/files/frame_source.h"

namespace arris {

/// Cells of a grid along u and v, each 1 to 10000.
struct GridSize {
    int u = 1, v = 1;
};

/// Reads "40x30". Throws InputError naming the text and what is allowed.
GridSize parse_grid(const std::string& text);

/// The mesh of every resampled frame, in material space.
struct ConstantMesh {
    std::vector<Vec2> material;      ///< m
    std::vector<Face> faces;         ///< counter-clockwise
    std::vector<std::uint32_t> ids;  ///< of vertices; of a grid, numbers that no frame need have
    std::vector<PiecePlace> pieces;  ///< of several pieces
    std::vector<Face> face_points;   ///< as in Frame
    std::vector<int> seam_vertices;  ///< likewise

    const std::vector<Face>& corners() const { return face_points.empty() ? faces : face_points; }
};

/// The mesh of the first frame, EOL vertices included; with `grid`, a grid over the first frame's rectangle
/// whose cells are cut in two triangles each. Throws InputError if the cloth is no full rectangle.
ConstantMesh make_constant_mesh(const Frame& first, const std::optional<GridSize>& grid);

/// The frames' cloth at the material points of `mesh`. A point of the linear triangles is exact: position and
/// velocity are interpolated in the triangle that contains the point. `vertex_velocity` is the material's. A
/// vertex is in contact where the nearest corner is. Strain and energy densities are those at the centroids
/// of faces. No vertex or edge is EOL: an edge of `mesh` lies on a fold only by chance. Frames are read
/// one by one. read() throws InputError naming a frame that does not cover a vertex of `mesh`.
FrameSource resampled_frames(const FrameSource& frames, const ConstantMesh& mesh);

}  // namespace arris
