// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/crossings.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "app/files/atomic_file.h"
#include "app/text/printable.h"
#include "geometry/check/penetration.h"
#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_touch.h"
#include "geometry/self_contact/self_intersection.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr std::string_view kFirstLine = "# Arris: what crosses or touches at time 0, in m\n";

/// An OBJ file in which each object has the vertices that it uses.
class ObjText {
  public:
    void begin(const std::string& name)
    {
        text_ += fmt::format("o {}\n", name);
        numbers_.clear();
    }

    /// Adds a face, segment or point of an object's `points`; `statement` is f, l or p.
    template <class Indices>
    void add(char statement, const Indices& indices, const std::vector<Vec3>& points)
    {
        std::string line(1, statement);
        for (const int i : indices) {
            const auto [number, is_new] = numbers_.try_emplace(i, count_ + 1);
            if (is_new) {
                const Vec3& x = points[static_cast<std::size_t>(i)];
                text_ += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
                ++count_;
            }
            line += fmt::format(" {}", number->second);
        }
        text_ += line + "\n";
    }

    const std::string& text() const { return text_; }

  private:
    std::string text_{kFirstLine};
    std::map<int, int> numbers_;  ///< of the object's points, counted from 1
    int count_ = 0;               ///< vertices so far
};

/// Elements of an obstacle that meet the cloth.
struct Met {
    std::set<int> faces, segments, points;
};

/// Adds the faces of the cloth that meet an obstacle to `cloth`.
Met find_met(const ObstaclePose& pose, const ClothMesh& mesh, std::set<int>& cloth)
{
    const std::vector<Vec3> places = to_local(pose.placement, mesh.world);
    Met met;
    ObstacleTouch touch;
    bool is_touching = false;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto& [a, b, c] = mesh.faces[static_cast<std::size_t>(f)];
        find_touches(pose, {places[a], places[b], places[c]}, touch);
        if (!touch.is_any()) continue;
        is_touching = true;
        cloth.insert(f);
        met.faces.insert(touch.faces.begin(), touch.faces.end());
        met.segments.insert(touch.segments.begin(), touch.segments.end());
        met.points.insert(touch.lone_points.begin(), touch.lone_points.end());
    }
    if (is_touching) return met;
    if (const Penetration inside = find_penetration(pose, places, mesh.faces); inside.is_any())
        cloth.insert(inside.face);
    return met;
}

void require_own_file(const std::string& path)
{
    if (!path.empty() && !std::filesystem::exists(path)) return;
    std::string begin(kFirstLine.size(), '\0');
    if (std::filesystem::is_regular_file(path))  // reading a pipe would wait
        std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (begin != kFirstLine)
        throw InputError(fmt::format("--crossings '{}': is {}; allowed: the name of a new file",
                                     printable(path),
                                     path.empty() ? "no name" : "there, and is not a file of crossings"));
}

}  // namespace

void write_crossings(const std::string& path, const RunConfig& config)
{
    require_own_file(path);
    const ClothMesh mesh = make_state(config.scene, config.cloth, config.cloth_velocity).mesh;
    std::set<int> cloth;
    if (config.scene.self_contact)
        for (const auto& pair : find_self_intersections(mesh.world, mesh.faces))
            cloth.insert(pair.begin(), pair.end());
    std::vector<Met> met;
    for (const MovingObstacle& obstacle : config.scene.obstacles)
        met.push_back(find_met(obstacle.at(0.0), mesh, cloth));

    ObjText text;
    text.begin("cloth");
    for (const int f : cloth) text.add('f', mesh.faces[static_cast<std::size_t>(f)], mesh.world);
    for (std::size_t o = 0; o < met.size(); ++o) {
        const MovingObstacle& obstacle = config.scene.obstacles[o];
        const ObstaclePose pose = obstacle.at(0.0);
        const std::vector<Vec3> points = obstacle.points_at(0.0);
        text.begin(obstacle.name());
        for (const int f : met[o].faces)
            text.add('f', pose->mesh().faces[static_cast<std::size_t>(f)], points);
        for (const int e : met[o].segments)
            text.add('l', pose->topology().edges[static_cast<std::size_t>(e)].points, points);
        for (const int p : met[o].points) text.add('p', std::array{p}, points);
    }
    write_atomically(path, text.text());
}

}  // namespace arris
