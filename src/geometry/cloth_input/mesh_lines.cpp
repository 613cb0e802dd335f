// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/mesh_lines.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/sort_unique.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

// A part of a fold line from border to border, with the nodes on it.
struct Chain {
    std::vector<int> nodes;
};

// A node at which a fold line meets the border, and whether the cloth begins or ends there: as counted a hair
// to the left of the line, and a hair to its right.
struct Meeting {
    int node = 0;
    bool toggles_left = false, toggles_right = false;
};

struct Line {
    Vec2 point, unit;

    // Signed; positive to the left of the line.
    double distance(const Vec2& X) const
    {
        const Vec2 from = X - point;
        return unit.x() * from.y() - unit.y() * from.x();
    }
};

// Whether exactly one of two distances is on the given side: 1 left, -1 right.
bool is_parted(double a, double b, double side)
{
    return (a * side > 0.0) != (b * side > 0.0);
}

class GraphBuilder {
  public:
    explicit GraphBuilder(const BorderLoops& border)
    {
        for (const std::vector<Vec2>& loop : border) {
            const int first = static_cast<int>(graph_.nodes.size());
            const int count = static_cast<int>(loop.size());
            graph_.nodes.insert(graph_.nodes.end(), loop.begin(), loop.end());
            for (int k = 0; k < count; ++k) sides_.push_back({first + k, first + (k + 1) % count});
        }
        corner_count_ = static_cast<int>(graph_.nodes.size());
        on_side_.resize(sides_.size());
        Eigen::AlignedBox2d box;
        for (const Vec2& corner : graph_.nodes) box.extend(corner);
        tolerance_ = kComputed * box.sizes().maxCoeff();
    }

    void add_fold(const FoldLine& fold)
    {
        const Line line = make_line(fold);
        const std::vector<Meeting> meetings = meet_border(line);
        std::vector<Chain> chains;
        bool is_left = false, is_right = false, is_on_border = false;
        for (std::size_t k = 0; k < meetings.size(); ++k) {
            is_left = is_left != meetings[k].toggles_left;
            is_right = is_right != meetings[k].toggles_right;
            // With cloth on one side only, the line runs along the border.
            is_on_border = is_on_border || is_left != is_right;
            if (!is_left || !is_right || k + 1 == meetings.size()) continue;
            const auto [a, b] = std::minmax(meetings[k].node, meetings[k + 1].node);
            if (a != b) chains.push_back({{a, b}});
        }
        if (chains.empty() && !is_on_border)
            throw InputError(refusal(fold, "its line does not run through the cloth"));
        std::erase_if(chains, [&](const Chain& chain) {
            return !known_ends_.insert({chain.nodes[0], chain.nodes[1]}).second;
        });
        folds_.push_back({line, std::move(chains)});
    }

    MeshLines build()
    {
        for (std::size_t i = 0; i < folds_.size(); ++i)
            for (std::size_t j = i + 1; j < folds_.size(); ++j) cross(folds_[i], folds_[j]);
        for (std::size_t side = 0; side < sides_.size(); ++side) {
            std::vector<int> nodes = {sides_[side][0], sides_[side][1]};
            nodes.insert(nodes.end(), on_side_[side].begin(), on_side_[side].end());
            connect(std::move(nodes));
        }
        graph_.border_count = static_cast<int>(graph_.segments.size());
        for (const CutFold& fold : folds_)
            for (const Chain& chain : fold.chains) connect(chain.nodes);
        return graph_;
    }

  private:
    struct CutFold {
        Line line;
        std::vector<Chain> chains;
    };

    static std::string refusal(const FoldLine& fold, const char* why)
    {
        const auto& [p, q] = fold.line;
        return fmt::format("fold [[{}, {}], [{}, {}]]: {}", p.x(), p.y(), q.x(), q.y(), why);
    }

    static Line make_line(const FoldLine& fold)
    {
        const Vec2& p = fold.line[0];
        const Vec2 d = fold.line[1] - p;
        if (!p.allFinite() || !d.allFinite() || !(d.stableNorm() > 0.0))
            throw InputError(refusal(fold, "needs two different, finite points"));
        return {p, d.stableNormalized()};
    }

    // The distance of each corner of the border from the line; 0 within the tolerance.
    std::vector<double> corner_distances(const Line& line) const
    {
        std::vector<double> distances;
        for (int k = 0; k < corner_count_; ++k) {
            const double distance = line.distance(graph_.nodes[k]);
            distances.push_back(std::abs(distance) <= tolerance_ ? 0.0 : distance);
        }
        return distances;
    }

    // Where the line comes to the border, in order along the line; one meeting a node.
    std::vector<Meeting> meet_border(const Line& line)
    {
        const std::vector<double> distances = corner_distances(line);
        std::vector<Meeting> meetings;
        for (std::size_t side = 0; side < sides_.size(); ++side) {
            const auto [a, b] = sides_[side];
            const double from = distances[a], to = distances[b];
            const bool left = is_parted(from, to, 1.0), right = is_parted(from, to, -1.0);
            if (!left && !right) continue;
            const bool is_at_corner = !(from * to < 0.0);
            const int corner = std::abs(from) > 0.0 ? b : a;
            meetings.push_back(
                {is_at_corner ? corner : add_on_side(line, side, from / (from - to)), left, right});
        }
        const auto place = [&](const Meeting& m) {
            return (graph_.nodes[m.node] - line.point).dot(line.unit);
        };
        std::sort(meetings.begin(), meetings.end(), [&](const Meeting& m, const Meeting& n) {
            return std::pair(place(m), m.node) < std::pair(place(n), n.node);
        });
        std::vector<Meeting> merged;
        for (const Meeting& meeting : meetings) {
            if (merged.empty() || merged.back().node != meeting.node)
                merged.push_back({meeting.node, false, false});
            merged.back().toggles_left = merged.back().toggles_left != meeting.toggles_left;
            merged.back().toggles_right = merged.back().toggles_right != meeting.toggles_right;
        }
        return merged;
    }

