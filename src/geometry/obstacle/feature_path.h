// SPDX-License-Identifier: GPL-3.0-or-later
// Paths along the polylines of an obstacle's features, from edge to edge. A path ends at corners.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// A place on a polyline: a feature edge (index in features().edges) and a parameter on that edge.
struct FeaturePlace {
    int feature;
    double s;  ///< parameter in [0, 1] from the edge's first point
};

/// End points of feature edge `feature` (index in features().edges).
std::array<Vec3, 2> feature_segment(const Obstacle& obstacle, int feature);

/// The point of a feature edge nearest to `place`.
struct PointOnFeature {
    double s;
    Vec3 point;
};
PointOnFeature place_on_feature(const Obstacle& obstacle, int feature, const Vec3& place);

/// From the line through feature edge `feature` to `place`, across the line.
Vec3 way_across(const Obstacle& obstacle, int feature, const Vec3& place);

/// Length, m, by which a place is past an end of its wire, along the straight line that goes on from there. 0
/// elsewhere, and for other features. `feature`: the edge of the wire nearest to the place.
double length_past_end(const Obstacle& obstacle, int feature, const Vec3& place);

/// Finds the place on the polyline for a point that has moved along it, starting from feature edge `feature`.
/// Moves on to the next edge as long as that edge is nearer. So another part of the same polyline that
/// happens to be near is not taken.
FeaturePlace follow_polyline(const Obstacle& obstacle, int feature, const Vec3& place);

/// The end of the polyline, an index in the mesh, that is the point of feature edge `feature` nearest to
/// `place`; -1 where the nearest point is no end.
int end_passed(const Obstacle& obstacle, int feature, const Vec3& place);
bool is_past_end(const Obstacle& obstacle, int feature, const Vec3& place);

/// A bend of a polyline: an end (0 or 1) of one of its edges, beyond which the polyline continues in another
/// direction.
struct FeatureBend {
    int feature;
    int end;
};

/// The bend at a point of the mesh where a wire bends by more than a degree without a corner, given by the
/// first such edge there.
std::optional<FeatureBend> find_bend(const Obstacle& obstacle, int point);

/// Distance, m, by which a chord from `reach` before a bend to `reach` behind it misses the bend. Returns 0
/// where one of the bend's two edges is shorter than `reach`: such an edge is one of many on a curved wire.
double missed_by_chord(const Obstacle& obstacle, const FeatureBend& bend, double reach);

/// The bend's index in the mesh, and its position.
int point_at(const Obstacle& obstacle, const FeatureBend& bend);
Vec3 bend_point(const Obstacle& obstacle, const FeatureBend& bend);
/// Unit vector halfway between the directions of both edges at the bend, in the direction of edge
/// `bend.feature`.
Vec3 tangent_at(const Obstacle& obstacle, const FeatureBend& bend);

/// Length along the polyline between two places, m. Returns nothing where the length exceeds `most` or the
/// places are on different polylines.
std::optional<double> distance_along(const Obstacle& obstacle, const FeaturePlace& a, const FeaturePlace& b,
                                     double most);

/// Length along the polyline from a place to a corner (index in features().corners) at an end of the
/// polyline, m. Returns nothing where the length exceeds `most` or the corner is at no end of the polyline.
std::optional<double> distance_to_corner(const Obstacle& obstacle, const FeaturePlace& a, int corner,
                                         double most);

/// An edge of a polyline, in the order along the polyline.
struct PolylineEdge {
    int feature;
    bool is_forward;  ///< whether the polyline runs from the edge's first point to its second
    double begin;     ///< m, length of the polyline before this edge
};
struct Polyline {
    std::vector<PolylineEdge> edges;  ///< a closed polyline begins at the first of its edges in
                                      ///< features().edges
    double length = 0.0;              ///< m
    bool is_closed = false;
};
Polyline trace_polyline(const Obstacle& obstacle, int polyline);

/// Index in features().edges of a topology edge; -1 where the edge is no feature.
int feature_of_edge(const ObstacleFeatures& features, int edge);

}  // namespace arris
