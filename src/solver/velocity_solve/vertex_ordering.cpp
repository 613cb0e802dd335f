// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/vertex_ordering.h"

#include <cholmod.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <csignal>
#include <new>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace arris {
namespace {

/// Both directions of a graph's edges, without those from a vertex to itself.
struct Neighbours {
    std::vector<int> start, vertex;

    explicit Neighbours(const VertexGraph& graph) : start(graph.start.size() + 1, 0)
    {
        const auto for_each_edge = [&](const auto& visit) {
            for (int v = 0; v < graph.size(); ++v)
                for (int k = graph.start[v]; k < graph.start[v + 1]; ++k)
                    if (graph.neighbour[k] != v) visit(v, graph.neighbour[k]);
        };
        for_each_edge([&](int v, int w) { ++start[v + 2], ++start[w + 2]; });
        std::partial_sum(start.begin(), start.end(), start.begin());
        vertex.resize(static_cast<std::size_t>(start.back()));
        for_each_edge([&](int v, int w) { vertex[start[v + 1]++] = w, vertex[start[w + 1]++] = v; });
    }
};

/// Directions across which parts are cut: meshes of cells divided by parallel diagonals have the smallest
/// separators along those.
const std::array<Vec2, 4> kDirections = {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, -1)};

/// Parts are cut where the separator is smallest among the places that leave each side at least this share.
constexpr double kLeastShare = 0.4;

/// Parts of at most so many vertices are not divided further. With 1 there is no less fill.
constexpr int kWhole = 4;

class Dissection {
  public:
    Dissection(const VertexGraph& graph, const std::vector<Vec2>& place)
        : neighbours_(graph),
          part_of_(place.size(), 0),
          rank_(place.size()),
          reach_(place.size()),
          side_(place.size(), 0)
    {
        for (std::size_t d = 0; d < sorted_.size(); ++d) {
            std::vector<double> along;
            for (const Vec2& at : place) along.push_back(kDirections[d].dot(at));
            sorted_[d].resize(place.size());
            std::iota(sorted_[d].begin(), sorted_[d].end(), 0);
            std::sort(sorted_[d].begin(), sorted_[d].end(), [&](int v, int w) {
                return std::tie(along[v], place[v].y(), v) < std::tie(along[w], place[w].y(), w);
            });
        }
    }

    std::vector<int> order()
    {
        divide(0, static_cast<int>(part_of_.size()));
        return std::move(sorted_[0]);
    }

  private:
    static constexpr std::size_t kCount = kDirections.size();

    /// Where a part is cut.
    struct Cut {
        int separator;  ///< vertices
        std::size_t direction;
        int rank;          ///< of the second side's first vertex
        bool is_of_first;  ///< whether the separator is a part of the first side
    };

    /// Ranks of a vertex and its neighbours in the part along each direction.
    struct Reach {
        std::array<int, kCount> first, last;
    };

    /// Orders the part of the vertices sorted_[d][begin] to sorted_[d][end - 1]: one side, the other, the
    /// separator.
    void divide(int begin, int end)
    {
        if (end - begin <= kWhole) return;
        const int own = ++parts_;
        for (std::size_t d = 0; d < kCount; ++d)
            for (int k = begin; k < end; ++k) rank_[sorted_[d][k]][d] = k - begin;
        for (int k = begin; k < end; ++k) part_of_[sorted_[0][k]] = own;
        const Cut cut = find_cut(begin, end);
        std::array<int, 3> size = {};
        for (int k = begin; k < end; ++k) {
            const int v = sorted_[0][k];
            const bool is_first = rank_[v][cut.direction] < cut.rank;
            const bool is_on_border = is_first ? reach_[v].last[cut.direction] >= cut.rank
                                               : reach_[v].first[cut.direction] < cut.rank;
            side_[v] = is_first == cut.is_of_first && is_on_border ? 2 : is_first ? 0 : 1;
            ++size[side_[v]];
        }
        for (std::vector<int>& sorted : sorted_) {
            std::array<int, 3> next = {0, size[0], size[0] + size[1]};
            moved_.resize(static_cast<std::size_t>(end - begin));
            for (int k = begin; k < end; ++k) moved_[next[side_[sorted[k]]]++] = sorted[k];
            std::copy(moved_.begin(), moved_.end(), sorted.begin() + begin);
        }
        divide(begin, begin + size[0]);
        divide(begin + size[0], begin + size[0] + size[1]);
    }

    Reach reach_of(int v) const
    {
        Reach reach = {rank_[v], rank_[v]};
        for (int k = neighbours_.start[v]; k < neighbours_.start[v + 1]; ++k) {
            const int w = neighbours_.vertex[k];
            if (part_of_[w] != part_of_[v]) continue;
            for (std::size_t d = 0; d < kCount; ++d) {
                reach.first[d] = std::min(reach.first[d], rank_[w][d]);
                reach.last[d] = std::max(reach.last[d], rank_[w][d]);
            }
        }
        return reach;
    }

