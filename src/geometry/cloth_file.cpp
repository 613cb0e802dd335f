// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "geometry/cgal.h"
#include "geometry/chart_overlap.h"
#include "geometry/input_error.h"
#include "geometry/material_box.h"
#include "geometry/mesh_topology.h"
#include "geometry/obj_outline.h"

namespace arris {
namespace {

// Cloth farther out or larger than this is in the wrong unit.
constexpr double kLargestCoordinate = 1e6;  // m

// assimp keeps single precision, 6e-8 of a coordinate: with a farther origin the cloth's shape suffers.
constexpr double kFarOrigin = 1e4;  // distance from the origin over size

// A mesh is flat within this share of its size: single precision, with some room.
constexpr double kFlat = 1e-6;

// Takes assimp's warnings and errors for as long as it lives.
class LogCapture : public Assimp::LogStream {
  public:
    LogCapture()
    {
        Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(this, kSeverity);
    }
    ~LogCapture() override
    {
        Assimp::DefaultLogger::get()->detachStream(this, kSeverity);
        Assimp::DefaultLogger::kill();
    }
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;

    void write(const char* message) override
    {
        std::string line = message;
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
        lines.push_back("assimp: " + line);
    }

    std::vector<std::string> lines;

  private:
    static constexpr unsigned kSeverity = Assimp::Logger::Err | Assimp::Logger::Warn;
};

// A corner of a face as the file has it.
struct FileVertex {
    aiVector3D position;
    aiVector3D uv;

    auto key() const { return std::tuple(position.x, position.y, position.z, uv.x, uv.y); }
    auto place() const { return std::tuple(position.x, position.y, position.z); }
};

struct FileMesh {
    std::vector<FileVertex> vertices;
    std::vector<Face> faces;
    bool has_uv = false;
};

class ClothReader {
  public:
    ClothReader(const std::string& path, double unit_in_metres, char up)
        : path_(path), unit_(unit_in_metres), to_z_up_(turn_up(up))
    {
        if (!std::isfinite(unit_) || !(unit_ > 0.0)) refuse(fmt::format("unit {} m must be positive", unit_));
    }

