// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/initial_target.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sewing.h"
#include "geometry/surgery/material_location.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

class InitialMesh {
  public:
    InitialMesh(const ClothMesh& mesh, double most_angle)
        : material_(mesh.material),
          faces_(mesh.faces),
          length_(mesh.material.size(), 0.0),
          angle_(mesh.material.size(), most_angle)
    {
        measure_lengths();
        for (const Face& f : faces_) {
            const double angle = least_angle({{}, corners(f), {}, {}});
            for (const int v : f) angle_[v] = std::min(angle_[v], angle);
        }
        sort_into_cells();
    }

    double length(const Vec2& X) const
    {
        const Place at = find(X);
        double length = 0.0;
        for (int k = 0; k < 3; ++k) length += at.weights[k] * length_[faces_[at.face][k]];
        return length;
    }

    double mean_length() const { return mean_; }
    // Bounds on `length`, widened by its rounding.
    double shortest() const { return (1.0 - kComputed) * *std::min_element(length_.begin(), length_.end()); }
    double longest() const { return (1.0 + kComputed) * *std::max_element(length_.begin(), length_.end()); }

    double angle(const Vec2& X) const
    {
        const Face& f = faces_[find(X).face];
        return std::min({angle_[f[0]], angle_[f[1]], angle_[f[2]]});
    }

  private:
    using Box = Eigen::AlignedBox2d;

    Box box_of(const Face& f) const
    {
        Box box;
        for (const int v : f) box.extend(material_[v]);
        return box;
    }

    // About as many cells as faces, so that a few are in each.
    void sort_into_cells()
    {
        Box whole;
        for (const Vec2& X : material_) whole.extend(X);
        const Vec2 size = whole.sizes();
        const double cell = std::sqrt(size.x() * size.y() / double(faces_.size()));
        low_ = whole.min();
        for (int k = 0; k < 2; ++k) {
            count_[k] = static_cast<int>(std::clamp(std::ceil(size[k] / cell), 1.0, double(faces_.size())));
            per_length_[k] = count_[k] / size[k];
        }
        std::vector<std::vector<int>> cells(static_cast<std::size_t>(count_[0]) * count_[1]);
        for (std::size_t f = 0; f < faces_.size(); ++f)
            for_each_cell(box_of(faces_[f]), [&](std::size_t c) { cells[c].push_back(static_cast<int>(f)); });
        cells_ = std::move(cells);
    }

    // Parts of the box outside the grid count as in the cells at its border.
    template <typename Take>
    void for_each_cell(const Box& box, const Take& take) const
    {
        std::array<int, 2> first, last;
        for (int k = 0; k < 2; ++k) {
            const auto cell = [&](double x) {
                return static_cast<int>(
                    std::min(count_[k] - 1.0, std::max(0.0, (x - low_[k]) * per_length_[k])));
            };
            first[k] = cell(box.min()[k]);
            last[k] = cell(box.max()[k]);
        }
        for (int i = first[0]; i <= last[0]; ++i)
            for (int j = first[1]; j <= last[1]; ++j) take(static_cast<std::size_t>(i) * count_[1] + j);
    }

    // Visits the faces whose boxes touch `box`, some of them more than once.
    template <typename Take>
    void visit(const Box& box, const Take& take) const
    {
        for_each_cell(box, [&](std::size_t c) {
            for (const int f : cells_[c])
                if (box.intersects(box_of(faces_[f]))) take(f);
        });
    }

    struct Place {
        int face;
        Vec3 weights;
    };

    std::array<Vec2, 3> corners(const Face& f) const
    {
        return {material_[f[0]], material_[f[1]], material_[f[2]]};
    }

    void measure_lengths()
    {
        std::vector<int> count(material_.size(), 0);
        for (const MeshEdge& e : make_topology(static_cast<int>(material_.size()), faces_).edges) {
            const double length = (material_[e.b] - material_[e.a]).norm();
            mean_ += length;
            for (const int v : {e.a, e.b}) {
                length_[v] += length;
                ++count[v];
            }
        }
        int ends = 0;
        for (std::size_t v = 0; v < count.size(); ++v) {
            length_[v] /= count[v];
            ends += count[v];
        }
        mean_ *= 2.0 / ends;
    }

    // The face nearest to the point (lowest index on ties), among the faces within a reach. The reach doubles
    // until it contains a face: rounds are at most the powers of two of a double.
    Place find(const Vec2& X) const
    {
        Place best{-1, Vec3::Constant(1.0 / 3.0)};
        double least = std::numeric_limits<double>::infinity();
        const auto judge = [&](int f) {
            const std::array<Vec2, 3> at = corners(faces_[f]);
            const Vec3 weights = clamped_weights(at, X);
            const double off = (weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2] - X).norm();
            if (!(off < least) && !(off == least && f < best.face)) return;
            least = off;
            best = {f, weights};
        };
        for (double reach = 0.0;
             best.face < 0 && reach<std::numeric_limits<double>::infinity(); reach = reach> 0.0
                 ? 2.0 * reach
                 : 1e-9 * mean_) {
            const Vec2 slack(reach, reach);
            visit(Box(X - slack, X + slack), judge);
        }
        return best.face >= 0 ? best : Place{0, best.weights};
    }

    std::vector<Vec2> material_;
    std::vector<Face> faces_;
    std::vector<double> length_;           // m, one a vertex
    std::vector<double> angle_;            // degrees, one a vertex
    double mean_ = 0.0;                    // mean edge length, m
    Vec2 low_;                             // lower corner of the grid of cells, m
    Vec2 per_length_;                      // cells per metre
    std::array<int, 2> count_;             // number of cells in each direction
    std::vector<std::vector<int>> cells_;  // of each cell: faces whose boxes touch it, ascending
};

}  // namespace

MeshTarget make_initial_target(const ClothMesh& initial, double most_angle)
{
    const auto mesh = std::make_shared<const InitialMesh>(unsew(initial), most_angle);
    return {[mesh](const Vec2& X) { return mesh->length(X); },
            [mesh](const Vec2& X) { return mesh->angle(X); },
            {mesh->mean_length()},
            mesh->shortest(),
            mesh->longest(),
            most_angle};
}

}  // namespace arris
