// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/mesh_poses.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/tolerances.h"
#include "geometry/up_axis.h"

namespace arris {
namespace {

// Edges of an animated body seldom double. Edges of a wrong order, or of centimetres taken for metres, differ
// far more. Raising it accepts worse mistakes.
constexpr double kMostStretch = 3.0;

/// Whether the face is lower than the rounding of a file, relative to its longest edge.
bool is_collapsed(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).norm() > kSinglePrecision * longest);
}

/// Whether each side of a face is a side of one other face.
bool is_closed(const std::vector<Face>& faces)
{
    std::vector<std::array<int, 2>> sides;
    for (const auto& [a, b, c] : faces)
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            sides.push_back({std::min(p, q), std::max(p, q)});
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); i += 2)
        if (i + 1 == sides.size() || sides[i] != sides[i + 1]) return false;
    return true;
}

}  // namespace

MeshPoses::MeshPoses(VertexCache& cache, const ObstacleMesh& mesh, const VertexOrigins& origins,
                     const FileFrame& frame)
    : cache_(cache), mesh_(mesh), origins_(origins), frame_(frame), turn_(turn_to_z(frame.up))
{
    const auto made = std::count(origins.of_points.begin(), origins.of_points.end(), -1);
    if (made > 0)
        throw InputError(
            fmt::format("{} of its points come from the mesh's repair, not from a vertex of the "
                        "file; allowed: a mesh whose faces have areas",
                        made));
}

void MeshPoses::refuse(const std::string& why) const
{
    throw InputError(cache_.describe(next_) + ", " + why);
}

// As the importer places the mesh, and the scene's scale then enlarges it.
Vec3 MeshPoses::place(int vertex) const
{
    const Vec3& p = vertices_[static_cast<std::size_t>(vertex)];
    const Vec3 placed = frame_.scale * Vec3(turn_ * (frame_.metres_per_unit * p));
    if (!placed.allFinite() || placed.cwiseAbs().maxCoeff() > kLargestCoordinate)
        refuse(fmt::format("vertex {} ({:g}, {:g}, {:g}): allowed: finite and within {:g} m of the origin",
                           vertex + 1, p.x(), p.y(), p.z(), kLargestCoordinate));
    return placed;
}

void MeshPoses::read_next(std::vector<Vec3>& points)
{
    cache_.read(next_, vertices_);
    points.resize(origins_.of_points.size());
    for (std::size_t p = 0; p < points.size(); ++p) points[p] = place(origins_.of_points[p]);
    require_joined();
    if (next_ == 0) {
        require_similar(points);
        require_same_hand(points);
    }
    measure(points);
    second_last_ = std::exchange(last_, points);
    ++next_;
}

void MeshPoses::require_joined() const
{
    const double tolerance = frame_.scale * origins_.tolerance;
    for (const auto& [kept, other] : origins_.joined) {
        const double gap = (place(other) - place(kept)).norm();
        if (!(gap <= tolerance))
            refuse(fmt::format(
                "vertices {} and {} are {:.3g} m apart, but are one point of the mesh, where they "
                "coincide; allowed: at most {:.2g} m",
                kept + 1, other + 1, gap, tolerance));
    }
}

void MeshPoses::require_similar(const std::vector<Vec3>& points) const
{
    std::vector<double> ratios;
    const auto add = [&](int a, int b) {
        const double length = (mesh_.points[b] - mesh_.points[a]).norm();
        if (length > 0.0) ratios.push_back((points[b] - points[a]).norm() / length);
    };
    for (const auto& [a, b, c] : mesh_.faces) {
        add(a, b);
        add(b, c);
        add(c, a);
    }
    for (const auto& [a, b] : mesh_.segments) add(a, b);
    if (ratios.empty()) return;
    // The ratio itself for the message; the factor, up or down, for the decision.
    const auto median = [](std::vector<double>& values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    const double ratio = median(ratios);
    for (double& r : ratios) r = r < 1.0 ? 1.0 / r : r;
    if (median(ratios) <= kMostStretch) return;
    refuse(fmt::format(
        "its edges are {:.3g} times as long as the mesh's in the median: another unit, or another "
        "order of the vertices; allowed: a factor of at most {:g}",
        ratio, kMostStretch));
}

// Cloth would be outside where the body is. A body never turns inside out: its cache was mirrored, or its
// vertices have another order.
void MeshPoses::require_same_hand(const std::vector<Vec3>& points) const
{
    const auto volume = [&](const std::vector<Vec3>& of) {
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh_.faces)
            sum += (of[a] - of[0]).dot((of[b] - of[0]).cross(of[c] - of[0]));
        return sum / 6.0;
    };
    if (mesh_.faces.empty() || !is_closed(mesh_.faces)) return;
    const double own = volume(mesh_.points), now = volume(points);
    if (!(own * now < 0.0)) return;
    refuse(fmt::format(
        "the mesh is turned inside out, with a volume of {:.3g} m^3 for {:.3g}: mirrored, other axes, or "
        "another order of the vertices; allowed: positions in the mesh's own axes and order",
        now, own));
}

void MeshPoses::measure(const std::vector<Vec3>& points)
{
    int collapsed = 0;
    for (const auto& [a, b, c] : mesh_.faces)
        if (is_collapsed(points[a], points[b], points[c])) ++collapsed;
    if (collapsed > survey_.most_collapsed) {
        survey_.most_collapsed = collapsed;
        survey_.collapsed_at = next_;
    }
    if (next_ == 0) return;
    double greatest = 0.0;
    std::size_t point = 0;
    for (std::size_t p = 0; p < points.size(); ++p)
        if (const double move = (points[p] - last_[p]).norm(); move > greatest) {
            greatest = move;
            point = p;
        }
    const double duration = cache_.times()[next_] - cache_.times()[next_ - 1];
    survey_.greatest_speed = std::max(survey_.greatest_speed, greatest / duration);
    if (greatest > survey_.greatest_move) {
        survey_.greatest_move = greatest;
        survey_.moved_at = next_;
        survey_.moved_vertex = origins_.of_points[point];
    }
    if (next_ == 1) return;
    const double before = cache_.times()[next_ - 1] - cache_.times()[next_ - 2];
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3 gained = (points[p] - last_[p]) / duration - (last_[p] - second_last_[p]) / before;
        const double acceleration = 2.0 * gained.norm() / (duration + before);
        if (!(acceleration > survey_.greatest_acceleration)) continue;
        survey_.greatest_acceleration = acceleration;
        survey_.accelerated_at = next_ - 1;
    }
}

}  // namespace arris
