// SPDX-License-Identifier: GPL-3.0-or-later
// Ways along a polyline of an obstacle's features, from segment to segment; they end at its corners.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// A place on a polyline: feature edge (index in features().edges) and the point of it nearest to a given
/// one.
struct FeaturePlace {
    int feature;
    double s;  ///< in [0, 1], from the edge's first point
};

/// Ends of feature edge `feature` (index in features().edges).
std::array<Vec3, 2> feature_segment(const Obstacle& obstacle, int feature);

/// The point of a feature edge nearest to `place`.
struct PointOnFeature {
    double s;
    Vec3 point;
};
PointOnFeature place_on_feature(const Obstacle& obstacle, int feature, const Vec3& place);

/// Where on the polyline of feature edge `feature` a place is that has gone along from that edge: from it to
/// the next as long as that is nearer. So a strand of the same polyline that happens to be near is not taken.
FeaturePlace follow_polyline(const Obstacle& obstacle, int feature, const Vec3& place);

/// Whether what of feature edge `feature` is nearest to a place is an end of its polyline.
bool is_past_end(const Obstacle& obstacle, int feature, const Vec3& place);

/// Where a wire turns: an end (0 or 1) of one of its edges, beyond which the polyline goes on elsewhere.
struct FeatureBend {
    int feature;
    int end;
};

/// At a point of the mesh: the first edge there of a wire that turns by more than a degree but has no corner.
std::optional<FeatureBend> find_bend(const Obstacle& obstacle, int point);

/// By how much a chord from `reach` before a turn to as far behind it passes it by, m. 0 where one of its two
/// edges is shorter than that: it is one of many then, and its wire a curve.
double missed_by_chord(const Obstacle& obstacle, const FeatureBend& bend, double reach);

/// Of the mesh, and where that is.
int point_at(const Obstacle& obstacle, const FeatureBend& bend);
Vec3 bend_point(const Obstacle& obstacle, const FeatureBend& bend);
/// Unit, halfway between the directions of both edges there, seen along the turn's own.
Vec3 tangent_at(const Obstacle& obstacle, const FeatureBend& bend);

/// Length of the polyline between two places on it, m; nothing where it is more than `most`, or where they
/// are on different ones.
std::optional<double> distance_along(const Obstacle& obstacle, const FeaturePlace& a, const FeaturePlace& b,
                                     double most);

/// The same from a place to a corner (index in features().corners) at an end of its polyline.
std::optional<double> distance_to_corner(const Obstacle& obstacle, const FeaturePlace& a, int corner,
                                         double most);

/// An edge of a polyline in the order along it.
struct PolylineEdge {
    int feature;
    bool is_forward;  ///< from its first point to its second
    double begin;     ///< m, length of the polyline before it
};
struct Polyline {
    std::vector<PolylineEdge> edges;  ///< a closed one begins at its first edge
    double length = 0.0;              ///< m
    bool is_closed = false;
};
Polyline trace_polyline(const Obstacle& obstacle, int polyline);

/// Index of a topology edge in features().edges; -1 where it is none.
int feature_of_edge(const ObstacleFeatures& features, int edge);

}  // namespace arris
