// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/soup_weld.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "geometry/obstacle_input/repair/vertex_origins.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

// Cell width in tolerances. In cells this wide, a search seldom covers a second cell, and a cell holds few
// points that are farther apart than the tolerance.
constexpr double kCellTolerances = 8.0;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const
    {
        std::uint64_t hash = 0;
        for (const std::int64_t k : cell)
            hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u ^ (hash >> 29);
        return hash ^ (hash >> 32);
    }
};

// Points in the cells of a grid. Finds the first point, by number, within the tolerance.
class WeldGrid {
  public:
    WeldGrid(const Vec3& origin, double tolerance)
        : origin_(origin), tolerance_(tolerance), cell_(kCellTolerances * tolerance)
    {
    }

    int find_or_add(const std::vector<Vec3>& points, int candidate)
    {
        const Vec3& p = points[candidate];
        const Cell low = cell_of(p - Vec3::Constant(tolerance_));
        const Cell high = cell_of(p + Vec3::Constant(tolerance_));
        int found = candidate;
        for (std::int64_t i = low[0]; i <= high[0]; ++i)
            for (std::int64_t j = low[1]; j <= high[1]; ++j)
                for (std::int64_t k = low[2]; k <= high[2]; ++k)
                    if (const auto at = cells_.find({i, j, k}); at != cells_.end())
                        for (const int q : at->second)
                            if (q < found && (points[q] - p).squaredNorm() <= tolerance_ * tolerance_)
                                found = q;
        if (found == candidate) cells_[cell_of(p)].push_back(candidate);
        return found;
    }

  private:
    // Within the bounding box, cell numbers stay below 1e6 / kCellTolerances.
    Cell cell_of(const Vec3& p) const
    {
        const Vec3 scaled = ((p - origin_) / cell_).array().floor();
        return {static_cast<std::int64_t>(scaled.x()), static_cast<std::int64_t>(scaled.y()),
                static_cast<std::int64_t>(scaled.z())};
    }

    Vec3 origin_;
    double tolerance_;
    double cell_;
    std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

void rename(ObstacleMesh& soup, const std::vector<int>& name)
{
    for (Face& face : soup.faces)
        for (int& p : face) p = name[p];
    for (std::array<int, 2>& segment : soup.segments)
        for (int& p : segment) p = name[p];
    for (int& p : soup.lone_points) p = name[p];
}

std::vector<char> used_points(const ObstacleMesh& soup)
{
    std::vector<char> is_used(soup.points.size(), 0);
    for (const Face& face : soup.faces)
        for (const int p : face) is_used[p] = 1;
    for (const std::array<int, 2>& segment : soup.segments)
        for (const int p : segment) is_used[p] = 1;
    for (const int p : soup.lone_points) is_used[p] = 1;
    return is_used;
}

// Returns the index that each point has afterwards; -1 for those dropped.
std::vector<int> drop_unused_points(ObstacleMesh& soup)
{
    const std::vector<char> is_used = used_points(soup);
    std::vector<int> name(soup.points.size(), -1);
    int kept = 0;
    for (std::size_t p = 0; p < soup.points.size(); ++p)
        if (is_used[p] != 0) {
            soup.points[kept] = soup.points[p];
            name[p] = kept++;
        }
    soup.points.resize(kept);
    rename(soup, name);
    return name;
}

// Marks the points of borders, wires and lone points.
std::vector<char> loose_points(const ObstacleMesh& soup)
{
    std::vector<std::array<int, 2>> edges;
    edges.reserve(3 * soup.faces.size());
    for (const Face& face : soup.faces)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(face[k], face[(k + 1) % 3]);
            if (low != high) edges.push_back({low, high});
        }
    std::sort(edges.begin(), edges.end());
    std::vector<char> is_loose(soup.points.size(), 0);
    for (std::size_t e = 0; e < edges.size();) {
        std::size_t end = e + 1;
        while (end < edges.size() && edges[end] == edges[e]) ++end;
        if (end - e == 1) is_loose[edges[e][0]] = is_loose[edges[e][1]] = 1;
        e = end;
    }
    for (const std::array<int, 2>& segment : soup.segments)
        for (const int p : segment) is_loose[p] = 1;
    for (const int p : soup.lone_points) is_loose[p] = 1;
    return is_loose;
}

