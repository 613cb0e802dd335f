// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Vertex_base_2.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <algorithm>
#include <boost/next_prior.hpp>
#include <cmath>

#include "geometry/cgal.h"
#include "geometry/cloth_input/cloth_outline.h"

namespace arris {
namespace {

namespace Simplification = CGAL::Polyline_simplification_2;

// Longest side that replaces others, relative to the edge length. Sides that are a little more than half as
// long keep their corners.
constexpr double kLongestJoined = 4.0 / 3.0;

// Greatest distance of a corner left out from the side in its place, relative to the edge length. Circles are
// divided evenly down to a radius of 1.8 edge lengths, and have six sides or more down to half an edge
// length.
constexpr double kGreatestDistance = 0.07;

using VertexBase = Simplification::Vertex_base_2<Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>>;

// The squared length of the side that would replace the two at a corner, so that the shortest are joined
// first; none where that side would be too long or too far from the corners left out.
struct JoinedSide {
    double edge_length;

    boost::optional<double> operator()(const Triangulation& triangulation,
                                       Triangulation::Vertices_in_constraint_iterator corner) const
    {
        const Point2& before = (*boost::prior(corner))->point();
        const Point2& after = (*boost::next(corner))->point();
        const double longest = kLongestJoined * edge_length;
        const double length = CGAL::squared_distance(before, after);
        if (length > longest * longest) return boost::none;
        const double farthest = kGreatestDistance * edge_length;
        if (Simplification::Squared_distance_cost()(triangulation, corner).value() > farthest * farthest)
            return boost::none;
        return length;
    }
};

struct NeverStop {
    template <typename Vertex>
    bool operator()(const Triangulation&, const Vertex&, double, std::size_t, std::size_t) const
    {
        return false;
    }
};

// Cosine of 30 degrees: where a border turns by more, it has a corner and not a curve.
constexpr double kTurn = 0.86602540378443865;

bool is_sharp(const Vec2& before, const Vec2& corner, const Vec2& after)
{
    const Vec2 d = corner - before, e = after - corner;
    return d.dot(e) < kTurn * d.norm() * e.norm();
}

// Begins a loop at a sharp corner, if there is one.
std::vector<Vec2> begin_at_sharp(std::vector<Vec2> loop)
{
    const std::size_t count = loop.size();
    for (std::size_t k = 0; k < count; ++k) {
        if (!is_sharp(loop[(k + count - 1) % count], loop[k], loop[(k + 1) % count])) continue;
        std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(k), loop.end());
        break;
    }
    return loop;
}

// Marks corners about `spacing` apart along the curve from corner `begin` to corner `end`, evenly spaced.
void mark_curve(const std::vector<Vec2>& loop, std::size_t begin, std::size_t end, double spacing,
                std::vector<char>& is_kept)
{
    std::vector<double> lengths = {0.0};
    for (std::size_t k = begin; k < end; ++k)
        lengths.push_back(lengths.back() + (loop[(k + 1) % loop.size()] - loop[k]).norm());
    const double pieces = std::ceil(lengths.back() / spacing);
    std::size_t nearest = 0;
    for (double piece = 1.0; piece < pieces && nearest < lengths.size(); ++piece) {
        const double place = lengths.back() * (piece / pieces);
        const auto distance = [&](std::size_t k) { return std::abs(lengths[k] - place); };
        while (nearest + 1 < lengths.size() && distance(nearest + 1) < distance(nearest)) ++nearest;
        is_kept[(begin + nearest) % loop.size()] = 1;
    }
}

// Corners that are kept so that the curves between sharp corners are divided evenly.
std::vector<char> mark_evenly(const std::vector<Vec2>& loop, double spacing)
{
    std::vector<char> is_kept(loop.size(), 0);
    std::size_t begin = 0;
    for (std::size_t k = 1; k <= loop.size(); ++k) {
        const bool is_end = k == loop.size() || is_sharp(loop[k - 1], loop[k], loop[(k + 1) % loop.size()]);
        if (!is_end) continue;
        mark_curve(loop, begin, k, spacing, is_kept);
        begin = k;
    }
    return is_kept;
}

}  // namespace

BorderLoops coarsen_border(const BorderLoops& border, double edge_length)
{
    Triangulation triangulation;
    std::vector<Triangulation::Constraint_id> ids;
    for (const std::vector<Vec2>& any_start : border) {
        const std::vector<Vec2> loop = begin_at_sharp(any_start);
        const std::vector<char> is_kept = mark_evenly(loop, edge_length);
        std::vector<Point2> points;
        for (const Vec2& corner : loop) points.push_back(to_cgal(corner));
        ids.push_back(triangulation.insert_constraint(points.begin(), points.end(), true));
        auto vertex = triangulation.vertices_in_constraint_begin(ids.back());
        for (std::size_t k = 0; k < loop.size(); ++k, ++vertex)
            if (is_kept[k] != 0) (*vertex)->set_removable(false);
    }
    Simplification::simplify(triangulation, JoinedSide{edge_length}, NeverStop(), false);
    BorderLoops coarse;
    for (const auto& id : ids) {
        std::vector<Vec2>& loop = coarse.emplace_back();
        for (const auto& vertex : triangulation.vertices_in_constraint(id))
            loop.push_back(to_eigen(vertex->point()));
        loop.pop_back();  // the first corner again
    }
    return coarse;
}

}  // namespace arris
