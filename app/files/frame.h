// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// One frame as written to frames/cloth_%05d.ply. Every other format is made from these.
struct Frame {
    std::vector<Vec3> world;              ///< x y z, m
    std::vector<Vec2> material;           ///< u v, m
    std::vector<Vec3> vertex_velocity;    ///< vx vy vz, m/s: of the vertex
    std::vector<Vec3> material_velocity;  ///< wx wy wz, m/s: of the material there
    std::vector<std::uint32_t> ids;
    std::vector<std::uint8_t> eol;      ///< 0 none, 1 edge or wire, 2 corner or point
    std::vector<std::uint8_t> contact;  ///< 1 where a contact presses on the vertex
    std::vector<Face> faces;
    std::vector<double> strain;          ///< one a face: greatest principal strain
    std::vector<double> stretch_energy;  ///< one a face, J
    std::vector<double> bending_energy;  ///< one a face, J (half of each of its hinges')
    std::vector<std::array<int, 2>> eol_edges;
};

/// Binary little-endian PLY, written to a temporary name and renamed, so that a frame is whole or absent.
/// Throws std::runtime_error naming the path and the system's reason where the disk refuses.
void write_frame(const std::string& path, const Frame& frame);

/// Reads what write_frame wrote. Untrusted input: lengths are checked against the file's size before anything
/// is allocated; throws InputError naming the file and what is wrong.
Frame read_frame(const std::string& path);

}  // namespace arris
