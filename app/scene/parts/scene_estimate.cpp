// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_estimate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/scene/parts/obstacle_records.h"

namespace arris {
namespace {

constexpr double kStepTolerance = 1e-9;    // steps: a smaller excess of an interval takes no further step
constexpr double kEventTolerance = 1e-12;  // relative to the time: nearer events count as one

/// Bytes per vertex and per face in one frame of a format, from the length of the written values.
struct FrameBytes {
    std::string_view format;
    double vertex, face;
};
constexpr std::array<FrameBytes, 7> kFormatBytes = {{
    {"obj", 110.0, 30.0},   // text: position and texture coordinate, 17 digits each; three index pairs
    {"usd", 150.0, 8.0},    // text: positions and velocities at every frame, topology where it changes
    {"viewer", 24.0, 2.0},  // quantised, base64
    {"vtk", 102.0, 56.0},   // before compression: 12 doubles, an id, two flags; 4 whole numbers, 3 doubles
    {"pc2", 12.0, 0.0},     // three floats
    {"mdd", 12.0, 0.0},     // three floats
    {"gltf", 24.0, 0.0},    // six floats: position and normal
}};
constexpr FrameBytes kPlyBytes = {
    "ply", 94.0, 37.0};  // vertex: 11 doubles, an id, two flags; face: 13 bytes of indices, 3 doubles
constexpr double kRowBytes = 400.0;         // per row of steps.csv and probes.csv together
constexpr double kCheckpointBytes = 200.0;  // per vertex

// Bytes per triangle of an obstacle and half a point (a closed mesh has half as many points as triangles), in
// memory (mesh, topology, search trees), in the file `obstacles` and in one OBJ frame.
constexpr double kObstacleElementBytes = 600.0;
constexpr double kStoredElementBytes = 24.0;
constexpr double kObjElementBytes = 50.0;

}  // namespace

SceneEstimate to_estimate(const GridCount& count)
{
    SceneEstimate estimate;
    estimate.vertices = count.vertices;
    estimate.faces = count.faces;
    return estimate;
}

void refuse_estimate(const SceneDocument& document, const std::string& key, double count,
                     const std::string& what, double most)
{
    document.fail(key, fmt::format("the run would have about {:.7g} {}", count, what),
                  fmt::format("at most {:.7g} {}", most, what));
}

namespace {

/// Length, m, of an edge in the material of its left face.
double material_length(const ClothMesh& cloth, const MeshEdge& edge)
{
    const auto place = [&](int v) { return cloth.material[cloth.point_of(v, edge.face_left)]; };
    return (place(edge.b) - place(edge.a)).norm();
}

}  // namespace

EdgeLengths measure_edges(const ClothMesh& cloth, const MeshTopology& topology)
{
    EdgeLengths lengths;
    lengths.least = std::numeric_limits<double>::infinity();
    for (const MeshEdge& edge : topology.edges) {
        const double length = material_length(cloth, edge);
        lengths.least = std::min(lengths.least, length);
        lengths.greatest = std::max(lengths.greatest, length);
        lengths.mean += length / static_cast<double>(topology.edges.size());
    }
    return lengths;
}

double count_frames(double duration, double frames_per_second)
{
    if (!(frames_per_second > 0.0)) return 0.0;
    return std::floor(duration * frames_per_second + kStepTolerance) + 1.0;
}

double count_steps(double duration, double step, double frames_per_second, const std::vector<double>& jumps)
{
    const auto steps_between = [&](double begin, double end) {
        return std::max(0.0, std::ceil((end - begin) / step - kStepTolerance));
    };
    const double frames = count_frames(duration, frames_per_second);
    double steps = 0.0, time = 0.0, frame = 1.0;
    auto jump = jumps.begin();
    while (time < duration) {
        // Advance to the next frame, jump or end, and pass all events within the tolerance of it.
        double next = frame < frames ? std::min(duration, frame / frames_per_second) : duration;
        if (jump != jumps.end()) next = std::min(next, *jump);
        steps += steps_between(time, next);
        time = next;
        const double passed = next * (1.0 + kEventTolerance);
        while (frame < frames && frame / frames_per_second <= passed) ++frame;
        while (jump != jumps.end() && *jump <= passed) ++jump;
    }
    return steps;
}

void add_obstacles(const std::vector<MovingObstacle>& obstacles, SceneEstimate& estimate)
{
    for (const MovingObstacle& obstacle : obstacles) {
        const ObstacleMesh& mesh = obstacle.shape().mesh();
        const auto elements =
            static_cast<double>(mesh.faces.size() + mesh.segments.size() + mesh.lone_points.size());
        estimate.obstacle_elements += elements;
        if (obstacle.is_moving()) estimate.moving_elements += elements;
        if (obstacle.deformation())
            estimate.pose_bytes += static_cast<double>(count_pose_bytes(*obstacle.deformation()));
    }
}

void estimate_bytes(const std::vector<std::string>& formats, SceneEstimate& estimate)
{
    // The Cholesky factor of a planar mesh under nested dissection has n log n entries. The constants are
    // fitted to whole runs with bending (31, 73 and 377 MB at 2066, 7321 and 39481 vertices); the estimate is
    // some 8 % above these measurements.
    constexpr double kProgramBytes = 2e7, kFactorBytes = 800.0, kSmallMeshBytes = 2300.0;
    const double n = estimate.vertices;
    const double vertex_bytes =
        std::max(kFactorBytes, kFactorBytes * std::log2(std::max(n, 2.0)) - kSmallMeshBytes);
    estimate.memory_bytes =
        kProgramBytes + n * vertex_bytes + kObstacleElementBytes * estimate.obstacle_elements;

    const auto frame_bytes = [&](const FrameBytes& size) {
        return estimate.frames * (size.vertex * estimate.vertices + size.face * estimate.faces);
    };
    estimate.disk_bytes =
        frame_bytes(kPlyBytes) + kRowBytes * estimate.steps + kCheckpointBytes * estimate.vertices;
    for (const FrameBytes& size : kFormatBytes)
        if (std::find(formats.begin(), formats.end(), size.format) != formats.end())
            estimate.disk_bytes += frame_bytes(size);
    estimate.disk_bytes += kStoredElementBytes * estimate.obstacle_elements + estimate.pose_bytes;
    if (std::find(formats.begin(), formats.end(), "obj") != formats.end())
        estimate.disk_bytes += kObjElementBytes * (estimate.obstacle_elements - estimate.moving_elements +
                                                   estimate.frames * estimate.moving_elements);
}

std::optional<Excess> find_memory_excess(const SceneEstimate& estimate, double available)
{
    if (!(estimate.memory_bytes > available)) return std::nullopt;
    return Excess{fmt::format("the run would take about {} of memory for {:.0f} vertices",
                              human_bytes(estimate.memory_bytes), estimate.vertices),
                  fmt::format("at most the {} of this machine", human_bytes(available))};
}

double machine_memory_bytes()
{
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page <= 0) return std::numeric_limits<double>::infinity();
    return static_cast<double>(pages) * static_cast<double>(page);
}

std::string human_bytes(double bytes)
{
    constexpr std::array<std::string_view, 5> kUnits = {"B", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    for (; bytes >= 999.5 && unit + 1 < kUnits.size(); ++unit) bytes /= 1000.0;
    return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace arris
