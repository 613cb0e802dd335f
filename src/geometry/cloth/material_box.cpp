// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/cloth/material_locator.h"

namespace arris {
namespace {

MaterialBox bounding_box(const std::vector<Vec2>& material)
{
    MaterialBox box{material.front(), material.front()};
    for (const Vec2& X : material) {
        box.min = box.min.cwiseMin(X);
        box.max = box.max.cwiseMax(X);
    }
    return box;
}

// Load gathered on vertices; normalised once, at the end. Extended precision so that 1e6 shares sum to 1.
class ShareSum {
  public:
    explicit ShareSum(const ClothMesh& mesh) : mesh_(mesh), weight_(mesh.vertex_count(), 0.0L) {}

    void add(int f, const Vec3& weights)
    {
        const Face& face = mesh_.faces[f];
        for (int k = 0; k < 3; ++k) {
            weight_[face[k]] += static_cast<long double>(weights[k]);
            total_ += static_cast<long double>(weights[k]);
        }
        if (weights.maxCoeff() > 0.0) by_face_.push_back({f, weights});
    }

    bool is_empty() const { return !(total_ > 0.0L); }

    std::vector<LoadShare> shares() const
    {
        std::vector<LoadShare> result;
        for (int v = 0; v < static_cast<int>(weight_.size()); ++v)
            if (weight_[v] > 0.0L) result.push_back({v, static_cast<double>(weight_[v] / total_)});
        return result;
    }

    std::vector<FaceShare> face_shares() const
    {
        std::vector<FaceShare> result = by_face_;
        for (FaceShare& share : result) share.weights /= static_cast<double>(total_);
        return result;
    }

  private:
    const ClothMesh& mesh_;
    std::vector<FaceShare> by_face_;
    std::vector<long double> weight_;
    long double total_ = 0.0L;
};

// A corner of a face that is being clipped: its material position and its barycentric coordinates.
struct ClipPoint {
    Vec2 X;
    Vec3 weights;
};

struct ClipPolygon {
    std::array<ClipPoint, 8> points;  // a triangle clipped by four half planes has at most 7
    int count = 0;

