// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "geometry/cgal.h"
#include "geometry/cloth/euler_characteristic.h"
#include "geometry/cloth/mesh_pieces.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sewing.h"
#include "geometry/cloth/sub_mesh.h"
#include "geometry/cloth_input/chart_overlap.h"
#include "geometry/cloth_input/chart_turns.h"
#include "geometry/cloth_input/cloth_obj.h"
#include "geometry/cloth_input/face_faults.h"
#include "geometry/cloth_input/flat_charts.h"
#include "geometry/cloth_input/seam_triangles.h"
#include "geometry/cloth_input/stitches.h"
#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/mesh_text.h"
#include "geometry/polygon.h"
#include "geometry/up_axis.h"

namespace arris {
namespace {

constexpr const char* kTubeAdvice = "; a tube needs UVs that part it along a seam";

struct FileVertex {
    Vec3 position;
    Vec2 uv;

    auto place() const { return std::tuple(position.x(), position.y(), position.z()); }
    auto key() const { return std::tuple_cat(place(), std::tuple(uv.x(), uv.y())); }
};

struct FileMesh {
    std::vector<FileVertex> vertices;
    std::vector<int> numbers;  // number, from 1, of each vertex's (first) `v` statement
    std::vector<Face> faces;
    std::vector<Face> corners;  // number of each face's corners, likewise
    std::vector<int> lines;     // line of each face in the file
    bool has_uv = false;
};

class ClothReader {
  public:
    ClothReader(const std::string& path, double unit_in_metres, char up, double uv_scale)
        : path_(path), unit_(unit_in_metres), uv_scale_(uv_scale), to_z_up_(turn_up(up))
    {
        if (!std::isfinite(unit_) || !(unit_ > 0.0)) refuse(fmt::format("unit {} m must be positive", unit_));
    }

    ClothFile read()
    {
        require_regular_obj();
        statements_ = read_cloth_obj(path_);
        for (auto& uv : statements_.uvs) uv.place *= uv_scale_;
        file_.has_uv = statements_.corners.front().uv >= 0;
        for (const ObjCorner& corner : statements_.corners) require_finite(corner);
        collect();
        warn_about_dropped();
        place_in_world();
        require_areas();
        for (const std::string& wrong : {find_doubled_face(placed_), find_branching_edge(placed_)})
            if (!wrong.empty()) refuse(wrong);
        file_.has_uv ? take_uvs() : flatten();
        orient();
        require_no_overlap();
        sew_places();
        require_manifold();
        const std::vector<int> vertices = find_vertices();
        std::vector<std::array<int, 2>> ties = find_ties(vertices);
        return {mesh_, warnings_, file_.has_uv, vertices, std::move(ties)};
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const { throw InputError(path_ + ": " + why); }

    Mat3 turn_up(char up) const
    {
        if (up != 'x' && up != 'y' && up != 'z') refuse(fmt::format("up '{}' must be x, y or z", up));
        return turn_to_z(up);
    }

    void require_regular_obj() const
    {
        std::error_code error;
        if (!std::filesystem::exists(path_, error)) refuse("no such file");
        if (!std::filesystem::is_regular_file(path_, error)) refuse("not a regular file");
        std::string extension = std::filesystem::path(path_).extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension != ".obj") refuse(fmt::format("cloth is read from .obj files, not '{}'", extension));
    }

    // Cuts the faces into triangles, and joins vertices of equal place and UV.
    void collect()
    {
        find_seam_places();
        std::map<decltype(FileVertex().key()), int> index;
        std::size_t first = 0;
        for (const int count : statements_.corner_counts) {
            std::vector<int> vertices;
            for (int k = 0; k < count; ++k) vertices.push_back(weld(statements_.corners[first + k], index));
            const int line = statements_.corners[first].line;
            const auto number = [&](int k) { return statements_.corners[first + k].vertex + 1; };
            for (const auto& [a, b, c] : cut(vertices, line)) {
                file_.faces.push_back({vertices[a], vertices[b], vertices[c]});
                file_.corners.push_back({number(a), number(b), number(c)});
                file_.lines.push_back(line);
            }
            first += static_cast<std::size_t>(count);
        }
        for (Face& face : file_.faces)
            for (int& v : face) v = standing_for(v);
        drop_unused();
    }

