// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

struct ObstacleFileRequest {
    std::string path;                       ///< .obj, .stl, .ply, .gltf, .glb, .dae, .fbx, .3mf or .3ds
    std::optional<double> metres_per_unit;  ///< instead of the unit that the file declares
    std::optional<char> up;             ///< 'x', 'y' or 'z', instead of the up axis that the file declares
    std::vector<std::string> importer;  ///< program (by path) and arguments; ends in import_obstacle_command
    std::chrono::milliseconds timeout{120000};  ///< for the whole import
};

struct ObstacleFile {
    ObstacleMesh mesh;                  ///< m, +z up; passes `validate`
    std::vector<std::string> warnings;  ///< one sentence each, without the file's name: what was repaired
    std::vector<std::string> notes;     ///< likewise: what is legitimate but good to know
};

/// Reads and repairs an obstacle's mesh (see repair_soup) from a file that nobody vouches for. A process of
/// its own, `importer`, does so: whatever the file makes the import library do, it ends with an InputError.
/// That process may use `timeout`, as many CPU seconds, and memory by the file's size (not under address
/// sanitizers, which reserve all there is); its reply is checked before it is believed.
/// Without explicit ones, units and up axis are what the file declares (COLLADA, FBX, 3MF; glTF: metres,
/// y up), else metres and z. An up axis is turned to +z: y by (x, y, z) -> (x, -z, y), x by (-z, y, x).
/// Coordinates are read in single precision; a warning says where that matters.
/// Throws InputError, one line that begins with the path, for a file that is missing, not a regular file,
/// larger than 2 GB, of another format, damaged, or with nothing in it that can be an obstacle, and where the
/// import crashed, was too slow or asked for too much memory. Thread-safe.
ObstacleFile read_obstacle_file(const ObstacleFileRequest& request);

}  // namespace arris
