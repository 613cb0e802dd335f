// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/shell_orientation.h"

#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/iterator/function_output_iterator.hpp>
#include <memory>
#include <set>
#include <utility>

#include "geometry/cgal.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {
namespace {

using SurfaceMesh = CGAL::Surface_mesh<Point3>;
using Side = CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>;
using Tree = Side::AABB_tree;

SurfaceMesh to_surface_mesh(const ObstacleMesh& mesh)
{
    SurfaceMesh surface;
    for (const Vec3& p : mesh.points) surface.add_vertex(to_cgal(p));
    const auto vertex = [](int p) { return SurfaceMesh::Vertex_index(static_cast<unsigned>(p)); };
    for (const auto& [a, b, c] : mesh.faces) surface.add_face(vertex(a), vertex(b), vertex(c));
    return surface;
}

class ShellOrienter {
  public:
    explicit ShellOrienter(ObstacleMesh& mesh)
        : mesh_(mesh), topology_(make_topology(mesh)), surface_(to_surface_mesh(mesh))
    {
        const int count = static_cast<int>(topology_.is_solid.size());
        faces_.resize(count);
        bounds_.resize(count);
        for (int f = 0; f < static_cast<int>(mesh_.faces.size()); ++f) {
            const int c = topology_.component[f];
            faces_[c].push_back(f);
            for (const int p : mesh_.faces[f]) bounds_[c].extend(mesh_.points[p]);
        }
        sides_.resize(count);
        trees_.resize(count);
    }

    ShellReport orient()
    {
        for (int e = 0; e < topology_.surface_edge_count; ++e)
            if (topology_.edges[e].faces[1] < 0) ++report_.border_edges;
        find_crossings();
        const int count = static_cast<int>(faces_.size());
        std::vector<char> is_turned(count, 0);
        for (int c = 0; c < count; ++c) {
            if (topology_.is_solid[c] == 0) continue;
            const bool is_cavity = depth(c) % 2 == 1;
            if (is_cavity) ++report_.cavities;
            is_turned[c] = (signed_volume(c) < 0.0) != is_cavity ? 1 : 0;
        }
        for (int c = 0; c < count; ++c)
            if (is_turned[c] != 0) turn(c);
        return report_;
    }

  private:
    void find_crossings()
    {
        std::pair<int, int> first;
        const auto take = [&](const std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>& pair) {
            const int f = static_cast<int>(static_cast<std::size_t>(pair.first));
            const int g = static_cast<int>(static_cast<std::size_t>(pair.second));
            const std::pair<int, int> faces(std::min(f, g), std::max(f, g));
            if (report_.crossing_pairs == 0 || faces < first) first = faces;
            ++report_.crossing_pairs;
            const int a = topology_.component[f], b = topology_.component[g];
            if (a != b) crossing_.insert({std::min(a, b), std::max(a, b)});
        };
        CGAL::Polygon_mesh_processing::self_intersections(surface_,
                                                          boost::make_function_output_iterator(take));
        if (report_.crossing_pairs > 0)
            report_.crossing_place = bounds_of(first.first).intersection(bounds_of(first.second)).center();
    }

    Eigen::AlignedBox3d bounds_of(int face) const
    {
        Eigen::AlignedBox3d bounds;
        for (const int p : mesh_.faces[face]) bounds.extend(mesh_.points[p]);
        return bounds;
    }

    // Number of shells that contain `shell`.
    int depth(int shell)
    {
        int inside = 0;
        for (int other = 0; other < static_cast<int>(faces_.size()); ++other) {
            if (other == shell || topology_.is_solid[other] == 0) continue;
            if (!bounds_[other].contains(bounds_[shell])) continue;
            if (crossing_.contains({std::min(shell, other), std::max(shell, other)})) continue;
            if (is_inside(shell, other)) ++inside;
        }
        return inside;
    }

    // For shells that do not cross, one point of the inner shell decides, if it is not on the outer shell.
    bool is_inside(int inner, int outer)
    {
        if (!sides_[outer]) {
            std::vector<SurfaceMesh::Face_index> faces;
            for (const int f : faces_[outer]) faces.emplace_back(static_cast<unsigned>(f));
            trees_[outer] = std::make_unique<Tree>(faces.begin(), faces.end(), surface_);
            sides_[outer] = std::make_unique<Side>(*trees_[outer]);
        }
        for (const int f : faces_[inner])
            for (const int p : mesh_.faces[f]) {
                const CGAL::Bounded_side side = (*sides_[outer])(to_cgal(mesh_.points[p]));
                if (side != CGAL::ON_BOUNDARY) return side == CGAL::ON_BOUNDED_SIDE;
            }
        return false;
    }

    // Six times the signed volume, computed about the shell's own middle, where rounding is smallest.
    double signed_volume(int shell) const
    {
        const Vec3 middle = bounds_[shell].center();
        double volume = 0.0;
        for (const int f : faces_[shell]) {
            const auto& [a, b, c] = mesh_.faces[f];
            const Vec3 p = mesh_.points[a] - middle;
            const Vec3 q = mesh_.points[b] - middle;
            const Vec3 r = mesh_.points[c] - middle;
            volume += p.dot(q.cross(r));
        }
        return volume;
    }

    void turn(int shell)
    {
        ++report_.turned_shells;
        for (const int f : faces_[shell]) std::swap(mesh_.faces[f][1], mesh_.faces[f][2]);
    }

    ObstacleMesh& mesh_;
    ObstacleTopology topology_;
    SurfaceMesh surface_;
    std::vector<std::vector<int>> faces_;       // faces of each component
    std::vector<Eigen::AlignedBox3d> bounds_;   // bounds of each component
    std::vector<std::unique_ptr<Tree>> trees_;  // tree of each component, built when needed
    std::vector<std::unique_ptr<Side>> sides_;  // side test of each component, built when needed
    std::set<std::pair<int, int>> crossing_;    // pairs of components that cross, each ascending
    ShellReport report_;
};

}  // namespace

ShellReport orient_shells(ObstacleMesh& mesh)
{
    if (mesh.faces.empty()) return {};
    return ShellOrienter(mesh).orient();
}

}  // namespace arris