    // The vertex that stands for `v`: of vertices that a polygon joined, the first.
    int standing_for(int v) const
    {
        for (auto found = joined_.find(v); found != joined_.end(); found = joined_.find(v)) v = found->second;
        return v;
    }

    // Corners that a polygon joined, and tips of spurs, belong to no triangle.
    void drop_unused()
    {
        std::vector<int> name(file_.vertices.size(), -1);
        for (const Face& face : file_.faces)
            for (const int v : face) name[v] = 0;
        int kept = 0;
        for (std::size_t v = 0; v < name.size(); ++v) {
            if (name[v] < 0) continue;
            file_.vertices[kept] = file_.vertices[v];
            file_.numbers[kept] = file_.numbers[v];
            name[v] = kept++;
        }
        if (const int dropped = static_cast<int>(name.size()) - kept; dropped > 0)
            warnings_.push_back(
                fmt::format("{}: {} dropped (within rounding of another in a polygon, or the tip of a spur)",
                            path_, counted(dropped, "vertex was", "vertices were")));
        file_.vertices.resize(kept);
        file_.numbers.resize(kept);
        for (Face& face : file_.faces)
            for (int& v : face) v = name[v];
    }

    // Triangles of a face's corners, cut in the material if the file has UVs, else in the face's own plane.
    std::vector<Face> cut(const std::vector<int>& vertices, int line)
    {
        if (vertices.size() == 3) return {{0, 1, 2}};
        std::vector<Vec2> uvs;
        std::vector<Vec3> places;
        for (const int v : vertices) {
            uvs.push_back(file_.vertices[v].uv);
            places.push_back(file_.vertices[v].position);
        }
        const PolygonTriangles triangles = file_.has_uv ? triangulate_polygon(uvs, NearTouch::Join)
                                                        : triangulate_polygon(places, NearTouch::Join);
        const char* where = file_.has_uv ? " in material space" : "";
        if (triangles.defect == PolygonDefect::CrossesItself)
            refuse_line(line,
                        fmt::format("its polygon crosses itself{}; allowed: corners in their order around it",
                                    where));
        if (triangles.defect == PolygonDefect::NoArea)
            refuse_line(line, fmt::format("its polygon has no area{}", where));
        for (const auto& [corner, other] : triangles.joined) {
            // Links lead to smaller numbers, so they end.
            const int first = standing_for(vertices[corner]), second = standing_for(vertices[other]);
            const int low = std::min(first, second), high = std::max(first, second);
            if (low != high) joined_[high] = low;
        }
        if (vertices.size() != 4) return triangles.faces;
        SeamCorners corners;
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] = {uvs[k], seam_places_.contains(file_.vertices[vertices[k]].place())};
        return cut_off_seams(corners, triangles.faces);
    }

    // Places with several UVs.
    void find_seam_places()
    {
        std::map<decltype(FileVertex().place()), Vec2> uvs;
        for (const ObjCorner& corner : statements_.corners) {
            const FileVertex vertex = vertex_at(corner);
            if (uvs.emplace(vertex.place(), vertex.uv).first->second != vertex.uv)
                seam_places_.insert(vertex.place());
        }
    }

    FileVertex vertex_at(const ObjCorner& corner) const
    {
        return {statements_.vertices[corner.vertex].place,
                corner.uv < 0 ? Vec2(Vec2::Zero()) : statements_.uvs[corner.uv].place};
    }

    template <class Index>
    int weld(const ObjCorner& corner, Index& index)
    {
        const FileVertex vertex = vertex_at(corner);
        const auto [found, is_new] = index.emplace(vertex.key(), static_cast<int>(file_.vertices.size()));
        if (is_new) {
            file_.vertices.push_back(vertex);
            file_.numbers.push_back(corner.vertex + 1);
        }
        return found->second;
    }