    void push(const ClipPoint& p) { points[count++] = p; }
};

ClipPoint interpolate(const ClipPoint& p, const ClipPoint& q, double s)
{
    return {p.X + s * (q.X - p.X), p.weights + s * (q.weights - p.weights)};
}

ClipPolygon corners_of(const ClothMesh& mesh, int face)
{
    ClipPolygon polygon;
    const std::array<Vec2, 3> corners = mesh.corners(face);
    for (int k = 0; k < 3; ++k) polygon.push({corners[k], Vec3::Unit(k)});
    return polygon;
}

// Sutherland-Hodgman against sign * (X[axis] - bound) >= 0.
ClipPolygon clip(const ClipPolygon& polygon, int axis, double bound, double sign)
{
    ClipPolygon kept;
    for (int k = 0; k < polygon.count; ++k) {
        const ClipPoint& p = polygon.points[k];
        const ClipPoint& q = polygon.points[(k + 1) % polygon.count];
        const double dp = sign * (p.X[axis] - bound);
        const double dq = sign * (q.X[axis] - bound);
        if (dp >= 0.0) kept.push(p);
        if ((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0)) {
            ClipPoint crossing = interpolate(p, q, dp / (dp - dq));
            crossing.X[axis] = bound;
            kept.push(crossing);
        }
    }
    return kept;
}

// Integrals of a face's three shape functions over its part inside the box.
Vec3 integrate_area(const ClothMesh& mesh, int face, const MaterialBox& box)
{
    ClipPolygon polygon = corners_of(mesh, face);
    for (int axis = 0; axis < 2; ++axis) {
        polygon = clip(polygon, axis, box.min[axis], 1.0);
        polygon = clip(polygon, axis, box.max[axis], -1.0);
    }
    Vec3 integral = Vec3::Zero();
    for (int k = 1; k + 1 < polygon.count; ++k) {
        const ClipPoint& a = polygon.points[0];
        const ClipPoint& b = polygon.points[k];
        const ClipPoint& c = polygon.points[k + 1];
        const double area = 0.5 * twice_area(a.X, b.X, c.X);
        integral += area / 3.0 * (a.weights + b.weights + c.weights);
    }
    return integral.cwiseMax(0.0);
}

bool overlaps(const ClothMesh& mesh, int face, const MaterialBox& box)
{
    const auto [a, b, c] = mesh.corners(face);
    return (a.cwiseMin(b).cwiseMin(c).array() <= box.max.array()).all() &&
           (a.cwiseMax(b).cwiseMax(c).array() >= box.min.array()).all();
}

void spread_by_area(const ClothMesh& mesh, const MaterialBox& box, ShareSum& sum)
{
    for (int f = 0; f < mesh.face_count(); ++f)
        if (overlaps(mesh, f, box)) sum.add(f, integrate_area(mesh, f, box));
}

// The part of an axis-parallel line inside one face, from `begin` to `end`.
struct LinePart {
    ClipPoint begin, end;
    int face;
};

// `axis` is the line's direction; in the other direction box.min equals box.max.
std::optional<LinePart> clip_line(const ClothMesh& mesh, int f, const MaterialBox& box, int axis)
{
    const int across = 1 - axis;
    ClipPolygon polygon = corners_of(mesh, f);
    polygon = clip(polygon, across, box.min[across], 1.0);
    polygon = clip(polygon, across, box.min[across], -1.0);
    polygon = clip(polygon, axis, box.min[axis], 1.0);
    polygon = clip(polygon, axis, box.max[axis], -1.0);
    if (polygon.count < 2) return std::nullopt;
    const auto ahead = [axis](const ClipPoint& p, const ClipPoint& q) { return p.X[axis] < q.X[axis]; };
    const auto [first, last] =
        std::minmax_element(polygon.points.begin(), polygon.points.begin() + polygon.count, ahead);
    if (!ahead(*first, *last)) return std::nullopt;
    return LinePart{*first, *last, f};
}

// A line along a mesh edge lies in two faces. Each stretch counts once: for the first part that covers it, in
// the order in which parts begin.
void spread_by_length(const ClothMesh& mesh, const MaterialBox& box, int axis, ShareSum& sum)
{
    std::vector<LinePart> parts;
    for (int f = 0; f < mesh.face_count(); ++f) {
        if (!overlaps(mesh, f, box)) continue;
        if (const auto part = clip_line(mesh, f, box, axis)) parts.push_back(*part);
    }
    std::stable_sort(parts.begin(), parts.end(), [axis](const LinePart& p, const LinePart& q) {
        return p.begin.X[axis] < q.begin.X[axis];
    });
    double reached = box.min[axis];
    for (const LinePart& part : parts) {
        const double begin = std::max(part.begin.X[axis], reached);
        const double end = part.end.X[axis];
        if (!(end > begin)) continue;
        const double s = (begin - part.begin.X[axis]) / (end - part.begin.X[axis]);
        const Vec3 at_begin = interpolate(part.begin, part.end, s).weights;
        sum.add(part.face, 0.5 * (end - begin) * (at_begin + part.end.weights).cwiseMax(0.0));
        reached = end;
    }
}

// Puts the whole load on the candidate point nearest to `point` (lowest index on ties). The load is listed
// under face `preferred` if the vertex is one of its corners, else under its first face.
void spread_to_nearest_vertex(const ClothMesh& mesh, const std::vector<int>& candidates, const Vec2& point,
                              std::optional<int> preferred, ShareSum& sum)
{
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int p : candidates) {
        const double squared_distance = (mesh.material[p] - point).squaredNorm();
        if (squared_distance < least) {
            least = squared_distance;
            nearest = mesh.vertex_of(p);
        }
    }
    if (nearest < 0) return;
    const auto add_to = [&](int f) {
        const Face& face = mesh.faces[f];
        const auto corner = std::find(face.begin(), face.end(), nearest);
        if (corner == face.end()) return false;
        sum.add(f, Vec3::Unit(corner - face.begin()));
        return true;
    };
    if (preferred && add_to(*preferred)) return;
    for (int f = 0; f < mesh.face_count(); ++f)
        if (add_to(f)) return;
}

void spread_over_point(const ClothMesh& mesh, const Vec2& point, ShareSum& sum)
{
    const int face = locate(mesh, point).face;
    if (face < 0) return;
    std::vector<int> all(mesh.material.size());
    for (int v = 0; v < static_cast<int>(all.size()); ++v) all[v] = v;
    spread_to_nearest_vertex(mesh, all, point, face, sum);
}

std::vector<int> points_in_box(const ClothMesh& mesh, const MaterialBox& box)
{
    const double tolerance = kMaterialTolerance * material_size(mesh.material);
    std::vector<int> inside;
    for (int p = 0; p < static_cast<int>(mesh.material.size()); ++p)
        if (box.contains(mesh.material[p], tolerance)) inside.push_back(p);
    return inside;
}

// For a box that only touches the cloth from outside: spreads along the box's sides, else to the nearest
// vertex.
void spread_over_sides(const ClothMesh& mesh, const MaterialBox& box, ShareSum& sum)
{
    for (int axis = 0; axis < 2; ++axis) {
        for (const double bound : {box.min[1 - axis], box.max[1 - axis]}) {
            MaterialBox side = box;
            side.min[1 - axis] = side.max[1 - axis] = bound;
            if (box.max[axis] > box.min[axis]) spread_by_length(mesh, side, axis, sum);
        }
    }
    if (!sum.is_empty()) return;
    spread_to_nearest_vertex(mesh, points_in_box(mesh, box), 0.5 * (box.min + box.max), std::nullopt, sum);
}

// The part of the box within the cloth's bounding box. A side no longer than the tolerance gets length zero.
std::optional<MaterialBox> part_near_cloth(const ClothMesh& mesh, const MaterialBox& box)
{
    const double tolerance = kMaterialTolerance * material_size(mesh.material);
    const MaterialBox bounds = bounding_box(mesh.material);
    MaterialBox part{box.min.cwiseMax(bounds.min), box.max.cwiseMin(bounds.max)};
    for (int axis = 0; axis < 2; ++axis) {
        const double length = part.max[axis] - part.min[axis];
        if (!(length >= -tolerance)) return std::nullopt;
        if (length > tolerance) continue;
        const double middle = 0.5 * (part.min[axis] + part.max[axis]);
        part.min[axis] = part.max[axis] = std::clamp(middle, bounds.min[axis], bounds.max[axis]);
    }
    return part;
}

ShareSum spread(const ClothMesh& mesh, const MaterialBox& box)
{
    ShareSum sum(mesh);
    if (mesh.faces.empty()) return sum;
    const auto part = part_near_cloth(mesh, box);
    if (!part) return sum;
    const Vec2 extent = part->max - part->min;
    if (!(extent.maxCoeff() > 0.0)) {
        spread_over_point(mesh, part->min, sum);
        return sum;
    }
    if (extent.minCoeff() > 0.0) {
        spread_by_area(mesh, *part, sum);
    } else {
        spread_by_length(mesh, *part, extent.x() > 0.0 ? 0 : 1, sum);
    }
    if (sum.is_empty()) spread_over_sides(mesh, *part, sum);
    return sum;
}

}  // namespace

double material_size(const std::vector<Vec2>& material)
{
    if (material.empty()) return 0.0;
    const MaterialBox box = bounding_box(material);
    return (box.max - box.min).maxCoeff();
}

std::vector<LoadShare> spread_over_box(const ClothMesh& mesh, const MaterialBox& box)
{
    return spread(mesh, box).shares();
}

std::vector<FaceShare> spread_over_faces(const ClothMesh& mesh, const MaterialBox& box)
{
    return spread(mesh, box).face_shares();
}

}  // namespace arris
