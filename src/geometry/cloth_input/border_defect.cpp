// SPDX-License-Identifier: GPL-3.0-or-later
//
// A border is sound if its constrained Delaunay triangulation has every side as an edge, and if the regions
// on both sides of each loop are nested as they should be. All of that is exact, and takes n log n for usual
// borders.
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <deque>
#include <numeric>
#include <tuple>

#include "geometry/cloth_input/cloth_outline.h"
#include "geometry/loop_triangulation.h"

namespace arris {
namespace {

// Farthest corner from the origin, relative to the border's size: rounding of coordinates then stays below
// the tolerance of fold lines.
constexpr double kFarthest = 1000.0;

constexpr const char* kNoTouch = "sides that neither cross nor touch one another";

using Triangulation = LoopTriangulation;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

struct Side {
    int loop;
    int begin, end;  // corners of the whole border
};

std::string in_words(const Vec2& corner)
{
    return fmt::format("[{:.9g}, {:.9g}]", corner.x(), corner.y());
}

std::string name_of(int loop)
{
    return loop == 0 ? "the outline" : fmt::format("holes.{}", loop - 1);
}

class BorderCheck {
  public:
    explicit BorderCheck(const BorderLoops& border)
    {
        for (int loop = 0; loop < static_cast<int>(border.size()); ++loop) {
            const int first = static_cast<int>(corners_.size());
            const int count = static_cast<int>(border[loop].size());
            corners_.insert(corners_.end(), border[loop].begin(), border[loop].end());
            for (int k = 0; k < count; ++k) sides_.push_back({loop, first + k, first + (k + 1) % count});
        }
    }

    std::optional<BorderDefect> find()
    {
        if (std::optional<BorderDefect> defect = find_repeated_corner()) return defect;
        insert_corners();
        for (const Side& side : sides_)
            if (std::optional<BorderDefect> defect = insert_side(side)) return defect;
        return check_nesting();
    }

  private:
    std::optional<BorderDefect> find_repeated_corner() const
    {
        std::vector<int> order(corners_.size());
        std::iota(order.begin(), order.end(), 0);
        const auto key = [&](int c) { return std::tuple(corners_[c].x(), corners_[c].y(), c); };
        std::sort(order.begin(), order.end(), [&](int c, int d) { return key(c) < key(d); });
        for (std::size_t k = 1; k < order.size(); ++k) {
            if (corners_[order[k]] != corners_[order[k - 1]]) continue;
            return touch(loop_of(order[k]),
                         fmt::format("comes to a corner twice: {}", in_words(corners_[order[k]])),
                         order[k - 1]);
        }
        return std::nullopt;
    }

    void insert_corners()
    {
        std::vector<std::pair<Point2, int>> points;
        for (const Vec2& corner : corners_)
            points.emplace_back(to_cgal(corner), static_cast<int>(points.size()));
        triangulation_.insert(points.begin(), points.end());
        vertices_.resize(corners_.size());
        for (const VertexHandle vertex : triangulation_.finite_vertex_handles())
            vertices_[static_cast<std::size_t>(vertex->info())] = vertex;
    }

    int loop_of(int corner) const
    {
        const auto is_past = [](const Side& side, int c) { return side.begin < c; };
        return std::lower_bound(sides_.begin(), sides_.end(), corner, is_past)->loop;
    }

    BorderDefect touch(int loop, std::string wrong, int other_corner) const
    {
        const int other = loop_of(other_corner);
        if (other != loop) wrong += fmt::format(" of {}", name_of(other));
        return {loop, std::move(wrong), kNoTouch};
    }

    std::string words_of(const Side& side) const
    {
        return fmt::format("side from {} to {}", in_words(corners_[side.begin]),
                           in_words(corners_[side.end]));
    }

    std::optional<BorderDefect> insert_side(const Side& side)
    {
        const VertexHandle begin = vertices_[side.begin], end = vertices_[side.end];
        try {
            triangulation_.insert_constraint(begin, end);
        } catch (const Triangulation::Intersection_of_constraints_exception&) {
            return crossing_of(side);
        }
        FaceHandle face;
        int k = 0;
        if (triangulation_.is_edge(begin, end, face, k) && face->is_constrained(k)) return std::nullopt;
        return passing_of(side);
    }

    int turn(int a, int b, int c) const { return exact_orientation(corners_[a], corners_[b], corners_[c]); }

