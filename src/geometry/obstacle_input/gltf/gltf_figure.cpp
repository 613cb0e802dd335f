// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "geometry/obstacle_input/gltf/gltf_nodes.h"

namespace arris {
namespace {

using nlohmann::json;
using Placement4 = Eigen::Matrix4d;

constexpr std::size_t kMostVertices = 3 * kMostFaces;  // as the importer allows
constexpr std::size_t kMostMoves = 100'000'000;        // of vertices by all morph targets: 1.2 GB
constexpr std::size_t kMostSets = 2;                   // JOINTS_0 and JOINTS_1

const std::vector<int> kVectors = {kGltfByte, kGltfUnsignedByte, kGltfShort, kGltfUnsignedShort, kGltfSingle};

std::size_t index_in(const json& file, const char* array, const json& index)
{
    gltf_element(file, array, index);  // throws where it is not there
    return index.get<std::size_t>();
}

/// Columns follow each other.
Placement4 to_matrix(const double* numbers)
{
    return Eigen::Map<const Placement4>(numbers);
}

Placement4 to_matrix(const GltfNodePose& pose)
{
    Placement4 matrix = Placement4::Identity();
    matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix() * pose.scale.asDiagonal();
    matrix.topRightCorner<3, 1>() = pose.translation;
    return matrix;
}

GltfNodePose read_pose(const json& node, const std::string& what)
{
    GltfNodePose pose;
    const std::vector<double> t = gltf_numbers(node, "translation", 3, what),
                              r = gltf_numbers(node, "rotation", 4, what),
                              s = gltf_numbers(node, "scale", 3, what);
    if (!t.empty()) pose.translation = {t[0], t[1], t[2]};
    if (!r.empty()) pose.rotation = Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized();
    if (!s.empty()) pose.scale = {s[0], s[1], s[2]};
    return pose;
}

bool is_packed(const json& primitive)
{
    return !gltf_member(gltf_member(primitive, "extensions"), "KHR_draco_mesh_compression").is_null();
}

/// Morph weights of a node: its own, else its mesh's.
const json& weights_of(const json& file, const json& node)
{
    const json& own = gltf_member(node, "weights");
    return own.is_null() ? gltf_member(gltf_element(file, "meshes", gltf_member(node, "mesh")), "weights")
                         : own;
}

}  // namespace

GltfFigure::GltfFigure(const json& file, GltfAccessors& accessors) : file_(&file), accessors_(&accessors)
{
    read_nodes();
    read_shown();
    for (std::size_t n = 0; n < nodes_.size(); ++n) rest_[n].weights = rest_weights(n);
    file_ = nullptr;
    accessors_ = nullptr;
}

void GltfFigure::read_nodes()
{
    const json& nodes = gltf_member(*file_, "nodes");
    if (nodes.size() > kMostNodes) throw InputError(fmt::format("more than {} nodes", kMostNodes));
    nodes_.resize(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::string what = fmt::format("node {}", n);
        check_gltf_placement(nodes[n], what);
        rest_.push_back(read_pose(nodes[n], what));
        const std::vector<double> matrix = gltf_numbers(nodes[n], "matrix", 16, what);
        nodes_[n].has_matrix = !matrix.empty();
        if (!matrix.empty()) nodes_[n].matrix = to_matrix(matrix.data());
        for (const json& child : gltf_member(nodes[n], "children")) {
            int& parent = nodes_[index_in(*file_, "nodes", child)].parent;
            if (parent >= 0)
                throw InputError(fmt::format("node {} is a child of nodes {} and {}; allowed: of one",
                                             child.get<std::size_t>(), parent, n));
            parent = static_cast<int>(n);
        }
    }
    // Nodes in a circle hang on no root.
    for (std::size_t n = 0; n < nodes_.size(); ++n)
        if (nodes_[n].parent < 0) order_.push_back(n);
    for (std::size_t next = 0; next < order_.size(); ++next)
        for (const json& child : gltf_member(nodes[order_[next]], "children"))
            order_.push_back(child.get<std::size_t>());
    if (order_.size() < nodes_.size()) throw InputError("its nodes hang on each other in a circle");
}

void GltfFigure::read_shown()
{
    const json& nodes = gltf_member(*file_, "nodes");
    const json& scenes = gltf_member(*file_, "scenes");
    if (!scenes.is_array() || scenes.empty()) throw InputError("it has no scene; allowed: at least one");
    const json& scene = gltf_member(*file_, "scene");
    const json& shown = scene.is_null() ? scenes[0] : gltf_element(*file_, "scenes", scene);
    std::vector<std::size_t> left;
    const auto add_reversed = [&](const json& list) {
        for (std::size_t k = list.size(); k-- > 0;) left.push_back(index_in(*file_, "nodes", list[k]));
    };
    add_reversed(gltf_member(shown, "nodes"));
    std::vector<char> is_taken(nodes_.size(), 0);
    while (!left.empty()) {
        const std::size_t node = left.back();
        left.pop_back();
        if (std::exchange(is_taken[node], 1) != 0)
            throw InputError(fmt::format("node {} is shown twice; allowed: once", node));
        show(node);
        add_reversed(gltf_member(nodes[node], "children"));
    }
}

void GltfFigure::show(std::size_t node)
{
    const json& stated = gltf_member(*file_, "nodes")[node];
    const json &mesh = gltf_member(stated, "mesh"), &skin = gltf_member(stated, "skin");
    if (mesh.is_null()) return;
    Instance instance{node, index_in(*file_, "meshes", mesh), -1};
    if (!meshes_.contains(instance.mesh)) read_mesh(instance.mesh);
    if (!skin.is_null()) {
        instance.skin = static_cast<int>(index_in(*file_, "skins", skin));
        if (!skins_.contains(instance.skin)) read_skin(instance.skin);
        require_joints(instance);
    }
    instances_.push_back(instance);
    for (const Primitive& primitive : meshes_.at(instance.mesh)) vertex_count_ += primitive.positions.size();
    if (vertex_count_ > kMostVertices)
        throw InputError(fmt::format("it shows more than {} vertices", kMostVertices));
}

void GltfFigure::read_mesh(std::size_t mesh)
{
    std::vector<Primitive>& primitives = meshes_[mesh];
    for (const json& primitive : gltf_member(gltf_member(*file_, "meshes")[mesh], "primitives"))
        primitives.push_back(
            read_primitive(primitive, fmt::format("mesh {}, primitive {}", mesh, primitives.size())));
    for (const Primitive& primitive : primitives)
        if (primitive.targets.size() != primitives[0].targets.size())
            throw InputError(
                fmt::format("the primitives of mesh {} have {} and {} morph targets; allowed: as many", mesh,
                            primitives[0].targets.size(), primitive.targets.size()));
}

GltfFigure::Primitive GltfFigure::read_primitive(const json& primitive, const std::string& what)
{
    if (is_packed(primitive))
        throw InputError(what +
                         " is compressed (KHR_draco_mesh_compression), and only its pose at rest is read; "
                         "allowed: uncompressed meshes");
    const json& attributes = gltf_member(primitive, "attributes");
    Primitive read;
    const std::vector<double> places =
        accessors_->read(gltf_member(attributes, "POSITION"), {"VEC3", kVectors}, what);
    for (std::size_t k = 0; k < places.size(); k += 3)
        read.positions.emplace_back(places[k], places[k + 1], places[k + 2]);
    for (const json& target : gltf_member(primitive, "targets")) {
        std::vector<Eigen::Vector3f>& moves = read.targets.emplace_back();
        const json& position = gltf_member(target, "POSITION");
        if (position.is_null()) continue;
        const std::string named = fmt::format("{}, target {}", what, read.targets.size() - 1);
        const std::vector<double> numbers = accessors_->read(position, {"VEC3", kVectors}, named);
        if (numbers.size() != places.size())
            throw InputError(fmt::format("{} moves {} vertices; allowed: {}, as many as there are", named,
                                         numbers.size() / 3, read.positions.size()));
        for (std::size_t k = 0; k < numbers.size(); k += 3)
            moves.push_back(Vec3(numbers[k], numbers[k + 1], numbers[k + 2]).cast<float>());
        move_count_ += moves.size();
        if (move_count_ > kMostMoves)
            throw InputError(fmt::format("its morph targets move more than {} vertices", kMostMoves));
    }
    read_influences(attributes, read, what);
    return read;
}

void GltfFigure::read_influences(const json& attributes, Primitive& primitive, const std::string& what)
{
    const GltfForm of_joints = {"VEC4", {kGltfUnsignedByte, kGltfUnsignedShort}};
    const GltfForm of_weights = {"VEC4", {kGltfUnsignedByte, kGltfUnsignedShort, kGltfSingle}};
    if (!gltf_member(attributes, fmt::format("JOINTS_{}", kMostSets).c_str()).is_null())
        throw InputError(fmt::format("{} has more than {} joints a vertex", what, 4 * kMostSets));
    std::vector<std::vector<double>> joints, weights;
    for (std::size_t set = 0; set < kMostSets; ++set) {
        const json& joint = gltf_member(attributes, fmt::format("JOINTS_{}", set).c_str());
        if (joint.is_null()) break;
        joints.push_back(accessors_->read(joint, of_joints, what));
        weights.push_back(accessors_->read(gltf_member(attributes, fmt::format("WEIGHTS_{}", set).c_str()),
                                           of_weights, what));
        if (joints.back().size() != 4 * primitive.positions.size() ||
            weights.back().size() != joints.back().size())
            throw InputError(fmt::format("{} has joints for {} vertices and weights for {}; allowed: {}",
                                         what, joints.back().size() / 4, weights.back().size() / 4,
                                         primitive.positions.size()));
    }
    primitive.sets = joints.size();
    if (joints.empty()) return;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
        double sum = 0.0;
        for (const std::vector<double>& set : weights)
            for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
                if (!(set[k] >= 0.0))
                    throw InputError(
                        fmt::format("{}: vertex {} has weight {}; allowed: at least 0", what, v, set[k]));
                sum += set[k];
            }
        if (!(sum > 0.0))
            throw InputError(fmt::format("{}: the weights of vertex {} are 0; allowed: a sum of 1", what, v));
        for (std::size_t set = 0; set < joints.size(); ++set)
            for (std::size_t k = 4 * v; k < 4 * v + 4; ++k)
                primitive.influences.push_back({static_cast<int>(joints[set][k]), weights[set][k] / sum});
    }
}

