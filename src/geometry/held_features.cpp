// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/held_features.h"

#include <algorithm>
#include <limits>

#include "geometry/closest_point.h"
#include "geometry/feature_nodes.h"

namespace arris {
namespace {

// Thicknesses to each side of a held vertex within which cloth that is joined to it may touch the wire: an
// edge that leaves it at 6 degrees to the wire passes the wire's line there.
constexpr double kReach = 10.0;
constexpr double kFar = 2.5;         // thicknesses: mitre and a little
constexpr double kBend = 0.5;        // thicknesses between a trace's edge and its wire
constexpr double kLongestWay = 1.2;  // between two vertices of one trace, over their distance

}  // namespace

HeldFeatures::HeldFeatures(const Obstacle& obstacle, const ClothMotion& motion, double thickness)
    : obstacle_(obstacle), thickness_(thickness)
{
    const ObstacleFeatures& features = obstacle.features();
    for (const FeatureHold& hold : motion.holds) {
        const Vec3 &begin = motion.begin[hold.vertex], &end = motion.end[hold.vertex];
        if (!hold.is_corner && features.edges[hold.feature].kind == FeatureKind::Wire) {
            const FeaturePlace place = follow_polyline(obstacle, hold.feature, begin);
            const FeaturePlace last = follow_polyline(obstacle, place.feature, end);
            const auto height = [&](const FeaturePlace& at, const Vec3& from) {
                const double distance = (place_on_feature(obstacle, at.feature, from).point - from).norm();
                return std::clamp(distance, thickness, kFar * thickness);
            };
            const double first_height = height(place, begin), last_height = height(last, end);
            const double greatest = std::max(first_height, last_height);
            held_.push_back({hold.vertex, place, last, kReach * greatest + (end - begin).norm(),
                             kReach * last_height, greatest >= kFar * thickness});
        }
    }
}

const HeldFeatures::Held* HeldFeatures::find(int vertex) const
{
    const auto found = std::lower_bound(held_.begin(), held_.end(), vertex,
                                        [](const Held& held, int v) { return held.vertex < v; });
    return found != held_.end() && found->vertex == vertex ? &*found : nullptr;
}

void HeldFeatures::append(const Held& held, double further, bool is_end,
                          std::vector<FeatureStretch>& stretches) const
{
    const double reach = further + (is_end ? held.end_reach : held.reach);
    const FeaturePlace& place = is_end ? held.end : held.place;
    const auto ends_of = [&](int edge) -> std::array<Vec3, 2> {
        const auto& ends = obstacle_.topology().edges[edge].points;
        return {obstacle_.mesh().points[ends[0]], obstacle_.mesh().points[ends[1]]};
    };
    const auto [p, q] = ends_of(obstacle_.features().edges[place.feature].edge);
    const Vec3 foot = p + place.s * (q - p), tangent = (q - p).normalized();
    // As far as the wire is straight: where it bends away it may get through the cloth.
    for (FeatureStretch part : stretch_around(obstacle_, place, reach)) {
        const auto [a, b] = ends_of(part.edge);
        const auto excess = [&](double s) {
            const Vec3 from = a + s * (b - a) - foot;
            return (from - tangent.dot(from) * tangent).norm() - kBend * thickness_;
        };
        const double first = excess(part.from), last = excess(part.to);
        if (first > 0.0 && last > 0.0) continue;
        const double middle = part.from + (part.to - part.from) * first / (first - last);
        if (first > 0.0) part.from = middle;
        if (last > 0.0) part.to = middle;
        if (part.from < part.to) stretches.push_back(part);
    }
}

double HeldFeatures::way_between(const Held& a, const Held& b) const
{
    const auto ends_of = [&](int edge) -> std::array<Vec3, 2> {
        const auto& ends = obstacle_.topology().edges[edge].points;
        return {obstacle_.mesh().points[ends[0]], obstacle_.mesh().points[ends[1]]};
    };
    const auto point_of = [&](const Held& at) {
        const auto [p, q] = ends_of(obstacle_.features().edges[at.place.feature].edge);
        return Vec3(p + at.place.s * (q - p));
    };
    const Vec3 from = point_of(a), to = point_of(b);
    const double way =
        distance_along(obstacle_, a.place, b.place, kLongestWay * (from - to).norm()).value_or(0.0);
    // Where it bends away from between them it may get through the cloth.
    for (const FeatureStretch& stretch : stretch_around(obstacle_, a.place, way))
        for (const double s : {stretch.from, stretch.to}) {
            const auto [p, q] = ends_of(stretch.edge);
            const Vec3 node = p + s * (q - p);
            const double t = (node - from).dot(to - from) / (to - from).squaredNorm();
            if (t > 0.0 && t < 1.0 && (node - from - t * (to - from)).norm() > kBend * thickness_) return 0.0;
        }
    return way;
}

std::vector<FeatureStretch> HeldFeatures::beside_edge(int a, int b) const
{
    std::vector<FeatureStretch> stretches;
    const Held *first = find(a), *second = find(b);
    // A trace's own edge lies on the wire and is looked at between its ends; one that is about to does not.
    const double further =
        first && second && (first->is_far || second->is_far) ? way_between(*first, *second) : 0.0;
    for (const Held* held : {first, second})
        if (held) append(*held, further, false, stretches);
    return stretches;
}

std::vector<FeatureStretch> HeldFeatures::beside(const Face& face, double least, bool is_end) const
{
    std::vector<FeatureStretch> stretches;
    for (const int v : face) {
        const Held* held = find(v);
        if (!held) continue;
        // Of a trace's own face the wire is in the plane from one end of the trace's edge to the other.
        double further = least;
        for (const int w : face)
            if (const Held* other = w == v ? nullptr : find(w))
                further = std::max(further, way_between(*held, *other));
        append(*held, further, is_end, stretches);
    }
    return stretches;
}

std::vector<FeatureStretch> HeldFeatures::beside_face(const Face& face) const
{
    return beside(face, 0.0, false);
}

bool HeldFeatures::is_beside_point(const std::vector<FeatureStretch>& beside, int point) const
{
    if (is_corner(obstacle_.features(), point)) return false;  // a wire's end could get through
    return std::any_of(beside.begin(), beside.end(), [&](const FeatureStretch& stretch) {
        const auto& ends = obstacle_.topology().edges[stretch.edge].points;
        return (ends[0] == point && stretch.from <= 0.0) || (ends[1] == point && stretch.to >= 1.0);
    });
}

void HeldFeatures::let_touch(const Face& face, const std::array<Vec3, 3>& begin,
                             const std::array<Vec3, 3>& end, ObstacleTouch& touch) const
{
    if (!is_any() || !touch.is_any()) return;
    const std::vector<FeatureStretch> around = beside(face, 0.0, true);
    const double size =
        std::max({(end[1] - end[0]).norm(), (end[2] - end[1]).norm(), (end[0] - end[2]).norm()});
    const std::vector<FeatureStretch> whole = beside(face, kLongestWay * size, true);
    std::erase_if(touch.segments, [&](int e) {
        const auto& ends = obstacle_.topology().edges[e].points;
        const std::array<Vec3, 2> segment = {obstacle_.mesh().points[ends[0]],
                                             obstacle_.mesh().points[ends[1]]};
        const auto touches_outside = [&](const std::vector<FeatureStretch>& stretches,
                                         const std::array<Vec3, 3>& triangle) {
            const auto parts = parts_outside(stretches, e);
            return std::any_of(parts.begin(), parts.end(), [&](const std::array<double, 2>& part) {
                return is_touching(triangle, part_of(segment, part));
            });
        };
        if (!touches_outside(around, end)) return true;
        return begin != end && !touches_outside(whole, end) && is_touching(begin, segment);
    });
}

namespace {

double distance_between(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 2>& segment)
{
    if (is_touching(triangle, segment)) return 0.0;
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& end : segment)
        least = std::min(least, (closest_on_triangle(end, triangle, normal).point - end).norm());
    for (int i = 0; i < 3; ++i) {
        const SegmentPair pair = closest_between_segments({triangle[i], triangle[(i + 1) % 3]}, segment);
        least = std::min(least, (pair.first - pair.second).norm());
    }
    return least;
}

}  // namespace