    /// The separator of a cut at rank c is the vertices before c that reach c or beyond, or those from c on
    /// that reach before c.
    Cut find_cut(int begin, int end)
    {
        const int size = end - begin, middle = size / 2,
                  least = std::max(1, static_cast<int>(kLeastShare * size));
        for (std::size_t d = 0; d < kCount; ++d) {
            first_[d].assign(static_cast<std::size_t>(size) + 1, 0);
            second_[d].assign(static_cast<std::size_t>(size) + 1, 0);
        }
        for (int k = begin; k < end; ++k) {
            const int v = sorted_[0][k];
            const Reach& reach = reach_[v] = reach_of(v);
            for (std::size_t d = 0; d < kCount; ++d) {
                ++first_[d][rank_[v][d] + 1], --first_[d][reach.last[d] + 1];
                ++second_[d][reach.first[d] + 1], --second_[d][rank_[v][d] + 1];
            }
        }
        Cut best = {size + 1, 0, middle, true};
        for (std::size_t d = 0; d < kCount; ++d) {
            std::partial_sum(first_[d].begin(), first_[d].end(), first_[d].begin());
            std::partial_sum(second_[d].begin(), second_[d].end(), second_[d].begin());
            const auto try_at = [&](int rank) {
                const int first = first_[d][rank], second = second_[d][rank];
                if (std::min(first, second) < best.separator)
                    best = {std::min(first, second), d, rank, first < second};
            };
            try_at(middle);
            for (int away = 1; middle - away >= least; ++away) {
                try_at(middle - away);
                try_at(middle + away);
            }
        }
        return best;
    }

    Neighbours neighbours_;
    std::array<std::vector<int>, kCount> sorted_;  ///< vertices; a part has the same places in each
    std::vector<int> part_of_;                     ///< the last part that each vertex was in
    int parts_ = 0;
    std::vector<std::array<int, kCount>> rank_;  ///< of each vertex in its part
    std::vector<Reach> reach_;
    std::vector<char> side_;                               ///< of each vertex: 0, 1, 2: the separator
    std::array<std::vector<int>, kCount> first_, second_;  ///< sizes of the separators of each cut
    std::vector<int> moved_;
};

}  // namespace

VertexGraph::VertexGraph(const Eigen::SparseMatrix<double>& matrix)
{
    assert(matrix.cols() % 3 == 0 && "three unknowns a vertex");
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int v = 0; 3 * v < static_cast<int>(matrix.cols()); ++v) {
        for (int k = outer[3 * v]; k < outer[3 * v + 1]; k += 3) neighbour.push_back(inner[k] / 3);
        start.push_back(static_cast<int>(neighbour.size()));
    }
    assert(9 * neighbour.size() == static_cast<std::size_t>(matrix.nonZeros()) && "whole blocks");
}

bool VertexGraph::is_of(const Eigen::SparseMatrix<double>& matrix) const
{
    if (3 * size() != matrix.cols() || 9 * static_cast<Eigen::Index>(neighbour.size()) != matrix.nonZeros())
        return false;
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int v = 0; v < size(); ++v) {
        const int first = outer[3 * v];
        if (outer[3 * v + 1] - first != 3 * (start[v + 1] - start[v])) return false;
        for (int k = start[v]; k < start[v + 1]; ++k)
            if (inner[first + 3 * (k - start[v])] != 3 * neighbour[k]) return false;
    }
    return true;
}

cholmod_sparse VertexGraph::pattern()
{
    cholmod_sparse sparse = {};
    sparse.nrow = sparse.ncol = static_cast<std::size_t>(size());
    sparse.nzmax = neighbour.size();
    sparse.p = start.data();
    sparse.i = neighbour.data();
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_PATTERN;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.packed = 1;
    return sparse;
}

std::vector<int> order_by_metis(VertexGraph& graph, cholmod_common& common)
{
    cholmod_sparse pattern = graph.pattern();
    std::vector<int> vertices(pattern.nrow);
    const auto has_ordered = [&] {
        return cholmod_metis(&pattern, nullptr, 0, 1, vertices.data(), &common) != 0;
    };
    if (has_ordered()) return vertices;
    // METIS handles SIGTERM itself while it works, and then returns an error status without a reason. The
    // signal was meant for the program: it is raised again, and METIS runs once more.
    if (common.status == CHOLMOD_INVALID) {
        std::raise(SIGTERM);
        if (has_ordered()) return vertices;
    }
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::length_error("the vertex graph is too large to be ordered");
}

std::vector<int> dissect(const VertexGraph& graph, const std::vector<Vec2>& place)
{
    assert(std::all_of(place.begin(), place.end(), [](const Vec2& at) { return at.allFinite(); }));
    return Dissection(graph, place).order();
}

}  // namespace arris
