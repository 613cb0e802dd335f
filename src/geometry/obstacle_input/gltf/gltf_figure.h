// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/obstacle_input/gltf/gltf_accessors.h"
#include "geometry/vectors.h"

namespace arris {

/// What an animation may change of a node.
struct GltfNodePose {
    Vec3 translation = Vec3::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 scale = Vec3::Ones();
    std::vector<double> weights;  ///< of its mesh's morph targets
};

using GltfPose = std::vector<GltfNodePose>;  ///< one a node

/// The vertices that a glTF file shows, in any pose of its nodes. Nodes are taken as the import library does
/// it, each before its children; of each the vertices of its mesh's primitives in their order.
///
/// As glTF 2.0, 3.7: morph targets move vertices first. A skin then blends the joints' placements linearly
/// with up to eight weights a vertex, and the placement of the mesh's own node does nothing. Weights count
/// relative to their sum.
class GltfFigure {
  public:
    /// Reads meshes, targets and skins. Throws InputError, without the file's name, for data that the
    /// specification forbids: joints that are not there, vertices without weights, other counts than those
    /// of the positions, nodes with two parents; also for compressed meshes.
    GltfFigure(const nlohmann::json& file, GltfAccessors& accessors);

    /// The pose in which the file states its nodes.
    const GltfPose& rest() const { return rest_; }
    /// Whether the node's placement is a matrix, which no animation may change.
    bool has_matrix(std::size_t node) const { return nodes_[node].has_matrix; }
    std::size_t vertex_count() const { return vertex_count_; }  ///< at most 3e7

    /// The places of all vertices, in metres, y up.
    void place(const GltfPose& pose, std::vector<Vec3>& vertices) const;

  private:
    struct Node {
        int parent = -1;
        bool has_matrix = false;
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    };
    struct Influence {
        int joint = 0;  // of the skin
        double weight = 0.0;
    };
    struct Primitive {
        std::vector<Vec3> positions;
        std::vector<std::vector<Eigen::Vector3f>> targets;  // empty: moves nothing
        std::size_t sets = 0;                               // of four influences a vertex
        std::vector<Influence> influences;                  // 4 sets a vertex; their weights add up to 1
    };
    struct Skin {
        std::vector<int> joints;               // nodes
        std::vector<Eigen::Matrix4d> inverse;  // inverse bind matrices
    };
    struct Instance {
        std::size_t node = 0, mesh = 0;
        int skin = -1;
    };
    using Placements = std::vector<Eigen::Matrix4d>;

    void read_nodes();
    void read_shown();
    void show(std::size_t node);
    void read_mesh(std::size_t mesh);
    void read_skin(int skin);
    Primitive read_primitive(const nlohmann::json& primitive, const std::string& what);
    void read_influences(const nlohmann::json& attributes, Primitive& primitive, const std::string& what);
    void require_joints(const Instance& instance) const;
    std::vector<double> rest_weights(std::size_t node) const;
    Placements find_placements(const GltfPose& pose) const;
    /// `placements`: of the skin's joints, else that of the node alone.
    static void place(const Primitive& primitive, bool has_skin, const std::vector<double>& weights,
                      const Placements& placements, std::vector<Vec3>& vertices);

    const nlohmann::json* file_;  // while it is read
    GltfAccessors* accessors_;
    std::vector<Node> nodes_;
    std::vector<std::size_t> order_;  // parents before children
    GltfPose rest_;
    std::map<std::size_t, std::vector<Primitive>> meshes_;  // by index
    std::map<int, Skin> skins_;
    std::vector<Instance> instances_;
    std::size_t vertex_count_ = 0;
    std::size_t move_count_ = 0;  // of all targets
};

/// Whether a node that the file shows has a skin, or morph targets with weights other than zero.
bool is_posed_gltf(const nlohmann::json& file);

/// Whether a mesh of the file is compressed (Draco), which only the import library reads.
bool is_packed_gltf(const nlohmann::json& file);

}  // namespace arris
