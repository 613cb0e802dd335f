// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/soup_repair.h"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>

#include "geometry/cgal.h"
#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/obstacle_input/repair/border_seams.h"
#include "geometry/obstacle_input/repair/shell_orientation.h"
#include "geometry/obstacle_input/repair/soup_weld.h"

namespace arris {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

using SurfaceMesh = CGAL::Surface_mesh<Point3>;
using Polygon = std::array<std::size_t, 3>;

std::array<int, 2> edge_of(const Face& face, int k)
{
    const auto [low, high] = std::minmax(face[k], face[(k + 1) % 3]);
    return {low, high};
}

// CGAL does not check for NaN and wrong indices, so these checks come first.
void require_sound(const ObstacleMesh& soup)
{
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        const Vec3& p = soup.points[i];
        if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= kLargestCoordinate))
            throw InputError(
                fmt::format("vertex {} ({:g}, {:g}, {:g}) m must be finite and within {:g} m of the origin",
                            i + 1, p.x(), p.y(), p.z(), kLargestCoordinate));
    }
    const int count = static_cast<int>(soup.points.size());
    const auto require_index = [&](const char* what, std::size_t i, int p) {
        if (p < 0 || p >= count)
            throw InputError(fmt::format("{} {} names vertex {}, but there are {}", what, i + 1,
                                         static_cast<long long>(p) + 1, count));
    };
    for (std::size_t i = 0; i < soup.faces.size(); ++i)
        for (const int p : soup.faces[i]) require_index("face", i, p);
    for (std::size_t i = 0; i < soup.segments.size(); ++i)
        for (const int p : soup.segments[i]) require_index("segment", i, p);
    for (std::size_t i = 0; i < soup.lone_points.size(); ++i)
        require_index("lone point", i, soup.lone_points[i]);
}

// CGAL's orient_polygon_soup copies a point where two surfaces touch in it. Records the original of each
// copy.
struct CopyListener : PMP::Default_orientation_visitor {
    explicit CopyListener(std::vector<int>* origin) : origin_of(origin) {}
    void duplicated_vertex(std::size_t original, std::size_t copy)
    {
        if (origin_of->size() <= copy) origin_of->resize(copy + 1, -1);
        (*origin_of)[copy] = (*origin_of)[original];
    }
    std::vector<int>* origin_of;
};

class SoupRepairer {
  public:
    explicit SoupRepairer(ObstacleMesh soup) : soup_(std::move(soup)) {}

    RepairedSoup repair()
    {
        require_sound(soup_);
        WeldCounts welded = weld(soup_);
        tell(welded);
        drop_stray_flat_faces();
        if (!soup_.faces.empty()) {
            build_surface();
            remove_flat_faces();
            extract_surface();
            const ShellReport shells = orient_shells(mesh_);
            tell(shells, find_border_seams(mesh_, make_topology(mesh_)));
        }
        attach_wires_and_points();
        tell_flat_faces();
        if (mesh_.faces.empty() && mesh_.segments.empty() && mesh_.lone_points.empty())
            throw InputError("nothing is left of it: " +
                             (warnings_.empty() ? "no faces, lines or points" : warnings_.front()));
        return {std::move(mesh_), std::move(welded.names), std::move(origins_),
                welded.tolerance, std::move(warnings_),    std::move(notes_)};
    }

  private:
    void warn_of(const char* what, int count, const char* one, const char* many)
    {
        if (count > 0) warnings_.push_back(std::string(what) + " " + counted(count, one, many));
    }

    void tell(const WeldCounts& counts)
    {
        if (counts.near_points > 0)
            warnings_.push_back(
                fmt::format("welded {} ({} equal to others, {} within {:.3g} m)",
                            counted(counts.equal_points + counts.near_points, "vertex", "vertices"),
                            counts.equal_points, counts.near_points, counts.tolerance));
        else if (counts.equal_points > 0)  // formats without shared vertices produce equal points
            notes_.push_back("welded " + counted(counts.equal_points, "vertex that equals another",
                                                 "vertices that equal others"));
        warn_of("dropped", counts.collapsed_faces, "face that names a vertex twice",
                "faces that name a vertex twice");
        warn_of("dropped", counts.duplicate_faces, "duplicate face", "duplicate faces");
        warn_of("dropped", counts.zero_segments, "segment of no length", "segments of no length");
        warn_of("dropped", counts.duplicate_segments, "duplicate segment", "duplicate segments");
        warn_of("dropped", counts.duplicate_lone_points, "duplicate point", "duplicate points");
    }

    bool is_flat(int a, int b, int c) const
    {
        const auto place = [&](int p) { return to_cgal(soup_.points[p]); };
        return CGAL::collinear(place(a), place(b), place(c));
    }