    bool is_near(int node, const Vec2& X) const { return (graph_.nodes[node] - X).norm() <= tolerance_; }

    int add_node(const Vec2& X)
    {
        graph_.nodes.push_back(X);
        return static_cast<int>(graph_.nodes.size()) - 1;
    }

    int add_on_side(const Line& line, std::size_t side, double share)
    {
        const Vec2 X = cut(line, sides_[side], share);
        for (const int node : on_side_[side])
            if (is_near(node, X)) return node;
        on_side_[side].push_back(add_node(X));
        return on_side_[side].back();
    }

    // The point of the line on a side, `share` of the way along it. On a horizontal or vertical side the
    // point is exact in the coordinate that the ends share.
    Vec2 cut(const Line& line, const std::array<int, 2>& side, double share) const
    {
        const Vec2& a = graph_.nodes[side[0]];
        const Vec2& b = graph_.nodes[side[1]];
        Vec2 X = a + share * (b - a);
        for (const int axis : {0, 1}) {
            const int other = 1 - axis;
            if (a[axis] < b[axis] || a[axis] > b[axis]) continue;
            const double along = (a[axis] - line.point[axis]) / line.unit[axis];
            X[axis] = a[axis];
            X[other] = line.point[other] + line.unit[other] * along;
        }
        return X.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
    }

    // Parts of a fold that another fold's line cuts; at most one, but for rounding.
    std::vector<Chain*> chains_across(CutFold& fold, const Line& line) const
    {
        std::vector<Chain*> found;
        for (Chain& chain : fold.chains) {
            const double a = line.distance(graph_.nodes[chain.nodes[0]]);
            const double b = line.distance(graph_.nodes[chain.nodes[1]]);
            if (!(a * b > 0.0)) found.push_back(&chain);
        }
        return found;
    }

    void cross(CutFold& first, CutFold& second)
    {
        const std::vector<Chain*> others = chains_across(second, first.line);
        for (Chain* chain : chains_across(first, second.line))
            for (Chain* other : others) cross(*chain, *other);
    }

    void cross(Chain& first, Chain& second)
    {
        const Vec2 p = graph_.nodes[first.nodes[0]];
        const Vec2 q = graph_.nodes[second.nodes[0]];
        const Vec2 d = graph_.nodes[first.nodes[1]] - p;
        const Vec2 e = graph_.nodes[second.nodes[1]] - q;
        for (const int n : {0, 1})
            if (first.nodes[n] == second.nodes[0] || first.nodes[n] == second.nodes[1]) return;
        // p + s d = q + r e
        const double determinant = d.x() * e.y() - d.y() * e.x();
        const double s = ((q.x() - p.x()) * e.y() - (q.y() - p.y()) * e.x()) / determinant;
        const double r = ((q.x() - p.x()) * d.y() - (q.y() - p.y()) * d.x()) / determinant;
        if (!(s > 0.0 && s < 1.0 && r > 0.0 && r < 1.0)) return;
        const int node = crossing_node(p + s * d);
        first.nodes.push_back(node);
        second.nodes.push_back(node);
    }

    // Folds may cross in one point, also with their ends.
    int crossing_node(const Vec2& X)
    {
        for (int n = corner_count_; n < static_cast<int>(graph_.nodes.size()); ++n)
            if (is_near(n, X)) return n;
        return add_node(X);
    }

    // `nodes` lie on one line from nodes[0] to nodes[1].
    void connect(std::vector<int> nodes)
    {
        const Vec2 origin = graph_.nodes[nodes[0]];
        const Vec2 along = graph_.nodes[nodes[1]] - origin;
        const auto place = [&](int n) { return (graph_.nodes[n] - origin).dot(along); };
        std::sort(nodes.begin(), nodes.end(), [&](int m, int n) { return place(m) < place(n); });
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
            graph_.segments.push_back({nodes[k], nodes[k + 1]});
    }

    MeshLines graph_;
    int corner_count_ = 0;
    double tolerance_ = 0.0;
    std::vector<std::array<int, 2>> sides_;  // of the border, as nodes
    std::vector<std::vector<int>> on_side_;  // nodes that folds put on each side
    std::vector<CutFold> folds_;
    std::set<std::pair<int, int>> known_ends_;
};

}  // namespace

BorderLoops rectangle_border(const Vec2& size)
{
    return {{Vec2(0.0, 0.0), Vec2(size.x(), 0.0), size, Vec2(0.0, size.y())}};
}

MeshLines make_mesh_lines(const BorderLoops& border, const std::vector<FoldLine>& folds)
{
    GraphBuilder builder(border);
    for (const FoldLine& fold : folds) builder.add_fold(fold);
    return builder.build();
}

}  // namespace arris