void GltfFigure::read_skin(int skin)
{
    Skin& read = skins_[skin];
    const json& stated = gltf_member(*file_, "skins")[skin];
    for (const json& joint : gltf_member(stated, "joints"))
        read.joints.push_back(static_cast<int>(index_in(*file_, "nodes", joint)));
    read.inverse.assign(read.joints.size(), Placement4::Identity());
    const json& matrices = gltf_member(stated, "inverseBindMatrices");
    if (matrices.is_null()) return;
    const std::string what = fmt::format("skin {}", skin);
    const std::vector<double> numbers = accessors_->read(matrices, {"MAT4", {kGltfSingle}}, what);
    if (numbers.size() < 16 * read.joints.size())
        throw InputError(fmt::format("{} has {} inverse bind matrices; allowed: one for each of {} joints",
                                     what, numbers.size() / 16, read.joints.size()));
    for (std::size_t k = 0; k < read.joints.size(); ++k) read.inverse[k] = to_matrix(&numbers[16 * k]);
}

void GltfFigure::require_joints(const Instance& instance) const
{
    const std::size_t count = skins_.at(instance.skin).joints.size();
    const std::vector<Primitive>& primitives = meshes_.at(instance.mesh);
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        const std::string what = fmt::format("mesh {}, primitive {}", instance.mesh, p);
        const std::vector<Influence>& influences = primitives[p].influences;
        if (influences.empty() && !primitives[p].positions.empty())
            throw InputError(fmt::format("{} has no JOINTS_0 for skin {}", what, instance.skin));
        for (std::size_t k = 0; k < influences.size(); ++k)
            if (static_cast<std::size_t>(influences[k].joint) >= count)
                throw InputError(fmt::format("{}: vertex {} names joint {} of skin {}, but there are {}",
                                             what, k / (4 * primitives[p].sets), influences[k].joint,
                                             instance.skin, count));
    }
}

