// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/gltf_obstacle.h"

#include <vector>

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

/// Reads the points of an obstacle, in its frame.
class Poses {
  public:
    Poses(const std::string& path, const ObstacleRecord& obstacle, const GltfTimeline& timeline)
        : path_(path + ": " + obstacle.name),
          obstacle_(obstacle),
          timeline_(timeline),
          first_(obstacle.points_at(0.0))
    {
    }

    std::size_t point_count() const { return first_.size(); }

    /// The points of frame 0, or the difference of frame i from them.
    std::vector<Float3> read(std::size_t i) const
    {
        const std::vector<Vec3> points = i == 0 ? first_ : obstacle_.points_at(timeline_.time(i));
        std::vector<Float3> result;
        for (std::size_t p = 0; p < points.size(); ++p)
            result.push_back(to_float3(path_, i, p, i == 0 ? points[p] : points[p] - first_[p]));
        return result;
    }

  private:
    std::string path_;
    const ObstacleRecord& obstacle_;
    const GltfTimeline& timeline_;
    std::vector<Vec3> first_;
};

/// Describes the points: fixed, or streamed if the obstacle deforms.
GltfShapes add_points(GltfAsset& asset, const Poses& poses, bool is_deforming, std::size_t frame_count)
{
    if (is_deforming)
        return asset.add_shapes(frame_count, poses.point_count(), {"POSITION"},
                                [&](std::size_t i) { return poses.read(i); });
    GltfShapes shapes;
    shapes.attributes["POSITION"] = asset.add_positions(poses.read(0));
    return shapes;
}

/// The mesh of an obstacle, in its frame; null if it has no points.
Json add_mesh(GltfAsset& asset, const Poses& poses, const ObstacleRecord& obstacle, std::size_t frame_count,
              std::size_t material)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    if (mesh.points.empty()) return nullptr;
    const GltfShapes shapes = add_points(asset, poses, obstacle.is_deforming(), frame_count);
    std::vector<std::array<int, 1>> lone_points;
    for (const int v : mesh.lone_points) lone_points.push_back({v});
    Json primitives = Json::array();
    const auto add = [&](int mode, const auto& cells) {
        if (cells.empty()) return;
        const std::size_t indices = asset.add("SCALAR", kGltfUnsigned, to_indices(cells), kGltfIndexArray);
        primitives.push_back({{"attributes", shapes.attributes},
                              {"indices", indices},
                              {"mode", mode},
                              {"material", material}});
    };
    add(kGltfTriangles, mesh.faces);
    add(kGltfLines, mesh.segments);
    add(kGltfPoints, lone_points);
    if (primitives.empty()) return nullptr;
    return asset.add_mesh(obstacle.name, std::move(primitives), shapes);
}

}  // namespace

std::array<float, 4> to_float4(const Eigen::Quaterniond& q)
{
    return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
            static_cast<float>(q.w())};
}

std::size_t add_gltf_obstacle(GltfAsset& asset, const std::string& path, const ObstacleRecord& obstacle,
                              const GltfTimeline& timeline, std::size_t material)
{
    std::vector<Float3> translations;
    std::vector<std::array<float, 4>> rotations;
    Eigen::Quaterniond previous = Eigen::Quaterniond::Identity();
    for (std::size_t i = 0; i < (obstacle.motion.is_moving() ? timeline.frame_count : 1); ++i) {
        const Placement place = obstacle.at(timeline.time(i));
        Eigen::Quaterniond turned(place.rotation);
        turned.normalize();
        if (turned.dot(previous) < 0.0)
            turned.coeffs() = -turned.coeffs();  // the same rotation, the shorter arc
        previous = turned;
        rotations.push_back(to_float4(turned));
        translations.push_back(to_float3(path + ": " + obstacle.name, i, 0, place.translation));
    }
    Json node = {{"name", obstacle.name}, {"translation", translations.at(0)}, {"rotation", rotations.at(0)}};
    const Json mesh = add_mesh(asset, {path, obstacle, timeline}, obstacle, timeline.frame_count, material);
    const bool is_shown = !mesh.is_null();
    if (is_shown) node["mesh"] = mesh;
    const std::size_t index = asset.append("nodes", node);
    if (translations.size() > 1) {
        asset.add_channel(timeline.times, asset.add("VEC3", kGltfFloat, translations), index, "translation");
        asset.add_channel(timeline.times, asset.add("VEC4", kGltfFloat, rotations), index, "rotation");
    }
    if (is_shown && obstacle.is_deforming() && timeline.frame_count > 1)
        asset.add_channel(timeline.times, timeline.weights, index, "weights");
    return index;
}

void write_gltf_poses(AtomicFile& file, const std::string& path, const ObstacleRecord& obstacle,
                      const GltfTimeline& timeline)
{
    if (!obstacle.is_deforming()) return;
    const Poses poses(path, obstacle, timeline);
    for (std::size_t i = 0; i < timeline.frame_count; ++i) file.write(bytes_of(poses.read(i)));
}

}  // namespace arris
