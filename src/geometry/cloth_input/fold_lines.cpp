// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/fold_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/input_error.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

// Points nearer than this share of the longer side are one point: far above rounding, far below any edge.
constexpr double kSamePoint = 1e-12;

// A fold line from border to border, with the nodes on it.
struct Chain {
    std::vector<int> nodes;
};

class GraphBuilder {
  public:
    explicit GraphBuilder(const Vec2& size) : size_(size), tolerance_(kSamePoint * size.maxCoeff())
    {
        graph_.nodes = {Vec2(0.0, 0.0), Vec2(size.x(), 0.0), size, Vec2(0.0, size.y())};
    }

    void add_fold(const Fold& fold)
    {
        const std::vector<int> ends = clip(fold);
        if (ends.size() != 2) throw InputError(refusal(fold, "its line does not run through the cloth"));
        if (is_along_border(ends)) return;
        for (const Chain& chain : chains_)
            if (std::minmax(chain.nodes[0], chain.nodes[1]) == std::minmax(ends[0], ends[1])) return;
        chains_.push_back({ends});
    }

    FoldLines build()
    {
        for (std::size_t i = 0; i < chains_.size(); ++i)
            for (std::size_t j = i + 1; j < chains_.size(); ++j) cross(chains_[i], chains_[j]);
        for (int side = 0; side < 4; ++side) connect(nodes_on_side(side));
        graph_.border_count = static_cast<int>(graph_.segments.size());
        for (const Chain& chain : chains_) connect(chain.nodes);
        return graph_;
    }

  private:
    static std::string refusal(const Fold& fold, const char* why)
    {
        const auto& [p, q] = fold.line;
        return fmt::format("fold [[{}, {}], [{}, {}]]: {}", p.x(), p.y(), q.x(), q.y(), why);
    }

    int add_node(const Vec2& X)
    {
        for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n)
            if ((graph_.nodes[n] - X).norm() <= tolerance_) return n;
        graph_.nodes.push_back(X);
        return static_cast<int>(graph_.nodes.size()) - 1;
    }

    // The point of the line p + s d whose coordinate `axis` is `bound`. Both coordinates are exact if the
    // line is perpendicular to that side.
    Vec2 on_side(const Vec2& p, const Vec2& d, int axis, double bound) const
    {
        const int other = 1 - axis;
        Vec2 X;
        X[axis] = bound;
        X[other] = std::clamp(p[other] + d[other] * ((bound - p[axis]) / d[axis]), 0.0, size_[other]);
        return X;
    }

    std::vector<int> clip(const Fold& fold)
    {
        const Vec2& p = fold.line[0];
        const Vec2 d = fold.line[1] - p;
        if (!p.allFinite() || !d.allFinite() || !(d.stableNorm() > 0.0))
            throw InputError(refusal(fold, "needs two different, finite points"));
        const Vec2 unit = d.stableNormalized();
        std::array<double, 4> left;
        std::vector<int> ends;
        for (int k = 0; k < 4; ++k) {
            const Vec2 from = graph_.nodes[k] - p;
            left[k] = unit.x() * from.y() - unit.y() * from.x();
            if (std::abs(left[k]) <= tolerance_) {
                left[k] = 0.0;
                ends.push_back(k);
            }
        }
        for (int k = 0; k < 4; ++k) {
            if (!(left[k] * left[(k + 1) % 4] < 0.0)) continue;
            const int axis = k % 2 == 0 ? 1 : 0;  // sides 0 and 2 are horizontal: their v is fixed
            ends.push_back(add_node(on_side(p, unit, axis, graph_.nodes[k][axis])));
        }
        sort_unique(ends);
        return ends;
    }

    bool is_along_border(const std::vector<int>& ends) const
    {
        const Vec2& a = graph_.nodes[ends[0]];
        const Vec2& b = graph_.nodes[ends[1]];
        for (int axis = 0; axis < 2; ++axis)
            for (const double bound : {0.0, size_[axis]})
                if (std::abs(a[axis] - bound) <= tolerance_ && std::abs(b[axis] - bound) <= tolerance_)
                    return true;
        return false;
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
        const int node = add_node(p + s * d);
        first.nodes.push_back(node);
        second.nodes.push_back(node);
    }

    std::vector<int> nodes_on_side(int side) const
    {
        std::vector<int> nodes = {side, (side + 1) % 4};
        const int axis = side % 2 == 0 ? 1 : 0;
        const double bound = graph_.nodes[side][axis];
        for (int n = 4; n < static_cast<int>(graph_.nodes.size()); ++n)
            if (std::abs(graph_.nodes[n][axis] - bound) <= tolerance_) nodes.push_back(n);
        return nodes;
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

    Vec2 size_;
    double tolerance_;
    FoldLines graph_;
    std::vector<Chain> chains_;
};

}  // namespace

FoldLines make_fold_lines(const Vec2& size, const std::vector<Fold>& folds)
{
    GraphBuilder builder(size);
    for (const Fold& fold : folds) builder.add_fold(fold);
    return builder.build();
}

}  // namespace arris