std::vector<double> GltfFigure::rest_weights(std::size_t node) const
{
    const json& stated = gltf_member(*file_, "nodes")[node];
    const json& mesh = gltf_member(stated, "mesh");
    if (mesh.is_null() || !meshes_.contains(index_in(*file_, "meshes", mesh))) return {};
    const std::vector<Primitive>& primitives = meshes_.at(mesh.get<std::size_t>());
    const std::size_t count = primitives.empty() ? 0 : primitives[0].targets.size();
    const json& owner =
        gltf_member(stated, "weights").is_null() ? gltf_element(*file_, "meshes", mesh) : stated;
    std::vector<double> weights =
        gltf_numbers(owner, "weights", count, fmt::format("node {} or its mesh", node));
    weights.resize(count, 0.0);
    return weights;
}

GltfFigure::Placements GltfFigure::find_placements(const GltfPose& pose) const
{
    Placements placements(nodes_.size());
    for (const std::size_t n : order_) {
        const Node& node = nodes_[n];
        const Placement4 own = node.has_matrix ? node.matrix : to_matrix(pose[n]);
        placements[n] = node.parent < 0 ? own : Placement4(placements[node.parent] * own);
    }
    return placements;
}

void GltfFigure::place(const GltfPose& pose, std::vector<Vec3>& vertices) const
{
    vertices.clear();
    const Placements placements = find_placements(pose);
    for (const Instance& instance : instances_) {
        Placements of_joints = {placements[instance.node]};
        if (instance.skin >= 0) {
            const Skin& skin = skins_.at(instance.skin);
            of_joints.clear();
            for (std::size_t k = 0; k < skin.joints.size(); ++k)
                of_joints.push_back(placements[skin.joints[k]] * skin.inverse[k]);
        }
        for (const Primitive& primitive : meshes_.at(instance.mesh))
            place(primitive, instance.skin >= 0, pose[instance.node].weights, of_joints, vertices);
    }
}

