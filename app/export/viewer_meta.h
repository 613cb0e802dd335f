// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/export/viewer_block.h"
#include "app/export/viewer_html.h"
#include "geometry/vectors.h"

namespace arris {

// The content of a viewer's page, and the list of it that viewer/src/run.js reads first.

/// Data that is constant from frame to frame until the mesh changes.
struct ViewerTopology {
    std::size_t vertices = 0;
    std::vector<Face> faces;
    std::vector<std::array<int, 2>> eol_edges;
    std::vector<int> eol_corners;
    Vec2 least = Vec2::Zero(), size = Vec2::Zero();  ///< box of the material coordinates, m
    std::vector<int> eol_vertices;                   ///< on EOL edges, corners or points, ascending
    std::vector<Vec2> material;                      ///< of every vertex, m; zero where it is an EOL vertex

    bool operator==(const ViewerTopology&) const = default;
};

struct ViewerTopologyBlock {
    std::size_t vertices, faces, edges, corners;
    Vec2 least, size;  // box of the material coordinates, m
    Bytes data;
};

/// The mesh of an obstacle or a mark, in the obstacle's frame relative to `centre`. Without points if it
/// deforms.
struct ViewerMeshBlock {
    const ObstacleRecord* obstacle;
    Vec3 centre, size;  // centre and size of the bounding box at time 0, m
    Bytes data;
    bool is_mark = false;  // shows what crosses
};

/// The points of a deforming obstacle in a frame, relative to the `centre` of its mesh.
struct ViewerPoseBlock {
    ViewerBox box;
    Bytes data;
};

struct ViewerFrameBlock {
    std::int64_t index;
    int topology;
    ViewerBox box;
    double least_strain, strain_range;
    double most_speed;  // m/s
    Bytes data;
    std::map<std::size_t, ViewerPoseBlock> poses;  // by the number of the mesh

    /// Of the compressed data.
    std::size_t byte_count() const;
};

/// The blocks of the page. Frames are left out to keep their total size below a limit.
struct ViewerBlocks {
    std::map<int, ViewerTopologyBlock> topologies;
    int newest_topology = -1;
    std::vector<ViewerFrameBlock> frames;
    std::vector<ViewerMeshBlock> meshes;
    std::vector<std::string> left_out;  ///< names of obstacles that do not fit
    std::int64_t stride = 1;
    std::size_t mesh_bytes = 0;
    std::size_t bytes = 0;  ///< total size of all blocks
    double least_strain = std::numeric_limits<double>::infinity();
    double greatest_strain = -std::numeric_limits<double>::infinity();
    double typical_strain = 0.0;
    double typical_speed = 0.0;
};

/// The list of the page's blocks (viewer/README.md, `arris-meta`). The page ignores keys that it does not
/// know.
nlohmann::ordered_json viewer_meta(const ViewerBlocks& blocks, const ViewerOptions& options);

}  // namespace arris