    BorderDefect crossing_of(const Side& side) const
    {
        for (const Side& other : sides_) {
            const bool crosses =
                turn(side.begin, side.end, other.begin) * turn(side.begin, side.end, other.end) < 0 &&
                turn(other.begin, other.end, side.begin) * turn(other.begin, other.end, side.end) < 0;
            if (!crosses) continue;
            const std::string whose = other.loop == side.loop ? "" : " of " + name_of(other.loop);
            return {side.loop, fmt::format("its {} crosses the {}{}", words_of(side), words_of(other), whose),
                    kNoTouch};
        }
        return passing_of(side);
    }

    // The side runs through a corner.
    BorderDefect passing_of(const Side& side) const
    {
        const Vec2 &a = corners_[side.begin], &b = corners_[side.end];
        for (int c = 0; c < static_cast<int>(corners_.size()); ++c) {
            const bool is_between = (corners_[c].array() >= a.cwiseMin(b).array()).all() &&
                                    (corners_[c].array() <= a.cwiseMax(b).array()).all();
            if (c == side.begin || c == side.end || !is_between || turn(side.begin, side.end, c) != 0)
                continue;
            return touch(
                side.loop,
                fmt::format("its {} runs through the corner {}", words_of(side), in_words(corners_[c])), c);
        }
        return {side.loop, fmt::format("its {} touches another", words_of(side)), kNoTouch};
    }

    // Marks faces with the number of loops around them.
    void mark_depths()
    {
        for (const FaceHandle face : triangulation_.all_face_handles()) face->info().reset();
        std::deque<FaceHandle> front = {triangulation_.infinite_face()};
        front.front()->info() = 0;
        // Faces of one depth come before all deeper ones.
        while (!front.empty()) {
            const FaceHandle face = front.front();
            front.pop_front();
            for (int k = 0; k < 3; ++k) {
                const FaceHandle neighbour = face->neighbor(k);
                const int depth = *face->info() + (face->is_constrained(k) ? 1 : 0);
                if (neighbour->info() && *neighbour->info() <= depth) continue;
                neighbour->info() = depth;
                if (face->is_constrained(k))
                    front.push_back(neighbour);
                else
                    front.push_front(neighbour);
            }
        }
    }

    std::optional<BorderDefect> check_nesting()
    {
        mark_depths();
        for (std::size_t s = 0; s < sides_.size(); ++s) {
            const Side& side = sides_[s];
            if (side.loop == 0 || (s > 0 && sides_[s - 1].loop == side.loop)) continue;
            FaceHandle face;
            int k = 0;
            triangulation_.is_edge(vertices_[side.begin], vertices_[side.end], face, k);
            const int inside = std::max(*face->info(), *face->neighbor(k)->info());
            if (inside == 2) continue;
            return BorderDefect{side.loop, inside < 2 ? "lies outside the outline" : "lies in another hole",
                                "holes inside the outline, and not in one another"};
        }
        return std::nullopt;
    }

    std::vector<Vec2> corners_;
    std::vector<Side> sides_;  // ascending by their beginning
    std::vector<VertexHandle> vertices_;
    Triangulation triangulation_;
};

std::optional<BorderDefect> find_size_defect(const BorderLoops& border)
{
    std::size_t count = 0;
    double farthest = 0.0;
    Eigen::AlignedBox2d box;
    for (int loop = 0; loop < static_cast<int>(border.size()); ++loop) {
        if (border[loop].size() < 3)
            return BorderDefect{loop, "has fewer than three different corners", "three or more corners"};
        count += border[loop].size();
        for (const Vec2& corner : border[loop]) {
            box.extend(corner);
            farthest = std::max(farthest, corner.cwiseAbs().maxCoeff());
        }
    }
    if (count > static_cast<std::size_t>(kMostOutlineCorners))
        return BorderDefect{0, fmt::format("has, with its holes, {} corners", count),
                            fmt::format("at most {}", kMostOutlineCorners)};
    const double size = box.sizes().maxCoeff();
    if (farthest > kFarthest * size)
        return BorderDefect{
            0,
            fmt::format("is {:.3g} m large and lies {:.3g} m from the origin of the material, "
                        "where rounding distorts it",
                        size, farthest),
            fmt::format("coordinates of at most {:g} times its size", kFarthest)};
    return std::nullopt;
}

}  // namespace

std::optional<BorderDefect> find_border_defect(const BorderLoops& border)
{
    if (std::optional<BorderDefect> defect = find_size_defect(border)) return defect;
    // The outline alone comes first: where it crosses itself, holes are not to blame.
    if (std::optional<BorderDefect> defect = BorderCheck({border[0]}).find()) return defect;
    return border.size() > 1 ? BorderCheck(border).find() : std::nullopt;
}

}  // namespace arris
