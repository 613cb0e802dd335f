// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/app/input_fuzz/input_kinds.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "app/files/binary_stream.h"
#include "app/files/frame.h"
#include "app/files/pose_file.h"
#include "app/run/checkpoint.h"
#include "app/run/simulation.h"
#include "app/scene/parts/assembly.h"
#include "app/scene/parts/obstacle_records.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/pattern/garment_code.h"
#include "app/scene/scene_load.h"
#include "app/text/version.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_file.h"
#include "geometry/cloth_input/pattern/pattern_cloth.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/obstacle/point_cache.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"
#include "geometry/obstacle_input/obstacle_file.h"
#include "solver/step.h"
#include "tests/app/example_frame.h"
#include "tests/app/input_fuzz/scene_seeds.h"
#include "tests/app/scene/pattern/tabard.h"
#include "tests/geometry/cache_files.h"
#include "tests/geometry/gltf_builder.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

/// Every seed is far smaller than a file that takes this long.
constexpr std::chrono::seconds kImportTime{60};

void write_plain(const std::string& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

std::string read_plain(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

RunConfig load(const std::string& path, const std::vector<std::string>& importer)
{
    LoadOptions options;
    options.importer = importer;
    return load_scene(path, {}, options);
}

InputKind mesh_kind(const std::string& name, const std::string& file, const std::string& seed,
                    const std::vector<std::string>& importer)
{
    const auto read = [importer](const std::string& path) {
        ObstacleFileRequest request;
        request.path = path;
        request.importer = importer;
        request.timeout = kImportTime;
        return validate(read_obstacle_file(request).mesh);
    };
    return {name, file, seed, write_plain, read};
}

/// A skin, morph targets that are sparse, and every kind of sampler.
GltfBuilder make_moving_gltf()
{
    GltfBuilder file = make_bent_tetrahedron();
    const std::size_t places = file.add_view(std::vector<std::uint8_t>{1});
    const std::size_t values = file.add_view(std::vector<float>{4, 0, 0});
    const std::size_t target =
        file.add("accessors", {{"componentType", 5126},
                               {"count", 4},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 1},
                                 {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                 {"values", {{"bufferView", values}}}}}});
    nlohmann::json& mesh = file.json["meshes"][0];
    mesh["primitives"][0]["targets"] = {{{"POSITION", target}}};
    mesh["weights"] = {0.5};
    file.animate(2, "weights", {0, 1, 3}, {0, 1, 0}, "STEP");
    file.animate(0, "translation", {1, 2}, {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 1, 1, 1},
                 "CUBICSPLINE");
    return file;
}

std::vector<InputKind> list_mesh_kinds(const std::vector<std::string>& importer, const std::string& folder)
{
    using namespace mesh_files;
    const ObstacleMesh mesh = samples::l_prism();
    const PolygonMesh polygons = {mesh.points, {{0, 1, 2}, {0, 2, 3, 4}, {5, 6, 7, 8, 9}, {3, 2, 1}}};
    write_plain(folder + "/buffer.bin", gltf_buffer(mesh));
    std::vector<InputKind> kinds;
    const auto add = [&](const std::string& name, const std::string& file, const std::string& seed) {
        kinds.push_back(mesh_kind(name, file, seed, importer));
    };
    add("OBJ", "mesh.obj", obj(polygons) + "l 1 2 3\np 4\n");
    add("text STL", "mesh.stl", ascii_stl(mesh));
    add("binary STL", "mesh.stl", binary_stl(mesh));
    add("text PLY", "mesh.ply", ascii_ply(polygons));
    add("binary PLY", "mesh.ply", binary_ply(mesh));
    add("big-endian PLY", "mesh.ply", binary_ply(mesh, true));
    add("glTF", "mesh.gltf", gltf_json(mesh, "buffer.bin"));
    add("GLB", "mesh.glb", glb(mesh));
    add("posed GLB", "posed.glb", make_moving_gltf().glb());
    add("COLLADA", "mesh.dae",
        dae(polygons, "<unit name=\"centimeter\" meter=\"0.01\"/><up_axis>Y_UP</up_axis>"));
    add("FBX", "mesh.fbx", fbx(polygons, 1, 100.0));
    add("3DS", "mesh.3ds", three_ds(mesh));
    add("3MF", "mesh.3mf", three_mf(mesh, " unit=\"inch\""));
    // The archive's checksum is right, so that the changed model is read.
    add("3MF model", "mesh.3mf", three_mf_model(mesh, " unit=\"inch\""));
    kinds.back().write = [](const std::string& path, const std::string& model) {
        write_plain(path, three_mf_package(model));
    };
    return kinds;
}