    ClothFile read()
    {
        require_regular_obj();
        const ObjOutline outline = read_obj_outline(path_);
        if (outline.face_count == 0) refuse("no faces");
        import();
        warn_about(outline);
        require_single_uvs();
        place_in_world();
        require_distinct_faces();
        if (file_.has_uv) {
            take_uvs();
        } else {
            flatten();
        }
        orient();
        require_manifold();
        require_no_overlap();
        return {mesh_, warnings_};
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const { throw InputError(path_ + ": " + why); }

    Mat3 turn_up(char up) const
    {
        Mat3 turn = Mat3::Identity();
        if (up == 'y') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
        if (up == 'x') turn << 0, 0, -1, 0, 1, 0, 1, 0, 0;
        if (up != 'x' && up != 'y' && up != 'z') refuse(fmt::format("up '{}' must be x, y or z", up));
        return turn;
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

    // The file's triangles, vertices welded where position and UVs agree to the last bit. assimp's own
    // welding would join what is within 1e-5, whatever the cloth's size.
    void import()
    {
        LogCapture log;
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(
            path_, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_ValidateDataStructure);
        if (scene == nullptr) refuse(std::string("cannot be imported: ") + importer.GetErrorString());
        warnings_ = log.lines;
        collect(*scene);
        if (file_.faces.empty()) refuse("no faces");
    }

    void collect(const aiScene& scene)
    {
        std::map<decltype(FileVertex().key()), int> index;
        int with_uv = 0;
        int without_uv = 0;
        for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
            const aiMesh& part = *scene.mMeshes[m];
            // Triangulated polygons carry a flag besides.
            if ((part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0u) continue;
            ++(part.HasTextureCoords(0) ? with_uv : without_uv);
            for (unsigned f = 0; f < part.mNumFaces; ++f) {
                Face face;
                for (unsigned k = 0; k < 3; ++k)
                    face[k] = weld(vertex_of(part, part.mFaces[f].mIndices[k]), index);
                file_.faces.push_back(face);
            }
        }
        if (with_uv > 0 && without_uv > 0) refuse("some faces have UVs and some have none");
        file_.has_uv = with_uv > 0;
    }

    FileVertex vertex_of(const aiMesh& part, unsigned v) const
    {
        const FileVertex vertex{part.mVertices[v],
                                part.HasTextureCoords(0) ? part.mTextureCoords[0][v] : aiVector3D()};
        require_finite(vertex);  // before it is a key: NaN has no order
        return vertex;
    }

    template <class Index>
    int weld(const FileVertex& vertex, Index& index)
    {
        const auto [found, is_new] = index.emplace(vertex.key(), static_cast<int>(file_.vertices.size()));
        if (is_new) file_.vertices.push_back(vertex);
        return found->second;
    }

    void warn_about(const ObjOutline& outline)
    {
        if (outline.unused_vertex_count > 0)
            warnings_.push_back(fmt::format("{}: {} of {} vertices belong to no face and were dropped", path_,
                                            outline.unused_vertex_count, outline.vertex_count));
        if (outline.line_and_point_count > 0)
            warnings_.push_back(fmt::format("{}: {} lines and points are no cloth and were dropped", path_,
                                            outline.line_and_point_count));
    }

    void require_finite(const FileVertex& vertex) const
    {
        const auto& [p, uv] = vertex;
        for (const double c : {p.x, p.y, p.z})
            if (!std::isfinite(c) || !(std::abs(c) * unit_ <= kLargestCoordinate))
                refuse(fmt::format("vertex ({}, {}, {}) must be finite and within {:g} m of the origin", p.x,
                                   p.y, p.z, kLargestCoordinate));
        for (const double c : {uv.x, uv.y})
            if (!std::isfinite(c) || !(std::abs(c) <= kLargestCoordinate))
                refuse(fmt::format("UV ({}, {}) must be finite and within {:g} m", uv.x, uv.y,
                                   kLargestCoordinate));
    }

    // A place with two UVs is a seam: the cloth would come apart there.
    void require_single_uvs() const
    {
        std::vector<int> order(file_.vertices.size());
        for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<int>(v);
        const auto place = [&](int v) { return file_.vertices[v].place(); };
        std::sort(order.begin(), order.end(), [&](int v, int w) { return place(v) < place(w); });
        const auto twin = std::adjacent_find(order.begin(), order.end(),
                                             [&](int v, int w) { return place(v) == place(w); });
        if (twin == order.end()) return;
        const FileVertex& a = file_.vertices[*twin];
        const FileVertex& b = file_.vertices[*(twin + 1)];
        refuse(fmt::format("vertex ({}, {}, {}) has two UVs, ({}, {}) and ({}, {}): UV seams are not allowed",
                           a.position.x, a.position.y, a.position.z, a.uv.x, a.uv.y, b.uv.x, b.uv.y));
    }

    void place_in_world()
    {
        mesh_.faces = file_.faces;
        double farthest = 0.0;
        for (const FileVertex& vertex : file_.vertices) {
            const Vec3 p(vertex.position.x, vertex.position.y, vertex.position.z);
            mesh_.world.push_back(to_z_up_ * (unit_ * p));
            farthest = std::max(farthest, mesh_.world.back().cwiseAbs().maxCoeff());
        }
        if (farthest > kFarOrigin * world_size())
            warnings_.push_back(
                fmt::format("{}: lies {:.3g} m from the origin but is only {:.3g} m large: single "
                            "precision leaves it {:.1g} m of detail",
                            path_, farthest, world_size(), 6e-8 * farthest));
    }

    double world_size() const
    {
        Vec3 low = mesh_.world.front();
        Vec3 high = low;
        for (const Vec3& x : mesh_.world) {
            low = low.cwiseMin(x);
            high = high.cwiseMax(x);
        }
        return (high - low).maxCoeff();
    }

    std::string describe(int face) const
    {
        const Vec3& a = mesh_.world[mesh_.faces[face][0]];
        return fmt::format("triangle {} (at {:.6g}, {:.6g}, {:.6g} m)", face, a.x(), a.y(), a.z());
    }

    // No face without area in the world, and none twice, in whichever direction.
    void require_distinct_faces() const
    {
        std::map<Face, int> seen;
        for (int f = 0; f < mesh_.face_count(); ++f) {
            const auto& [a, b, c] = mesh_.faces[f];
            if (a == b || b == c || c == a ||
                CGAL::collinear(to_cgal(mesh_.world[a]), to_cgal(mesh_.world[b]), to_cgal(mesh_.world[c])))
                refuse(describe(f) + " has no area");
            Face key = mesh_.faces[f];
            std::sort(key.begin(), key.end());
            const auto [first, is_new] = seen.emplace(key, f);
            if (!is_new)
                refuse(fmt::format("{} is there twice, first as triangle {}", describe(f), first->second));
        }
    }

    void take_uvs()
    {
        for (const FileVertex& vertex : file_.vertices) mesh_.material.emplace_back(vertex.uv.x, vertex.uv.y);
    }

    // Twice the area vector of the largest face.
    Vec3 largest_area() const
    {
        Vec3 largest = Vec3::Zero();
        for (const auto& [a, b, c] : mesh_.faces) {
            const Vec3 area = (mesh_.world[b] - mesh_.world[a]).cross(mesh_.world[c] - mesh_.world[a]);
            if (area.norm() > largest.norm()) largest = area;
        }
        return largest;
    }

    // Without UVs: the mesh's own plane, seen from the side its faces turn counter-clockwise on.
    void flatten()
    {
        const Vec3& origin = mesh_.world.front();
        const Vec3 normal = largest_area().stableNormalized();
        for (const Vec3& x : mesh_.world)
            if (!(std::abs((x - origin).dot(normal)) <= kFlat * world_size()))
                refuse(fmt::format(
                    "curved (by {:.3g} m at ({:.6g}, {:.6g}, {:.6g}) m) and without UVs: give UVs in "
                    "metres, or a flat mesh",
                    std::abs((x - origin).dot(normal)), x.x(), x.y(), x.z()));
        // u along x where the plane allows, so that a horizontal mesh has its own x and y as material
        // coordinates.
        const Vec3 guide = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
        const Vec3 along_u = (guide - guide.dot(normal) * normal).normalized();
        const Vec3 along_v = normal.cross(along_u);
        for (const Vec3& x : mesh_.world) mesh_.material.emplace_back(x.dot(along_u), x.dot(along_v));
    }

    int orientation_of(int face) const
    {
        const auto& [a, b, c] = mesh_.faces[face];
        return exact_orientation(mesh_.material[a], mesh_.material[b], mesh_.material[c]);
    }

    // Makes every face counter-clockwise in material space, where one mirror does.
    void orient()
    {
        int clockwise = 0;
        for (int f = 0; f < mesh_.face_count(); ++f) {
            const int turn = orientation_of(f);
            if (turn == 0) refuse(describe(f) + " has no area in material space (its UVs lie on a line)");
            if (turn < 0) ++clockwise;
        }
        if (clockwise == 0) return;
        if (clockwise < mesh_.face_count())
            refuse(fmt::format(
                "{} of {} triangles are clockwise in material space: the chart is folded, or faces "
                "run in different directions",
                clockwise, mesh_.face_count()));
        mirror();
    }

    void mirror()
    {
        double least = mesh_.material.front().x();
        double most = least;
        for (const Vec2& X : mesh_.material) {
            least = std::min(least, X.x());
            most = std::max(most, X.x());
        }
        for (Vec2& X : mesh_.material) X.x() = least + most - X.x();
        warnings_.push_back(path_ +
                            ": its UVs are mirrored; u was turned round (u became u_min + u_max - u)");
    }

    void require_manifold() const
    {
        if (const std::string wrong = validate(mesh_); !wrong.empty())
            refuse(wrong + " (triangles and welded vertices counted from 0)");
    }

    void require_no_overlap() const
    {
        if (const auto pair = find_overlap(mesh_.material, mesh_.faces))
            refuse(fmt::format("{} and {} overlap in material space", describe((*pair)[0]),
                               describe((*pair)[1])));
    }

    std::string path_;
    double unit_;
    Mat3 to_z_up_;
    FileMesh file_;
    ClothMesh mesh_;
    std::vector<std::string> warnings_;
};

}  // namespace

ClothFile read_cloth_file(const std::string& path, double unit_in_metres, char up)
{
    return ClothReader(path, unit_in_metres, up).read();
}

}  // namespace arris
