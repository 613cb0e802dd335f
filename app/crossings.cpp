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

#include "app/export/viewer_html.h"
#include "app/files/atomic_file.h"
#include "app/run/state_readings.h"
#include "app/scene/scene_load.h"
#include "app/text/counted.h"
#include "app/text/printable.h"
#include "geometry/check/penetration.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_touch.h"
#include "geometry/self_contact/self_intersection.h"
#include "physics/elements/cloth_elements.h"
#include "physics/forces/make_terms.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr std::string_view kFirstLine = "# Arris: what crosses or touches at time 0, in m\n";
constexpr std::string_view kFirstPageLine = "<!-- Arris: what crosses or touches at time 0 -->\n";

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

/// Elements of one thing, with the points that they use.
class Gathering {
  public:
    explicit Gathering(const std::string& name) : record_{name, {}, {}, {}} {}

    /// Numbers `indices` of `points` anew, in the order of their first use.
    template <class Indices>
    Indices add(Indices indices, const std::vector<Vec3>& points)
    {
        std::vector<Vec3>& own = record_.mesh.points;
        for (int& i : indices) {
            const auto [number, is_new] = numbers_.try_emplace(i, static_cast<int>(own.size()));
            if (is_new) own.push_back(points[static_cast<std::size_t>(i)]);
            i = number->second;
        }
        return indices;
    }

    ObstacleMesh& mesh() { return record_.mesh; }
    const ObstacleRecord& record() const { return record_; }

  private:
    ObstacleRecord record_;
    std::map<int, int> numbers_;
};

/// What crosses, at rest in the world: of the cloth, then of each obstacle.
std::vector<ObstacleRecord> gather_crossings(const Scene& scene, const ClothMesh& cloth)
{
    std::set<int> faces;
    if (scene.self_contact)
        for (const auto& pair : find_self_intersections(cloth.world, cloth.faces))
            faces.insert(pair.begin(), pair.end());
    std::vector<ObstacleRecord> crossings(1);
    for (const MovingObstacle& obstacle : scene.obstacles) {
        const ObstaclePose pose = obstacle.at(0.0);
        const std::vector<Vec3> points = obstacle.points_at(0.0);
        const Met met = find_met(pose, cloth, faces);
        Gathering gathering(obstacle.name());
        for (const int f : met.faces)
            gathering.mesh().faces.push_back(
                gathering.add(pose->mesh().faces[static_cast<std::size_t>(f)], points));
        for (const int e : met.segments)
            gathering.mesh().segments.push_back(
                gathering.add(pose->topology().edges[static_cast<std::size_t>(e)].points, points));
        for (const int p : met.points)
            gathering.mesh().lone_points.push_back(gathering.add(std::array{p}, points)[0]);
        crossings.push_back(gathering.record());
    }
    Gathering gathering("cloth");
    for (const int f : faces)
        gathering.mesh().faces.push_back(
            gathering.add(cloth.faces[static_cast<std::size_t>(f)], cloth.world));
    crossings.front() = gathering.record();
    return crossings;
}

std::string obj_text(const std::vector<ObstacleRecord>& crossings)
{
    std::string text{kFirstLine};
    int first = 1;  // OBJ counts vertices of all objects from 1
    for (const ObstacleRecord& thing : crossings) {
        text += fmt::format("o {}\n", thing.name);
        for (const Vec3& x : thing.mesh.points) text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
        for (const Face& face : thing.mesh.faces)
            text += fmt::format("f {} {} {}\n", first + face[0], first + face[1], first + face[2]);
        for (const auto& segment : thing.mesh.segments)
            text += fmt::format("l {} {}\n", first + segment[0], first + segment[1]);
        for (const int p : thing.mesh.lone_points) text += fmt::format("p {}\n", first + p);
        first += static_cast<int>(thing.mesh.points.size());
    }
    return text;
}

/// The start with its crossings, to look at.
ViewerStill make_still(const RunConfig& config, const State& state,
                       const std::vector<ObstacleRecord>& crossings)
{
    const Scene& scene = config.scene;
    const ClothElements elements =
        list_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces), HingeUse::Terms,
                      scene.materials);
    ViewerStill still;
    still.frame =
        make_frame(scene.obstacles, state, elements, make_terms(scene.materials, scene.gravity, {}, {}));
    still.obstacles = record_obstacles(config);
    for (const ObstacleRecord& thing : crossings)
        if (!thing.mesh.points.empty()) still.marks.push_back(thing);
    const std::size_t faces = crossings.front().mesh.faces.size();
    still.title = fmt::format(
        "{}, time 0: {}", config.title,
        faces == 0 ? "nothing crosses or touches"
                   : counted(faces, "face of cloth crosses or touches", "faces of cloth cross or touch"));
    return still;
}

/// Refuses to replace a file that does not begin with `first_line`.
void require_own_file(const std::string& path, std::string_view first_line)
{
    if (!path.empty() && !std::filesystem::exists(path)) return;
    std::string begin(first_line.size(), '\0');
    if (std::filesystem::is_regular_file(path))  // reading a pipe would wait
        std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (begin != first_line)
        throw InputError(fmt::format("--crossings '{}': is {}; allowed: the name of a new file",
                                     printable(path),
                                     path.empty() ? "no name" : "there, and is not a file of crossings"));
}

}  // namespace

void write_crossings(const std::string& path, const RunConfig& config)
{
    const bool is_page = path.ends_with(".html");
    require_own_file(path, is_page ? kFirstPageLine : kFirstLine);
    const State state = make_state(config.scene, config.cloth, config.cloth_velocity);
    const std::vector<ObstacleRecord> crossings = gather_crossings(config.scene, state.mesh);
    if (is_page)
        write_viewer_still(path, kFirstPageLine, make_still(config, state, crossings));
    else
        write_atomically(path, obj_text(crossings));
}

}  // namespace arris
