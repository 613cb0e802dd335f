// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/initial_target.h"

#include <algorithm>
#include <limits>

#include "geometry/box_tree.h"
#include "geometry/material_location.h"
#include "geometry/mesh_topology.h"

namespace arris {
namespace {

constexpr double kRounding = 1e-12;  // relative, of a weighted mean of three: far more than it has

Vec3 flat(const Vec2& X)
{
    return {X.x(), X.y(), 0.0};
}

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
            const double angle = least_angle({{}, corners(f), {}});
            for (const int v : f) angle_[v] = std::min(angle_[v], angle);
        }
        std::vector<BoxTree::Box> boxes;
        for (const Face& f : faces_) {
            BoxTree::Box box;
            for (const int v : f) box.extend(flat(material_[v]));
            boxes.push_back(box);
        }
        tree_ = BoxTree(boxes);
    }

    double length(const Vec2& X) const
    {
        const Place at = find(X);
        double length = 0.0;
        for (int k = 0; k < 3; ++k) length += at.weights[k] * length_[faces_[at.face][k]];
        return length;
    }

    double mean_length() const { return mean_; }
    // Of what `length` interpolates, with room for its rounding.
    double shortest() const { return (1.0 - kRounding) * *std::min_element(length_.begin(), length_.end()); }
    double longest() const { return (1.0 + kRounding) * *std::max_element(length_.begin(), length_.end()); }

    double angle(const Vec2& X) const
    {
        const Face& f = faces_[find(X).face];
        return std::min({angle_[f[0]], angle_[f[1]], angle_[f[2]]});
    }

  private:
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

    // The face that comes nearest to holding the point, the first of these, among those within a reach that
    // grows until there is one: it passes any distance in as many rounds as a double has powers of two.
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
            const Vec3 slack(reach, reach, reach);
            tree_.visit(BoxTree::Box(flat(X) - slack, flat(X) + slack), judge);
        }
        return best.face >= 0 ? best : Place{0, best.weights};
    }

    std::vector<Vec2> material_;
    std::vector<Face> faces_;
    std::vector<double> length_;  // m, one a vertex
    std::vector<double> angle_;   // degrees, one a vertex
    double mean_ = 0.0;           // edge length, m
    BoxTree tree_;
};

}  // namespace

MeshTarget make_initial_target(const ClothMesh& initial, double most_angle)
{
    const InitialMesh mesh(initial, most_angle);
    return {[mesh](const Vec2& X) { return mesh.length(X); },
            [mesh](const Vec2& X) { return mesh.angle(X); },
            mesh.mean_length(),
            mesh.shortest(),
            mesh.longest(),
            most_angle};
}

}  // namespace arris
