// SPDX-License-Identifier: GPL-3.0-or-later
//          ^ part of sheet 0 that is cut off: its vertices are as deep
//         / \             as they are far from sheet 1
//   -----*---*-----  sheet 1, pierced by edges of sheet 0 at *
//       /     \                                             .
//      /       \    rest of sheet 0
//
// A part begins at the ends on one side of the edges that pierce, and grows over the sheet as long as it is
// over the other sheet, but across no pierced edge. The part with the least depth moves back. A contour that
// cuts off no part, as between two borders that overlap, has to become shorter.
#include "geometry/untangle/ways_apart.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "geometry/sort_unique.h"
#include "geometry/untangle/sheet_place.h"

namespace arris {

namespace {

/// Least change of the contour's length with a move of the sheets against each other, relative to the move.
/// The length of a contour around a part with parallel sides does not change; rounding leaves something.
constexpr double kLeastPull = 0.05;

struct PartVertex {
    int vertex;
    SheetPlace nearest;  ///< on the other sheet
};

/// A part that a contour cuts off a sheet, on one side of the other sheet.
struct CutPart {
    int sheet;
    double side;  ///< 1 where it lies on the side to which the other sheet's normals point, else -1
    std::vector<PartVertex> vertices;
    std::size_t grown = 0;  ///< number of vertices whose neighbours have been visited
    double depth = 0.0;     ///< m

    bool is_whole() const { return grown == vertices.size(); }
};

class WaySearch {
  public:
    WaySearch(const CollisionMesh& mesh, const std::vector<Contour>& contours, const WayLimits& limits)
        : mesh_(mesh), limits_(limits), is_pierced_(mesh.surface().edges.size(), 0)
    {
        for (const Contour& contour : contours)
            for (const std::vector<Piercing>& piercings : contour.piercings)
                for (const Piercing& piercing : piercings) is_pierced_[piercing.edge] = 1;
    }

    std::vector<WayApart> find(const Contour& contour) const
    {
        std::vector<WayApart> ways;
        if (contour.is_pierced()) {
            add_shorter(contour, ways);
            const double most =
                ways.empty() ? std::numeric_limits<double>::infinity() : kSimilarWay * ways.front().distance;
            for (const CutPart& part : find_parts(contour, most)) ways.push_back(way_of(contour, part));
        } else {
            add_lift(contour, 1.0, ways);
            add_lift(contour, -1.0, ways);
        }
        std::erase_if(ways, [&](const WayApart& way) { return !can_move(way); });
        std::stable_sort(ways.begin(), ways.end(),
                         [](const WayApart& a, const WayApart& b) { return a.distance < b.distance; });
        return ways;
    }

  private:
    bool can_move(const WayApart& way) const
    {
        return std::any_of(way.rows.begin(), way.rows.end(), [&](const MoveRow& row) {
            return std::any_of(row.terms.begin(), row.terms.end(),
                               [&](const MoveTerm& term) { return mesh_.may_move(term.vertex); });
        });
    }

    bool is_solid(const Contour& contour, int sheet) const
    {
        return mesh_.is_solid(contour.pairs.front()[sheet]);
    }

    /// The parts that the contour cuts off both sheets, no deeper than `most`. All grow by a ring at a time,
    /// until the rest are much deeper than one that is whole: large parts cost little where a small one is
    /// found.
    std::vector<CutPart> find_parts(const Contour& contour, double most) const
    {
        std::vector<CutPart> parts;
        std::vector<std::unordered_set<int>> visited;
        for (int sheet = 0; sheet < 2; ++sheet)
            for (const double side : {1.0, -1.0}) {
                // The cloth outside a solid does not move in.
                if (side > 0.0 && is_solid(contour, 1 - sheet)) continue;
                CutPart part{sheet, side, {}};
                std::unordered_set<int> seen;
                for (const Piercing& piercing : contour.piercings[sheet]) {
                    const MeshEdge& edge = mesh_.surface().edges[piercing.edge];
                    for (const int v : {edge.a, edge.b}) visit(v, piercing.face, part, seen);
                }
                parts.push_back(std::move(part));
                visited.push_back(std::move(seen));
            }
        for (bool is_growing = true; is_growing;) {
            is_growing = false;
            for (const CutPart& part : parts)
                if (part.is_whole() && !part.vertices.empty())
                    most = std::min(most, kSimilarWay * part.depth);
            for (std::size_t p = 0; p < parts.size(); ++p) {
                if (parts[p].is_whole() || parts[p].depth > most) continue;
                grow(parts[p], visited[p]);
                is_growing = true;
            }
        }
        std::erase_if(parts, [](const CutPart& part) { return !part.is_whole() || part.vertices.empty(); });
        return parts;
    }

