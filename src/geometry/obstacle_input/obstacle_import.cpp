// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_import.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/dae_check.h"
#include "geometry/obstacle_input/formats/format_reader.h"
#include "geometry/obstacle_input/formats/import_log.h"
#include "geometry/obstacle_input/formats/mesh_file_check.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/formats/mesh_folder_io.h"
#include "geometry/obstacle_input/formats/plain_mesh.h"
#include "geometry/obstacle_input/formats/three_mf_file.h"
#include "geometry/obstacle_input/gltf/gltf_file.h"
#include "geometry/obstacle_input/repair/face_cutter.h"
#include "geometry/obstacle_input/repair/soup_repair.h"
#include "geometry/obstacle_input/repair/soup_weld.h"
#include "geometry/obstacle_input/repair/vertex_origins.h"
#include "geometry/up_axis.h"

// The importer gets the reader of one format, no post-processing, and a file system of one folder. Its own
// checks, its joining of vertices (within 1e-5, whatever the unit), its triangulation (which depends on a
// polygon's starting corner) and its flattening of the node tree (in single precision) are not used. So
// positions leave the importer as the file has them, and are double from there. OBJ, STL, PLY and 3MF have
// readers of their own, whose values are double from the beginning.
namespace arris {
namespace {

// Single precision moves points by 6e-8 of their distance from the origin. Beyond this ratio of distance to
// mesh size, that is more than 6e-4 of the mesh's size.
constexpr double kFarFromOrigin = 1e4;

using Placement4 = Eigen::Matrix4d;

// The shortest decimal number that rounds to `value` in single precision: 0.01f gives 0.01.
double decimal(float value)
{
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

Placement4 to_eigen(const aiMatrix4x4& m)
{
    Placement4 placement;
    placement << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3,
        m.d4;
    return placement;
}

std::string extension_of(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    extension.erase(0, 1);
    return extension;
}

class ObstacleImporter {
  public:
    ObstacleImporter(std::string path, std::optional<double> unit, std::optional<char> up)
        : path_(std::move(path)), extension_(extension_of(path_)), unit_(unit), up_(up)
    {
    }

    ObstacleFile import()
    {
        const std::vector<std::string>& known = mesh_extensions();
        if (std::find(known.begin(), known.end(), extension_) == known.end())
            throw InputError(fmt::format("unknown format '.{}'; allowed: .{}", one_line(extension_),
                                         fmt::join(known, ", .")));
        std::string bytes = without_marks(extension_, read_regular_file(path_, kLargestFile));
        check_mesh_bytes(extension_, bytes);
        if (extension_ == "dae") check_dae(bytes);
        if (is_plain_format(extension_))
            take_plain(bytes);
        else if (extension_ == "3mf")
            take_package(bytes);
        else if (extension_ == "gltf" || extension_ == "glb")
            take_gltf(std::move(bytes));
        else
            load("mesh." + extension_, bytes);
        place();
        for (std::string& warning : cutter_.warnings(soup_.points, unit_.value_or(declared_unit_)))
            warnings_.push_back(std::move(warning));
        warn_where_far();
        // Readers of all other formats give each face its own points, even where the file shares them.
        std::vector<int> joined;
        if (extension_ != "stl" && extension_ != "ply") joined = join_equal_points(soup_).names;
        RepairedSoup repaired = repair_soup(std::move(soup_));
        VertexOrigins origins;
        const bool is_gltf = extension_ == "gltf" || extension_ == "glb";
        if (extension_ == "obj" || is_gltf)
            repaired.welded = compose_names(std::move(joined), repaired.welded);
        if (extension_ == "obj" || extension_ == "ply" || is_gltf)
            origins = find_vertex_origins(repaired.welded, repaired.origins, repaired.tolerance);
        warnings_.insert(warnings_.end(), repaired.warnings.begin(), repaired.warnings.end());
        return {std::move(repaired.mesh), std::move(origins), std::move(warnings_),
                std::move(repaired.notes)};
    }

  private:
    // Formats whose numbers the import library rounds, and whose less common spellings it misreads
    void take_plain(const std::string& bytes)
    {
        PlainMesh mesh = read_plain_mesh(extension_, bytes);
        const std::size_t total = mesh.corner_counts.size() + mesh.segments.size() + mesh.lone_points.size();
        if (total > kMostFaces || mesh.points.size() > 3 * kMostFaces)
            throw InputError(fmt::format("more than {} faces", kMostFaces));
        require_near(mesh);
        std::size_t first = 0;
        for (const int count : mesh.corner_counts) {
            const int* face = &mesh.corners[first];
            std::vector<Vec3> corners;
            for (int k = 0; k < count; ++k) corners.push_back(mesh.points[face[k]]);
            for (const auto& [a, b, c] : cutter_.cut(corners, face[0]))
                soup_.faces.push_back({face[a], face[b], face[c]});
            first += static_cast<std::size_t>(count);
        }
        soup_.points = std::move(mesh.points);
        soup_.segments = std::move(mesh.segments);
        soup_.lone_points = std::move(mesh.lone_points);
        warnings_ = std::move(mesh.warnings);
        is_single_ = mesh.is_single;
    }

    // repair_soup checks the same of all formats, and knows no lines.
    void require_near(const PlainMesh& mesh) const
    {
        const double unit = unit_.value_or(declared_unit_);
        const auto require = [&](int point) {
            const Vec3& p = mesh.points[point];
            if (mesh.lines.empty() || unit * p.cwiseAbs().maxCoeff() <= kLargestCoordinate) return;
            throw InputError(fmt::format("line {}: vertex ({}, {}, {}) must be within {:g} m of the origin",
                                         mesh.lines[point], p.x(), p.y(), p.z(), kLargestCoordinate));
        };
        for (const int point : mesh.corners) require(point);
        for (const auto& [a, b] : mesh.segments) {
            require(a);
            require(b);
        }
        for (const int point : mesh.lone_points) require(point);
    }

    // The import library reads one part of a 3MF package, and drops what refers to others.
    void take_package(const std::string& bytes)
    {
        ThreeMfFile file = read_three_mf(bytes, kMostFaces);
        soup_ = std::move(file.soup);
        is_single_ = false;
        declared_unit_ = file.metres_per_unit;
        warnings_.insert(warnings_.end(), file.warnings.begin(), file.warnings.end());
    }

    void take_gltf(std::string bytes)
    {
        GltfFile file = prepare_gltf(extension_ == "glb", std::move(bytes), folder());
        warnings_.insert(warnings_.end(), file.warnings.begin(), file.warnings.end());
        load(file.is_binary ? "mesh.glb" : "mesh.gltf", file.bytes);
        if (file.vertices.empty()) return;
        if (file.vertices.size() != soup_.points.size())
            throw InputError(
                fmt::format("the import library finds {} vertices, but its skinned or morphed meshes "
                            "have {}",
                            soup_.points.size(), file.vertices.size()));
        soup_.points = std::move(file.vertices);
    }

    std::filesystem::path folder() const
    {
        const std::filesystem::path parent = std::filesystem::path(path_).parent_path();
        return parent.empty() ? "." : parent;
    }

    void load(const std::string& name, const std::string& bytes)
    {
        ImportLog log;
        Assimp::Importer importer;
        keep_reader_of(extension_, importer);
        auto owned_files = std::make_unique<MeshFolderIo>(name, bytes, folder());
        const MeshFolderIo& files = *owned_files;
        importer.SetIOHandler(owned_files.release());  // the importer takes ownership
        // Stop assimp from adding a mesh of the nodes to a scene without a mesh.
        importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
        const aiScene* scene = importer.ReadFile(name, 0);
        if (scene == nullptr || scene->mRootNode == nullptr)
            refuse_import(importer.GetErrorString(), files.refusals());
        log.require_no_damage();
        read_declared(*scene);
        for (unsigned m = 0; m < scene->mNumMeshes; ++m) check(*scene->mMeshes[m], m, *scene);
        collect(*scene);
        log.append_to(warnings_);
        for (const std::string& refusal : files.refusals()) warnings_.push_back(refusal);
    }

    [[noreturn]] static void refuse_import(const char* error, const std::vector<std::string>& refusals)
    {
        if (std::string_view(error).find("bad_alloc") != std::string_view::npos) throw std::bad_alloc();
        std::string why = std::string("cannot be imported: ") + error;
        for (const std::string& refusal : refusals) why += "; " + refusal;
        throw InputError(one_line(why));
    }

    // Declarations of the file

    void read_declared(const aiScene& scene)
    {
        if (extension_ == "gltf" || extension_ == "glb") declared_up_ = 'y';
        if (extension_ == "dae") read_root(scene.mRootNode->mTransformation);
        if (extension_ == "fbx") read_fbx_metadata(scene);
    }

    // The COLLADA reader stores unit and up axis in its root node, which has no other placement.
    void read_root(const aiMatrix4x4& root)
    {
        const Placement4 m = to_eigen(root);
        const double unit = m.col(0).head<3>().norm();
        if (!(unit > 0.0 && std::isfinite(unit))) throw InputError(fmt::format("its unit is {} m", unit));
        declared_unit_ = decimal(static_cast<float>(unit));
        // The reader rotates the up axis to y.
        int axis = 0;
        m.row(1).head<3>().cwiseAbs().maxCoeff(&axis);
        declared_up_ = "xyz"[axis];
    }

    void read_fbx_metadata(const aiScene& scene)
    {
        float factor = 1.0f;
        std::int32_t axis = 1;
        std::int32_t sign = 1;
        if (scene.mMetaData != nullptr) {
            scene.mMetaData->Get("UnitScaleFactor", factor);
            scene.mMetaData->Get("UpAxis", axis);
            scene.mMetaData->Get("UpAxisSign", sign);
        }
        if (!unit_ && !(factor > 0.0f && std::isfinite(factor)))
            throw InputError(fmt::format("its UnitScaleFactor is {}: state the units", factor));
        if (!up_ && (axis < 0 || axis > 2 || sign != 1))
            throw InputError(fmt::format("its UpAxis is {} with sign {}: state the up axis", axis, sign));
        declared_unit_ = decimal(factor) * 0.01;  // centimetres
        if (axis >= 0 && axis <= 2) declared_up_ = "xyz"[axis];
    }

    // Checks that precede any use of the numbers

    static std::string name_of(unsigned mesh, const aiScene& scene)
    {
        return scene.mNumMeshes > 1 ? fmt::format("mesh {}, ", mesh + 1) : "";
    }

    static void check(const aiMesh& mesh, unsigned number, const aiScene& scene)
    {
        if (mesh.mVertices == nullptr && mesh.mNumFaces > 0)
            throw InputError(name_of(number, scene) + "it has faces, but no vertices");
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                const unsigned v = face.mIndices[k];
                if (v >= mesh.mNumVertices)
                    throw InputError(fmt::format("{}face {} names vertex {}, but there are {}",
                                                 name_of(number, scene), f + 1, v + 1ULL, mesh.mNumVertices));
                const aiVector3D& p = mesh.mVertices[v];
                if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                    throw InputError(fmt::format("{}vertex {} ({}, {}, {}) of face {} is not finite",
                                                 name_of(number, scene), v + 1, p.x, p.y, p.z, f + 1));
            }
        }
    }

