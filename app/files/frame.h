// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/cloth/piece_place.h"
#include "geometry/vectors.h"

namespace arris {

/// One frame as written to frames/cloth_%05d.ply. All other formats are made from these files.
struct Frame {
    std::vector<Vec3> world;              ///< x y z, m
    std::vector<Vec2> material;           ///< u v, m, of each material point, in the plane of all pieces
    std::vector<Vec3> vertex_velocity;    ///< vx vy vz, m/s: velocity of the vertex
    std::vector<Vec3> material_velocity;  ///< wx wy wz, m/s: velocity of the material at the vertex
    std::vector<std::uint32_t> ids;
    std::vector<std::uint8_t> eol;      ///< 0 none, 1 edge or wire, 2 corner or point
    std::vector<std::uint8_t> contact;  ///< 1 where a contact presses on the vertex
    std::vector<Face> faces;
    std::vector<double> strain;          ///< per face: greatest principal strain
    std::vector<double> stretch_energy;  ///< per face, J
    std::vector<double> bending_energy;  ///< per face, J: half of the energy of each of its hinges
    std::vector<std::array<int, 2>> eol_edges;
    std::vector<Face> face_points;   ///< as in ClothMesh: empty without seams
    std::vector<int> seam_vertices;  ///< likewise
    std::vector<PiecePlace> pieces;  ///< of several pieces of cloth, ascending by `begin`; empty for one

    /// Points at the corners of each face.
    const std::vector<Face>& corners() const { return face_points.empty() ? faces : face_points; }
    int piece_of(const Face& points) const;      ///< index in `pieces`; 0 where there are none
    std::vector<Vec2> own_material() const;      ///< u v, m, of each point in the coordinates of its piece
    std::vector<int> faces_of(int piece) const;  ///< ascending
};

/// A copy of the frame with a vertex of its own for every material point, for formats whose vertices have one
/// UV. Vertices of one place have one id.
Frame split_seams(const Frame& frame);

/// Writes a binary little-endian PLY file atomically. Throws std::runtime_error naming the path and the
/// system's reason if writing fails.
void write_frame(const std::string& path, const Frame& frame);

/// Reads a file of write_frame. The file is untrusted: lengths are checked against its size before memory is
/// allocated. Throws InputError naming the file and the error.
Frame read_frame(const std::string& path);

}  // namespace arris