    /// Adds a vertex to a part if it is new, and lies over the other sheet, on the part's side.
    void visit(int v, int face, CutPart& part, std::unordered_set<int>& seen) const
    {
        if (!seen.insert(v).second) return;
        const SheetPlace at = walk_to_nearest(mesh_, mesh_.positions[v], face);
        if (at.is_on_border || part.side * at.normal.dot(mesh_.positions[v] - at.point) <= 0.0) return;
        part.vertices.push_back({v, at});
        part.depth = std::max(part.depth, at.distance);
    }

    void grow(CutPart& part, std::unordered_set<int>& seen) const
    {
        const SelfSurface& surface = mesh_.surface();
        for (const std::size_t end = part.vertices.size(); part.grown < end; ++part.grown) {
            const auto [v, nearest] = part.vertices[part.grown];
            for (const int f : surface.faces_at[v])
                for (const int e : surface.edges_of[f]) {
                    const MeshEdge& edge = surface.edges[e];
                    if (is_pierced_[e] || (edge.a != v && edge.b != v)) continue;
                    visit(edge.a == v ? edge.b : edge.a, nearest.face, part, seen);
                }
        }
    }

    /// Row that moves a vertex by `change` along `direction` against a place of a face.
    MoveRow row_of(int vertex, int face, const std::array<double, 3>& weights, const Vec3& direction,
                   double change) const
    {
        MoveRow row{{{vertex, direction}}, change};
        for (int k = 0; k < 3; ++k)
            if (weights[k] != 0.0)
                row.terms.push_back({mesh_.surface().faces[face][k], -weights[k] * direction});
        return row;
    }

    WayApart way_of(const Contour& contour, const CutPart& part) const
    {
        WayApart way;
        way.distance = part.depth + limits_.gap;
        std::vector<int> moving = contour.faces(part.sheet), passed = contour.faces(1 - part.sheet);
        Box3 box;
        for (const auto& [v, nearest] : part.vertices) {
            const Vec3& x = mesh_.positions[v];
            const Vec3 way_in = x - nearest.point;
            // Near the other sheet the difference is mostly rounding.
            const Vec3 back = nearest.distance > limits_.gap ? Vec3(-way_in / nearest.distance)
                                                             : Vec3(-part.side * nearest.normal);
            way.rows.push_back(
                row_of(v, nearest.face, nearest.weights, back, nearest.distance + limits_.gap));
            const auto around = mesh_.surface().faces_at[v];
            moving.insert(moving.end(), around.begin(), around.end());
            passed.push_back(nearest.face);
            box.extend(x).extend(nearest.point);
        }
        box = Box3(box.min().array() - limits_.step, box.max().array() + limits_.step);
        way.sides[part.sheet] = with_neighbours(std::move(moving));
        way.sides[1 - part.sheet] = flood(with_neighbours(std::move(passed)), box);
        return way;
    }

    /// Moves the sheets against each other along the sum of the gradient over the contour: the whole contour
    /// moves as one, and most of the sheets with it.
    void add_shorter(const Contour& contour, std::vector<WayApart>& ways) const
    {
        const double pull = contour.pull.norm();
        if (!(pull > kLeastPull)) return;
        WayApart way;
        way.distance = contour.length / pull + limits_.gap;
        for (int sheet = 0; sheet < 2; ++sheet) {
            const Vec3 back = (sheet == 0 ? -1.0 : 1.0) * contour.pull / pull;
            for (const Piercing& piercing : contour.piercings[sheet]) {
                const MeshEdge& edge = mesh_.surface().edges[piercing.edge];
                MoveRow row = row_of(edge.a, piercing.face, piercing.weights, back, way.distance);
                row.terms.front().weight *= 1.0 - piercing.along;
                row.terms.push_back({edge.b, piercing.along * back});
                way.rows.push_back(std::move(row));
            }
            way.sides[sheet] = with_neighbours(contour.faces(sheet));
        }
        ways.push_back(std::move(way));
    }