void GltfFigure::place(const Primitive& primitive, bool has_skin, const std::vector<double>& weights,
                       const Placements& placements, std::vector<Vec3>& vertices)
{
    const std::size_t first = vertices.size(), count = primitive.positions.size();
    vertices.insert(vertices.end(), primitive.positions.begin(), primitive.positions.end());
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
        const std::vector<Eigen::Vector3f>& moves = primitive.targets[t];
        if (moves.empty() || !(std::abs(weights[t]) > 0.0)) continue;
        for (std::size_t v = 0; v < count; ++v) vertices[first + v] += weights[t] * moves[v].cast<double>();
    }
    const std::size_t each = 4 * primitive.sets;
    for (std::size_t v = 0; v < count; ++v) {
        Vec3& vertex = vertices[first + v];
        Placement4 placement = Placement4::Zero();
        if (has_skin)
            for (std::size_t k = each * v; k < each * (v + 1); ++k)
                placement += primitive.influences[k].weight * placements[primitive.influences[k].joint];
        else
            placement = placements[0];
        vertex = (placement * vertex.homogeneous()).head<3>();
    }
}

bool is_posed_gltf(const json& file)
{
    const json& nodes = gltf_member(file, "nodes");
    for (const std::size_t n : shown_gltf_nodes(file)) {
        if (gltf_member(nodes[n], "mesh").is_null()) continue;
        if (!gltf_member(nodes[n], "skin").is_null()) return true;
        for (const json& weight : weights_of(file, nodes[n]))
            if (weight != 0) return true;
    }
    return false;
}

bool is_packed_gltf(const json& file)
{
    for (const json& mesh : gltf_member(file, "meshes"))
        for (const json& primitive : gltf_member(mesh, "primitives"))
            if (is_packed(primitive)) return true;
    return false;
}

}  // namespace arris