    // The node tree

    void collect(const aiScene& scene)
    {
        struct Visit {
            const aiNode* node;
            Placement4 parent;
        };
        std::vector<Visit> visits = {{scene.mRootNode, Placement4::Identity()}};
        // Skip the root of COLLADA, which read_root interprets, and that of 3DS, which turns z to y.
        const bool skips_root = extension_ == "dae" || extension_ == "3ds";
        for (std::size_t visited = 0; !visits.empty(); ++visited) {
            if (visited == kMostNodes) throw InputError(fmt::format("more than {} nodes", kMostNodes));
            const Visit visit = visits.back();
            visits.pop_back();
            const bool is_skipped = skips_root && visit.node == scene.mRootNode;
            const Placement4 own =
                is_skipped ? Placement4::Identity() : to_eigen(visit.node->mTransformation);
            const Placement4 placement = visit.parent * own;
            for (unsigned m = 0; m < visit.node->mNumMeshes; ++m)
                take(*scene.mMeshes[visit.node->mMeshes[m]], placement);
            for (unsigned c = visit.node->mNumChildren; c-- > 0;)
                visits.push_back({visit.node->mChildren[c], placement});
        }
    }

    void take(const aiMesh& mesh, const Placement4& placement)
    {
        const int base = static_cast<int>(soup_.points.size());
        const std::size_t total = soup_.faces.size() + soup_.segments.size() + soup_.lone_points.size();
        if (total + mesh.mNumFaces > kMostFaces || base + std::size_t{mesh.mNumVertices} > 3 * kMostFaces)
            throw InputError(fmt::format("more than {} faces", kMostFaces));
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            soup_.points.push_back((placement * Eigen::Vector4d(p.x, p.y, p.z, 1.0)).head<3>());
        }
        // A mirroring placement reverses the orientation of faces.
        const double volume = placement.topLeftCorner<3, 3>().determinant();
        const bool is_mirrored = volume < 0.0;
        const double scale = std::cbrt(std::abs(volume));
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            const auto point = [&](unsigned k) { return base + static_cast<int>(face.mIndices[k]); };
            if (face.mNumIndices == 1) soup_.lone_points.push_back(point(0));
            if (face.mNumIndices == 2) soup_.segments.push_back({point(0), point(1)});
            for (const auto& [a, b, c] : cut(mesh, face, base, scale))
                soup_.faces.push_back({point(a), point(is_mirrored ? c : b), point(is_mirrored ? b : c)});
        }
    }

    // Triangles of corners. Cuts polygons where the file states them: a placement would round their corners.
    std::vector<Face> cut(const aiMesh& mesh, const aiFace& face, int base, double scale)
    {
        if (face.mNumIndices < 3) return {};
        std::vector<Vec3> corners;
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const aiVector3D& p = mesh.mVertices[face.mIndices[k]];
            corners.emplace_back(p.x, p.y, p.z);
        }
        return cutter_.cut(corners, base + static_cast<int>(face.mIndices[0]), scale);
    }

    // Conversion from the file's unit and axes to metres and +z up

    void place()
    {
        if (soup_.faces.empty() && soup_.segments.empty() && soup_.lone_points.empty())
            throw InputError("no faces, lines or points");
        const Mat3 turn = turn_to_z(up_.value_or(declared_up_));
        const double unit = unit_.value_or(declared_unit_);
        for (Vec3& p : soup_.points) p = turn * (unit * p);
    }

    void warn_where_far()
    {
        Vec3 low = Vec3::Constant(kLargestCoordinate);
        Vec3 high = -low;
        const auto extend = [&](int point) {
            low = low.cwiseMin(soup_.points[point]);
            high = high.cwiseMax(soup_.points[point]);
        };
        for (const Face& face : soup_.faces)
            for (const int p : face) extend(p);
        for (const std::array<int, 2>& segment : soup_.segments)
            for (const int p : segment) extend(p);
        for (const int p : soup_.lone_points) extend(p);
        const double offset = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
        const double size = (high - low).norm();
        if (is_single_ && offset > kFarFromOrigin * size && size > 0.0)
            warnings_.push_back(fmt::format(
                "it lies {:.3g} times its size from the origin: single precision moves its points by up to "
                "{:.2g} m; move it near the origin",
                offset / size, offset * 6e-8));
    }

    std::string path_;
    std::string extension_;
    std::optional<double> unit_;
    std::optional<char> up_;
    double declared_unit_ = 1.0;  // m
    char declared_up_ = 'z';
    ObstacleMesh soup_;
    bool is_single_ = true;  // coordinates come in single precision
    FaceCutter cutter_;
    std::vector<std::string> warnings_;
};

}  // namespace

ObstacleFile import_obstacle(const std::string& path, std::optional<double> metres_per_unit,
                             std::optional<char> up)
{
    return ObstacleImporter(path, metres_per_unit, up).import();
}

}  // namespace arris
