// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

// Mesh files as bytes, written from the formats' descriptions.
namespace arris::mesh_files {

/// A mesh of polygons.
struct PolygonMesh {
    std::vector<Vec3> points;
    std::vector<std::vector<int>> faces;
};

std::string obj(const PolygonMesh& mesh);
std::string obj(const ObstacleMesh& mesh);
std::string ascii_stl(const ObstacleMesh& mesh);
std::string binary_stl(const ObstacleMesh& mesh);
std::string ascii_ply(const PolygonMesh& mesh);
std::string ascii_ply(const ObstacleMesh& mesh);
std::string binary_ply(const ObstacleMesh& mesh, bool is_big_endian = false);

/// Little-endian buffer of a glTF mesh: float positions, then uint16 indices.
std::string gltf_buffer(const ObstacleMesh& mesh);

/// JSON of a glTF 2 file. `uri` names its buffer (empty: none, as in GLB). `node` has further members of its
/// node, such as ",\"scale\":[-1,1,1]".
std::string gltf_json(const ObstacleMesh& mesh, const std::string& uri, const std::string& node = "");
std::string glb(const ObstacleMesh& mesh, const std::string& node = "");

/// A COLLADA file. `asset` has the lines for unit and up axis; `matrix` is a row-major placement of its node,
/// or empty.
std::string dae(const PolygonMesh& mesh, const std::string& asset);
std::string dae(const ObstacleMesh& mesh, const std::string& asset, const std::string& matrix = "");

/// An FBX file in text form, version 7400, with these global settings.
std::string fbx(const PolygonMesh& mesh, int up_axis, double centimetres_per_unit);
std::string fbx(const ObstacleMesh& mesh, int up_axis, double centimetres_per_unit);

std::string three_ds(const ObstacleMesh& mesh);

/// An archive of files (name, content), not compressed.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files);

/// The model of a 3MF file, with `attributes` such as " unit=\"inch\""; and a file with this model, as an
/// uncompressed archive.
std::string three_mf_model(const ObstacleMesh& mesh, const std::string& attributes);
std::string three_mf_package(const std::string& model);
std::string three_mf(const ObstacleMesh& mesh, const std::string& attributes);

}  // namespace arris::mesh_files