JoinedPoints join_near(ObstacleMesh& soup, double& tolerance)
{
    JoinedPoints joined;
    joined.names.resize(soup.points.size());
    std::iota(joined.names.begin(), joined.names.end(), 0);
    Eigen::AlignedBox3d bounds;
    for (const Vec3& p : soup.points) bounds.extend(p);
    if (bounds.isEmpty()) return joined;
    tolerance = kSinglePrecision * bounds.diagonal().stableNorm();
    // All points coincide, or cell numbers would overflow: no points are near but unequal.
    if (!(tolerance > std::numeric_limits<double>::min())) return joined;
    WeldGrid grid(bounds.min(), tolerance);
    const std::vector<char> is_loose = loose_points(soup);
    const int count = static_cast<int>(soup.points.size());
    for (int p = 0; p < count; ++p) {
        if (is_loose[p] != 0) joined.names[p] = grid.find_or_add(soup.points, p);
        if (joined.names[p] != p) ++joined.count;
    }
    if (joined.count > 0) rename(soup, joined.names);
    return joined;
}

// Keeps the first of each set of elements with the same points; returns the number dropped.
template <class Element>
int drop_duplicates(std::vector<Element>& elements)
{
    std::vector<std::pair<Element, int>> keys(elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i) {
        keys[i] = {elements[i], static_cast<int>(i)};
        if constexpr (requires { keys[i].first.begin(); })
            std::sort(keys[i].first.begin(), keys[i].first.end());
    }
    std::sort(keys.begin(), keys.end());
    std::vector<char> is_duplicate(elements.size(), 0);
    for (std::size_t k = 1; k < keys.size(); ++k)
        if (keys[k].first == keys[k - 1].first) is_duplicate[keys[k].second] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (is_duplicate[i] == 0) elements[kept++] = elements[i];
    const int dropped = static_cast<int>(elements.size() - kept);
    elements.resize(kept);
    return dropped;
}

}  // namespace

JoinedPoints join_equal_points(ObstacleMesh& soup)
{
    JoinedPoints joined;
    joined.names = drop_unused_points(soup);
    std::vector<int> order(soup.points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto before = [&](int i, int j) {
        const Vec3& p = soup.points[i];
        const Vec3& q = soup.points[j];
        if (p.x() != q.x()) return p.x() < q.x();
        if (p.y() != q.y()) return p.y() < q.y();
        if (p.z() != q.z()) return p.z() < q.z();
        return i < j;
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<int> name(soup.points.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool is_equal = k > 0 && soup.points[order[k]] == soup.points[order[k - 1]];
        name[order[k]] = is_equal ? name[order[k - 1]] : order[k];
        if (is_equal) ++joined.count;
    }
    rename(soup, name);
    joined.names = compose_names(std::move(joined.names), name);
    joined.names = compose_names(std::move(joined.names), drop_unused_points(soup));
    return joined;
}

WeldCounts weld(ObstacleMesh& soup)
{
    WeldCounts counts;
    const JoinedPoints equal = join_equal_points(soup);
    const JoinedPoints near = join_near(soup, counts.tolerance);
    counts.equal_points = equal.count;
    counts.near_points = near.count;

    const auto is_collapsed = [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; };
    counts.collapsed_faces = static_cast<int>(std::erase_if(soup.faces, is_collapsed));
    const auto is_zero = [](const std::array<int, 2>& s) { return s[0] == s[1]; };
    counts.zero_segments = static_cast<int>(std::erase_if(soup.segments, is_zero));

    counts.duplicate_faces = drop_duplicates(soup.faces);
    counts.duplicate_segments = drop_duplicates(soup.segments);
    counts.duplicate_lone_points = drop_duplicates(soup.lone_points);
    counts.names = compose_names(compose_names(equal.names, near.names), drop_unused_points(soup));
    return counts;
}

}  // namespace arris
