// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/trace_order.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "geometry/obstacle/feature_path.h"

namespace arris {

namespace {

/// Length of the polyline up to a vertex, m; nothing where the vertex is not on it.
std::optional<double> length_before(const Obstacle& obstacle, const Polyline& polyline,
                                    const PlacedEol& placed)
{
    const EolVertex& eol = placed.eol;
    const ObstacleFeatures& features = obstacle.features();
    const auto point_of = [&](const PolylineEdge& edge, bool is_end) {
        return point_at(obstacle, {edge.feature, edge.is_forward == is_end ? 1 : 0});
    };
    if (eol.on.is_corner()) {
        const int point = features.corners[eol.on.index].point;
        if (point == point_of(polyline.edges.front(), false)) return 0.0;
        if (point == point_of(polyline.edges.back(), true)) return polyline.length;
        return std::nullopt;
    }
    const auto at = std::find_if(polyline.edges.begin(), polyline.edges.end(),
                                 [&](const PolylineEdge& e) { return e.feature == eol.on.index; });
    if (at == polyline.edges.end()) return std::nullopt;
    const auto [a, b] = feature_segment(obstacle, eol.on.index);
    const double s = place_on_feature(obstacle, eol.on.index, placed.place).s;
    return at->begin + (at->is_forward ? s : 1.0 - s) * (b - a).norm();
}

using Neighbours = std::vector<std::pair<const EolVertex*, const EolVertex*>>;

void add_along(const Obstacle& obstacle, int o, int index, const std::vector<PlacedEol>& placed,
               Neighbours& neighbours)
{
    const Polyline polyline = trace_polyline(obstacle, index);
    std::vector<std::pair<double, const PlacedEol*>> row;  // by length along the polyline
    for (const PlacedEol& p : placed) {
        if (p.eol.on.obstacle != o) continue;
        if (const auto along = length_before(obstacle, polyline, p)) row.emplace_back(*along, &p);
    }
    std::sort(row.begin(), row.end(), [](const auto& p, const auto& q) {
        return std::tuple(p.first, p.second->eol.vertex_id) < std::tuple(q.first, q.second->eol.vertex_id);
    });
    // Each strand has its own order.
    for (std::size_t i = 0; i < row.size(); ++i)
        for (std::size_t k = i + 1; k < row.size(); ++k) {
            if (!is_of_one_strand(obstacle, *row[i].second, *row[k].second)) continue;
            neighbours.emplace_back(&row[i].second->eol, &row[k].second->eol);
            break;
        }
    if (polyline.is_closed && row.size() > 2)
        neighbours.emplace_back(&row.back().second->eol, &row.front().second->eol);
}

}  // namespace

Neighbours find_trace_neighbours(const std::vector<MovingObstacle>& obstacles, double time,
                                 const std::vector<PlacedEol>& placed)
{
    std::set<std::pair<int, int>> polylines;  // by obstacle and index
    for (const PlacedEol& p : placed)
        if (!p.eol.on.is_corner())
            polylines.emplace(p.eol.on.obstacle,
                              obstacles[p.eol.on.obstacle].shape().features().edges[p.eol.on.index].polyline);
    Neighbours neighbours;
    for (const auto& [o, index] : polylines) add_along(obstacles[o].at(time), o, index, placed, neighbours);
    return neighbours;
}

}  // namespace arris