    // Drops faces without area, except those that close the surface (two faces on each edge). Those must be
    // removed by flips, or a slit would remain.
    void drop_stray_flat_faces()
    {
        std::vector<char> is_flat_face(soup_.faces.size(), 0);
        for (std::size_t f = 0; f < soup_.faces.size(); ++f)
            if (is_flat(soup_.faces[f][0], soup_.faces[f][1], soup_.faces[f][2])) is_flat_face[f] = 1;
        if (std::find(is_flat_face.begin(), is_flat_face.end(), 1) == is_flat_face.end()) return;

        std::vector<std::array<int, 2>> edges;
        for (const Face& face : soup_.faces)
            for (int k = 0; k < 3; ++k) edges.push_back(edge_of(face, k));
        std::sort(edges.begin(), edges.end());
        const auto face_count = [&](const std::array<int, 2>& edge) {
            const auto [first, last] = std::equal_range(edges.begin(), edges.end(), edge);
            return last - first;
        };
        std::size_t kept = 0;
        for (std::size_t f = 0; f < soup_.faces.size(); ++f) {
            bool is_stray = false;
            for (int k = 0; k < 3 && is_flat_face[f] != 0; ++k)
                is_stray = is_stray || face_count(edge_of(soup_.faces[f], k)) != 2;
            if (is_stray)
                ++flat_faces_;
            else
                soup_.faces[kept++] = soup_.faces[f];
        }
        soup_.faces.resize(kept);
    }