    void warn_about_dropped()
    {
        std::vector<char> is_used(statements_.vertices.size(), 0);
        for (const ObjCorner& corner : statements_.corners) is_used[corner.vertex] = 1;
        if (const auto unused = std::count(is_used.begin(), is_used.end(), 0); unused > 0)
            warnings_.push_back(fmt::format("{}: {} of {} vertices belong to no face and were dropped", path_,
                                            unused, is_used.size()));
        for (const std::string& warning : statements_.warnings) warnings_.push_back(path_ + ": " + warning);
        if (statements_.line_and_point_count > 0)
            warnings_.push_back(fmt::format("{}: {} lines and points are no cloth and were dropped", path_,
                                            statements_.line_and_point_count));
    }

    [[noreturn]] void refuse_line(int line, const std::string& why) const
    {
        throw InputError(fmt::format("{}, line {}: {}", path_, line, why));
    }

    void require_finite(const ObjCorner& corner) const
    {
        const auto& [p, line] = statements_.vertices[corner.vertex];
        if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() * unit_ <= kLargestCoordinate))
            refuse_line(
                line, fmt::format("vertex ({}, {}, {}) must be finite and within {:g} m of the origin", p.x(),
                                  p.y(), p.z(), kLargestCoordinate));
        if (corner.uv < 0) return;
        const auto& [uv, uv_line] = statements_.uvs[corner.uv];
        if (!uv.allFinite() || !(uv.cwiseAbs().maxCoeff() <= kLargestCoordinate))
            refuse_line(uv_line, fmt::format("UV ({}, {}) must be finite and within {:g} m", uv.x(), uv.y(),
                                             kLargestCoordinate));
    }

    void place_in_world()
    {
        mesh_.faces = file_.faces;
        for (const FileVertex& vertex : file_.vertices)
            mesh_.world.push_back(to_z_up_ * (unit_ * vertex.position));
        placed_ = {{}, {}, file_.faces, file_.corners, file_.lines};
        std::map<decltype(FileVertex().place()), int> index;
        for (std::size_t v = 0; v < file_.vertices.size(); ++v) {
            const auto [found, is_new] =
                index.emplace(file_.vertices[v].place(), static_cast<int>(placed_.places.size()));
            place_.push_back(found->second);
            if (!is_new) continue;
            placed_.places.push_back(mesh_.world[v]);
            placed_.numbers.push_back(file_.numbers[v]);
        }
        for (Face& face : placed_.faces)
            for (int& v : face) v = place_[v];
    }

    void require_areas() const
    {
        for (int f = 0; f < mesh_.face_count(); ++f) {
            const auto& [a, b, c] = placed_.faces[f];
            const std::vector<Vec3>& x = placed_.places;
            if (a == b || b == c || c == a || CGAL::collinear(to_cgal(x[a]), to_cgal(x[b]), to_cgal(x[c])))
                refuse(placed_.describe(f) + " has no area");
        }
    }

    void take_uvs()
    {
        for (const FileVertex& vertex : file_.vertices) mesh_.material.push_back(vertex.uv);
    }

    // Without UVs: each flat piece is its own chart.
    void flatten()
    {
        FlatCharts charts = lay_flat(mesh_.world, mesh_.faces);
        mesh_.material = std::move(charts.material);
        if (charts.curved_at >= 0) refuse_curved(charts);
        if (charts.pieces.empty()) return;
        constexpr std::size_t kMostTold = 8;
        std::string where;
        for (std::size_t k = 0; k < std::min(charts.pieces.size(), kMostTold); ++k)
            where +=
                fmt::format("{}u = {:.6g} to {:.6g} (line {})", k > 0 ? ", " : "", charts.pieces[k].least_u,
                            charts.pieces[k].greatest_u, file_.lines[charts.pieces[k].first_face]);
        warnings_.push_back(
            fmt::format("{}: its {} pieces are flat and have no UVs; they are laid side by side "
                        "in the material, at {}{}",
                        path_, charts.pieces.size(), where, charts.pieces.size() > kMostTold ? ", ..." : ""));
    }

    [[noreturn]] void refuse_curved(const FlatCharts& charts) const
    {
        const Vec3& x = mesh_.world[charts.curved_at];
        const std::vector<int> piece = label_pieces(mesh_.vertex_count(), mesh_.faces);
        std::vector<int> faces;
        for (int f = 0; f < mesh_.face_count(); ++f)
            if (piece[mesh_.faces[f][0]] == piece[charts.curved_at]) faces.push_back(f);
        refuse(
            fmt::format("curved (by {:.3g} m at ({:.6g}, {:.6g}, {:.6g}) m) and without UVs; allowed: UVs in "
                        "metres, or flat pieces{}",
                        charts.off_plane, x.x(), x.y(), x.z(),
                        euler_characteristic(extract_faces(mesh_, faces).mesh) > 0 ? "" : kTubeAdvice));
    }

    void orient()
    {
        const ChartTurns turns = turn_charts(placed_, mesh_);
        if (!turns.wrong.empty()) refuse(turns.wrong);
        if (turns.mirrored == 0) return;
        const std::string some = fmt::format("the UVs of {} of its {} charts", turns.mirrored, turns.charts);
        warnings_.push_back(
            fmt::format("{}: {} are mirrored; u was turned round (u became u_min + u_max - u): "
                        "pins, pulls, probes and exported UVs follow",
                        path_, turns.mirrored == turns.charts ? "its UVs" : some));
    }

    // A place with several UVs is on a seam.
    void sew_places()
    {
        mesh_ = sew(std::move(mesh_), place_);
        if (mesh_.has_seams()) file_.numbers = placed_.numbers;
    }

    /// Vertex of the mesh at the place of each `v` of the file.
    std::vector<int> find_vertices() const
    {
        std::map<decltype(FileVertex().place()), int> at;
        for (std::size_t p = 0; p < file_.vertices.size(); ++p)
            at.emplace(file_.vertices[p].place(), mesh_.has_seams() ? place_[p] : static_cast<int>(p));
        std::vector<int> vertices;
        for (const auto& [place, line] : statements_.vertices) {
            const auto found = at.find(FileVertex{place, Vec2::Zero()}.place());
            vertices.push_back(found == at.end() ? -1 : found->second);
        }
        return vertices;
    }

    std::vector<std::array<int, 2>> find_ties(const std::vector<int>& vertices)
    {
        try {
            return divide_at_stitches(number_stitches(statements_.stitches, vertices), mesh_);
        } catch (const InputError& error) {
            refuse(error.what());
        }
    }

    void require_manifold() const
    {
        const ElementNumbers numbers = {file_.numbers, file_.lines};
        if (const std::string wrong = validate(mesh_, numbers); !wrong.empty())
            refuse(wrong + " (vertices as the file numbers them, counted from 1, and faces by their line)");
    }

    void require_no_overlap() const
    {
        if (const auto pair = find_overlap(mesh_.material, mesh_.faces))
            refuse(fmt::format("{} and {} overlap in material space; allowed: {}",
                               placed_.describe((*pair)[0]), placed_.describe((*pair)[1]),
                               file_.has_uv ? "UVs at which no two faces overlap"
                                            : "faces beside each other; layers that coincide must start "
                                              "apart, by the cloth's thickness or more"));
    }

    std::string path_;
    double unit_, uv_scale_;
    Mat3 to_z_up_;
    ObjFile statements_;
    FileMesh file_;
    std::set<decltype(FileVertex().place())> seam_places_;
    std::map<int, int> joined_;  // a vertex, and the earlier one that stands for it
    ClothMesh mesh_;
    std::vector<int> place_;  // of each vertex of the file: index of its place
    PlacedFaces placed_;      // the mesh with one vertex at each place
    std::vector<std::string> warnings_;
};

}  // namespace

ClothFile read_cloth_file(const std::string& path, double unit_in_metres, char up, double uv_scale)
{
    return ClothReader(path, unit_in_metres, up, uv_scale).read();
}

}  // namespace arris