bool is_clear(const Obstacle& obstacle, const FeatureHold& hold, const Vec3& place,
              const std::vector<std::array<Vec3, 3>>& faces, double distance)
{
    const ObstacleFeatures& features = obstacle.features();
    const std::vector<Vec3>& points = obstacle.mesh().points;
    if (hold.is_corner || features.edges[hold.feature].kind != FeatureKind::Wire) return true;
    double reach = 0.0;
    for (const std::array<Vec3, 3>& face : faces)
        for (const Vec3& p : face) reach = std::max(reach, (p - place).norm());
    const std::vector<FeatureStretch> beside =
        stretch_around(obstacle, follow_polyline(obstacle, hold.feature, place), reach);
    std::vector<std::array<Vec3, 2>> segments;
    for (const FeatureStretch& stretch : beside) {
        const auto& ends = obstacle.topology().edges[stretch.edge].points;
        segments.push_back({points[ends[0]], points[ends[1]]});
    }
    return std::all_of(faces.begin(), faces.end(), [&](const std::array<Vec3, 3>& face) {
        return std::all_of(segments.begin(), segments.end(), [&](const std::array<Vec3, 2>& segment) {
            return distance_between(face, segment) > distance;
        });
    });
}

bool is_covered(const Obstacle& obstacle, const std::vector<FeatureStretch>& stretches, int edge,
                const Vec3& point)
{
    const auto& ends = obstacle.topology().edges[edge].points;
    const double s =
        closest_on_segment(point, obstacle.mesh().points[ends[0]], obstacle.mesh().points[ends[1]]);
    return std::any_of(stretches.begin(), stretches.end(), [&](const FeatureStretch& stretch) {
        return stretch.edge == edge && s >= stretch.from && s <= stretch.to;
    });
}

}  // namespace arris