    void build_surface()
    {
        std::vector<Point3> points;
        for (const Vec3& p : soup_.points) points.push_back(to_cgal(p));
        std::vector<Polygon> polygons;
        for (const auto& [a, b, c] : soup_.faces)
            polygons.push_back(
                {static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
        std::vector<int> origin(points.size());
        for (std::size_t p = 0; p < origin.size(); ++p) origin[p] = static_cast<int>(p);
        PMP::orient_polygon_soup(points, polygons, CGAL::parameters::visitor(CopyListener(&origin)));

        const auto copies = points.size() - soup_.points.size();
        PMP::polygon_soup_to_polygon_mesh(points, polygons, surface_);
        origin_ = surface_.add_property_map<SurfaceMesh::Vertex_index, int>("v:origin", -1).first;
        for (const SurfaceMesh::Vertex_index v : surface_.vertices())
            origin_[v] = origin[static_cast<std::size_t>(v)];
        // Copies whose borders can be stitched again are no defect and are not reported.
        if (copies > 0) PMP::stitch_borders(surface_);
        surface_.collect_garbage();
    }

    // The flips that remove a sliver may leave another one; drop what remains in the end.
    void remove_flat_faces()
    {
        const auto is_flat_face = [&](SurfaceMesh::Face_index f) {
            return PMP::is_degenerate_triangle_face(f, surface_);
        };
        const auto faces = surface_.faces();
        const auto count = std::count_if(faces.begin(), faces.end(), is_flat_face);
        if (count == 0) return;
        flat_faces_ += static_cast<int>(count);
        PMP::remove_degenerate_faces(surface_);
        for (const SurfaceMesh::Face_index f : surface_.faces())
            if (is_flat_face(f)) CGAL::Euler::remove_face(surface_.halfedge(f), surface_);
        surface_.collect_garbage();
    }

    // Points that faces use come first, in their former order.
    void extract_surface()
    {
        std::vector<SurfaceMesh::Vertex_index> order;
        for (const SurfaceMesh::Vertex_index v : surface_.vertices())
            if (!surface_.is_isolated(v)) order.push_back(v);
        std::stable_sort(order.begin(), order.end(),
                         [&](SurfaceMesh::Vertex_index v, SurfaceMesh::Vertex_index w) {
                             return origin_[v] < origin_[w];
                         });
        std::vector<int> name(surface_.num_vertices(), -1);
        for (const SurfaceMesh::Vertex_index v : order) {
            name[static_cast<std::size_t>(v)] = static_cast<int>(mesh_.points.size());
            mesh_.points.push_back(to_eigen(surface_.point(v)));
            origins_.push_back(origin_[v]);
        }
        for (const SurfaceMesh::Face_index f : surface_.faces()) {
            Face face{};
            int k = 0;
            for (const SurfaceMesh::Vertex_index v : surface_.vertices_around_face(surface_.halfedge(f)))
                face[k++] = name[static_cast<std::size_t>(v)];
            mesh_.faces.push_back(face);
        }
        for (std::size_t p = 1; p < origins_.size(); ++p)
            if (origins_[p] >= 0 && origins_[p] == origins_[p - 1]) ++split_;
    }

    // Rotates a face's corners so that the lowest index is first.
    static Face rotated(Face face)
    {
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        return face;
    }

    // Number of faces that are reversed against the soup. For a sheet, whose two sides are equivalent, the
    // smaller of the reversed and the unchanged faces counts.
    int count_turned() const
    {
        std::vector<Face> before;
        for (const Face& face : soup_.faces) before.push_back(rotated(face));
        std::sort(before.begin(), before.end());
        const ObstacleTopology topology = make_topology(mesh_);
        std::vector<std::array<int, 2>> counts(topology.is_solid.size(), {0, 0});
        for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
            const auto& [a, b, c] = mesh_.faces[f];
            const Face turned = rotated({origins_[a], origins_[c], origins_[b]});
            ++counts[topology.component[f]][std::binary_search(before.begin(), before.end(), turned) ? 1 : 0];
        }
        int turned = 0;
        for (std::size_t c = 0; c < counts.size(); ++c)
            turned += topology.is_solid[c] != 0 ? counts[c][1] : std::min(counts[c][0], counts[c][1]);
        return turned;
    }

    void tell(const ShellReport& shells, const BorderSeams& seams)
    {
        warn_of("split", split_, "vertex where more than two faces meet at an edge, or faces at a point only",
                "vertices where more than two faces meet at an edge, or faces at a point only");
        if (seams.edges > 0)
            warnings_.push_back(fmt::format(
                "{} along another without being joined to it, the first near {}, up to {:.2g} m away: merge "
                "vertices by distance where it was made",
                counted(seams.edges, "border edge runs", "border edges run"), place(seams.place),
                seams.widest));
        if (const int turned = count_turned(); turned > 0)
            warnings_.push_back(fmt::format(
                "turned {} of {} faces round, to agree with their neighbours and "
                "to face outward (cavities: inward){}",
                turned, mesh_.faces.size(),
                shells.turned_shells > 0 ? "; a closed surface is solid, whichever way its faces look" : ""));
        if (shells.crossing_pairs > 0) {
            warnings_.push_back(
                fmt::format("{} the first near {}: sharp edges where they do are not found, and "
                            "cloth may snag there; {}",
                            counted(shells.crossing_pairs, "pair of faces crosses, overlaps or touches,",
                                    "pairs of faces cross, overlap or touch,"),
                            place(shells.crossing_place),
                            seams.edges > 0 ? "merging vertices by distance may mend this as well"
                                            : "unite its parts (a boolean union) where it was made"));
        }
        if (shells.cavities > 0)
            notes_.push_back(counted(shells.cavities, "closed shell lies inside another and bounds a cavity",
                                     "closed shells lie inside others and bound cavities"));
        if (shells.border_edges > 0)
            notes_.push_back(fmt::format("open: {}, two-sided",
                                         counted(shells.border_edges, "border edge", "border edges")));
    }

    static std::string place(const Vec3& p)
    {
        return fmt::format("[{:.6g}, {:.6g}, {:.6g}] (m, z up, before it is scaled and placed)", p.x(), p.y(),
                           p.z());
    }

    void tell_flat_faces() { warn_of("removed", flat_faces_, "face without area", "faces without area"); }

    // Wires and lone points share points with the faces that they touch.
    void attach_wires_and_points()
    {
        std::vector<int> name(soup_.points.size(), -1);
        for (std::size_t p = origins_.size(); p-- > 0;)
            if (origins_[p] >= 0) name[origins_[p]] = static_cast<int>(p);
        const auto name_of = [&](int p) {
            if (name[p] < 0) {
                name[p] = static_cast<int>(mesh_.points.size());
                mesh_.points.push_back(soup_.points[p]);
                origins_.push_back(p);
            }
            return name[p];
        };
        for (const auto& [a, b] : soup_.segments) {
            const int first = name_of(a);
            mesh_.segments.push_back({first, name_of(b)});
        }
        for (const int p : soup_.lone_points) mesh_.lone_points.push_back(name_of(p));
    }

    ObstacleMesh soup_;
    SurfaceMesh surface_;
    SurfaceMesh::Property_map<SurfaceMesh::Vertex_index, int> origin_;  // index in the soup
    ObstacleMesh mesh_;
    std::vector<int> origins_;  // indices in the welded soup of the points; -1 for a new point
    int flat_faces_ = 0;
    int split_ = 0;
    std::vector<std::string> warnings_;
    std::vector<std::string> notes_;
};

}  // namespace

RepairedSoup repair_soup(ObstacleMesh soup)
{
    return SoupRepairer(std::move(soup)).repair();
}

}  // namespace arris