    /// Sheets that touch, or lie on each other: sheet 0 moves to the side of sheet 1 to which its normals
    /// point, or to the other one.
    void add_lift(const Contour& contour, double side, std::vector<WayApart>& ways) const
    {
        if (side < 0.0 && is_solid(contour, 1)) return;
        WayApart way;
        for (const std::array<int, 2>& pair : contour.pairs)
            for (int sheet = 0; sheet < 2; ++sheet) {
                const Face& other = mesh_.surface().faces[pair[1 - sheet]];
                for (const int v : mesh_.surface().faces[pair[sheet]]) {
                    if (std::find(other.begin(), other.end(), v) != other.end()) continue;
                    const Vec3 normal = (sheet == 0 ? side : -side) * normal_of(mesh_, pair[1]);
                    const PointOnTriangle at = nearest_on(mesh_, mesh_.positions[v], pair[1 - sheet]);
                    const double change = limits_.gap - normal.dot(mesh_.positions[v] - at.point);
                    if (!(change > 0.0)) continue;
                    way.rows.push_back(row_of(v, pair[1 - sheet], at.weights, normal, change));
                    way.distance = std::max(way.distance, change);
                }
            }
        for (int sheet = 0; sheet < 2; ++sheet) way.sides[sheet] = with_neighbours(contour.faces(sheet));
        if (!way.rows.empty()) ways.push_back(std::move(way));
    }

    std::vector<int> with_neighbours(std::vector<int> faces) const
    {
        const std::size_t count = faces.size();
        for (std::size_t i = 0; i < count; ++i)
            for (const int v : mesh_.surface().faces[faces[i]]) {
                const auto around = mesh_.surface().faces_at[v];
                faces.insert(faces.end(), around.begin(), around.end());
            }
        sort_unique(faces);
        return faces;
    }

    /// Adds faces that are connected to `faces` through faces that touch a box.
    std::vector<int> flood(std::vector<int> faces, const Box3& box) const
    {
        const SelfSurface& surface = mesh_.surface();
        std::unordered_set<int> seen(faces.begin(), faces.end());
        for (std::size_t i = 0; i < faces.size(); ++i)
            for (const int e : surface.edges_of[faces[i]])
                for (const int f : {surface.edges[e].face_left, surface.edges[e].face_right}) {
                    if (f < 0 || seen.contains(f)) continue;
                    Box3 own;
                    for (const int v : surface.faces[f]) own.extend(mesh_.positions[v]);
                    if (!own.intersects(box)) continue;
                    seen.insert(f);
                    faces.push_back(f);
                }
        std::sort(faces.begin(), faces.end());
        return faces;
    }

    const CollisionMesh& mesh_;
    WayLimits limits_;
    std::vector<char> is_pierced_;  // of each edge, by any contour
};

}  // namespace

WaySides::WaySides(std::size_t face_count, const std::vector<WayApart>& ways) : sides_of_(face_count)
{
    for (std::size_t w = 0; w < ways.size(); ++w)
        for (int side = 0; side < 2; ++side)
            for (const int f : ways[w].sides[side]) sides_of_[f].push_back(static_cast<int>(2 * w) + side);
}

bool WaySides::may_meet(int first, int second) const
{
    const std::vector<int>& others = sides_of_[second];
    return std::any_of(sides_of_[first].begin(), sides_of_[first].end(),
                       [&](int side) { return std::binary_search(others.begin(), others.end(), side ^ 1); });
}

std::vector<std::vector<WayApart>> find_ways_apart(const CollisionMesh& mesh,
                                                   const std::vector<Contour>& contours,
                                                   const WayLimits& limits)
{
    const WaySearch search(mesh, contours, limits);
    std::vector<std::vector<WayApart>> ways;
    for (const Contour& contour : contours) ways.push_back(search.find(contour));
    return ways;
}

}  // namespace arris