/// A kind of sealed file: the body is changed, and sealed anew.
InputKind sealed_kind(const std::string& name, const std::string& file, const FileKind& kind,
                      const std::string& sound, std::function<std::string(const std::string&)> read)
{
    const auto write = [kind](const std::string& path, const std::string& body) {
        write_sealed(path, kind, body);
    };
    return {name, file, read_sealed(sound, kind).body, write, std::move(read)};
}

/// Files that a run writes: a state with EOL vertices, contacts and pins, and moving obstacles.
void write_run_files(const RunConfig& config, const std::string& folder)
{
    write_obstacles(folder, record_obstacles(config));
    Checkpoint checkpoint;
    checkpoint.source = {folder + "/scene.toml", kScene, {"time.step=0.02"}};
    checkpoint.state = make_state(config.scene, config.cloth, config.cloth_velocity);
    checkpoint.state.active = {{{2, 5}, ContactKind::Edge, 0, 3, Vec3::UnitX(), 0.1}};
    checkpoint.state.eol = {{1, FeatureId::bend(0, 4, 1), Vec3::UnitZ(), 0, 0}};
    checkpoint.rows = 1;
    write_checkpoint(folder + "/checkpoint", checkpoint);
    write_frame(folder + "/frame.ply", make_example_frame());
}

/// The checkpoint of cloth that is being sewn.
void write_assembly(const RunConfig& config, const std::string& path)
{
    Checkpoint checkpoint = start_checkpoint(make_assembly(config), {"panels.toml", kPanels, {}});
    checkpoint.rows = 1;
    write_checkpoint(path, checkpoint);
}

const cache_files::Samples kBodySamples = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                           {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}, {0, 0, 1}},
                                           {{0, 0, 0}, {2, 0, 1}, {0, 1, 0}, {0, 0, 2}}};
constexpr const char* kBody = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

constexpr const char* kUsd = R"(#usda 1.0
(
    defaultPrim = "root"
    metersPerUnit = 0.01
    timeCodesPerSecond = 25
    upAxis = "Y"
)
def Xform "root" (
    kind = "component"
)
{
    double3 xformOp:translate.timeSamples = {
        0: (0, 0, 1),
        2.5: (1, 0, 1),
    }
    float3 xformOp:rotateXYZ = (10, 20, 30)
    quatf xformOp:orient = (0.5, 0.5, 0.5, 0.5)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "!invert!xformOp:orient"]
    def Mesh "body"
    {
        int[] faceVertexCounts = [3, 3, 3, 3]
        point3f[] points.timeSamples = {
            1: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
            2: [(0, 0, 0), (1, 0, 1), (0, 1, 0), (0, 0, 1)], # text
        }
        matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 2, 0, 0), (0, 0, 3, 0), (4, 5, 6, 1) )
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }
}
)";

/// Reads `samples` of a cache of the body.
std::string read_cache(const std::string& path)
{
    VertexCacheRequest request;
    request.path = path;
    request.vertex_count = 4;
    const auto cache = open_vertex_cache(request);
    std::vector<Vec3> vertices;
    for (std::size_t k = 0; k < cache->times().size(); ++k) {
        if (k > 0 && !(cache->times()[k] > cache->times()[k - 1])) return "its times do not ascend";
        cache->read(k, vertices);
        if (vertices.size() != 4) return "it has another number of vertices";
    }
    return {};
}

std::vector<InputKind> list_cache_kinds()
{
    const auto read_sequence = [](const std::string& path) {
        return read_cache((std::filesystem::path(path).parent_path() / "pose_%02d.obj").string());
    };
    return {{"MDD", "body.mdd", cache_files::mdd(kBodySamples, {0.0F, 0.04F, 0.1F}), write_plain, read_cache},
            {"PC2", "changed.pc2", cache_files::pc2(kBodySamples, 1.0), write_plain, read_cache},
            {"glTF animation", "moving.glb", make_moving_gltf().glb(), write_plain, read_cache},
            {"USD", "changed.usda", kUsd, write_plain, read_cache},
            {"OBJ sequence", "pose_07.obj", kBody, write_plain, read_sequence}};
}

/// Poses of a run's folder: places are finite wherever they are asked for.
std::string read_poses(const std::string& path)
{
    const PointCache cache(PoseFile::open(path), PoseInterpolation::Cubic);
    std::vector<Vec3> points, velocities;
    for (const double time : {-1.0, 0.1, 0.12, 0.16, 1e9}) {
        cache.find(time, points, velocities);
        for (const Vec3& point : points)
            if (!point.allFinite()) return "a place is not finite";
    }
    return {};
}

/// The head of a file of poses is changed, and gets its checksum.
InputKind poses_kind(const std::string& sound)
{
    const std::string whole = read_plain(sound);
    const std::string before = std::string("ARRIS poses\n") + std::string("\7\0\0\0\0\0\0\0poses 1", 15);
    BinaryReader in(std::string_view(whole).substr(before.size()), sound);
    const std::string head = in.text();
    const std::string samples = whole.substr(before.size() + 8 + head.size() + 4);
    const auto write = [before, samples](const std::string& path, const std::string& changed) {
        BinaryWriter out;
        out.text(changed);
        out.number(checksum(changed));
        write_plain(path, before + out.bytes() + samples);
    };
    return {"head of poses", "changed.poses", head, write, read_poses};
}

std::vector<InputKind> list_run_kinds(const std::string& folder)
{
    constexpr FileKind kCheckpoint = {"ARRIS checkpoint\n", kCheckpointVersion, "", ""};
    constexpr FileKind kObstacles = {"ARRIS obstacles\n", "obstacles 2", "", ""};
    const auto read_state = [](const std::string& path) {
        return validate(read_checkpoint(path).state.mesh);
    };
    const auto read_records = [](const std::string& path) {
        std::string defect;
        for (const ObstacleRecord& record :
             read_obstacles(std::filesystem::path(path).parent_path().string()))
            if (defect.empty()) defect = validate(record.mesh);
        return defect;
    };
    const auto read_cloth_frame = [](const std::string& path) {
        read_frame(path);
        return std::string();
    };
    const std::string checkpoint = folder + "/checkpoint";
    return {sealed_kind("checkpoint", "checkpoint", kCheckpoint, checkpoint, read_state),
            sealed_kind("checkpoint of sewing", "sewing", kCheckpoint, folder + "/sewing", read_state),
            {"checkpoint file", "checkpoint", read_plain(checkpoint), write_plain, read_state},
            sealed_kind("obstacles", "obstacles", kObstacles, obstacles_file(folder), read_records),
            {"poses", "changed.poses", read_plain(poses_file(folder, "body")), write_plain, read_poses},
            poses_kind(poses_file(folder, "body")),
            {"frame", "frame.ply", read_plain(folder + "/frame.ply"), write_plain, read_cloth_frame}};
}

}  // namespace

std::vector<InputKind> list_input_kinds(const std::vector<std::string>& importer, const std::string& folder)
{
    std::vector<InputKind> kinds = list_mesh_kinds(importer, folder);
    const auto read_cloth = [](const std::string& path) {
        return validate(read_cloth_file(path, 1.0, 'z').mesh);
    };
    kinds.push_back({"cloth", "cloth.obj",
                     "v 0 0 1\nv 1 0 1\nv 1 1 1.5\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1.1\nvt 0 1\n"
                     "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
                     write_plain, read_cloth});
    kinds.push_back(
        {"cloth with stitches", "sewn.obj",
         "v 0 0 1\nv 1 0 1\nv 1 1 1.5\nv 0 1 1\nv 2 0 1\nv 2 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "vt 3 0\nvt 4 0\nvt 3 1\nvt 4 1\ng left\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\ng right\n"
         "f 2/5 5/6 3/7\nf 5/6 6/8 3/7\nseam 2\nstitch 0 4 5 0.25\nstitch 3 5 4 1\n",
         write_plain, read_cloth});
    const auto read_pattern = [](const std::string& path) {
        constexpr double kEdgeLength = 0.05;
        const SewingPattern pattern = read_garment_code(path).pattern;
        const PatternMesh meshes = mesh_pattern(pattern, kEdgeLength);
        const std::string open = validate(join_panels(pattern, meshes, kEdgeLength).mesh);
        return open.empty() ? validate(join_panels(pattern, meshes, kEdgeLength, SewnSeams::All).mesh) : open;
    };
    kinds.push_back({"GarmentCode", "pattern.json", kTabard, write_plain, read_pattern});
    const auto read_scene = [importer](const std::string& path) {
        return validate(load(path, importer).cloth);
    };
    kinds.push_back({"scene", "scene.toml", kScene, write_plain, read_scene});
    kinds.push_back({"scene of panels", "panels.toml", kPanels, write_plain, read_scene});
    write_plain(folder + "/body.obj", kBody);
    write_plain(folder + "/body.pc2", cache_files::pc2(kBodySamples, 1.0));
    for (InputKind& kind : list_cache_kinds()) kinds.push_back(std::move(kind));
    write_plain(folder + "/scene.toml", kScene);
    write_run_files(load(folder + "/scene.toml", importer), folder);
    write_plain(folder + "/panels.toml", kPanels);
    write_assembly(load(folder + "/panels.toml", importer), folder + "/sewing");
    for (InputKind& kind : list_run_kinds(folder)) kinds.push_back(std::move(kind));
    return kinds;
}

}  // namespace arris
