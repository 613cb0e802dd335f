// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "tests/app/error_of.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kSingle = 2e-7;  // single precision for coordinates of about 3

class ObstacleImport : public ::testing::Test {
  protected:
    ObstacleImport()
        : folder_(std::filesystem::path(::testing::TempDir()) /
                  (std::string("arris_obstacle_import_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~ObstacleImport() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const
    {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    ObstacleFile import(const std::string& name, const std::string& bytes, std::optional<double> unit = {},
                        std::optional<char> up = {}) const
    {
        return import_obstacle(write(name, bytes), unit, up);
    }

    std::string refusal(const std::string& name, const std::string& bytes) const
    {
        const std::string error = error_of([&] { import(name, bytes); });
        EXPECT_NE(error, "") << name << " was accepted";
        EXPECT_THAT(error, Not(HasSubstr("\n")));
        return error;
    }

    std::filesystem::path folder_;
};

// The importer does not accept numbers that begin with the decimal point, and skips such a vertex.
TEST_F(ObstacleImport, ObjNumbersMayBeginWithTheirPoint)
{
    const ObstacleFile plain = import("plain.obj", "v 0 0 0\nv 0.5 0 0\nv 1 1 0.25\nv 0 1 0\nf 1 2 3 4\n");
    for (const char* text : {"v 0 0 0\nv .5 0 0\nv 1 1 .25\nv 0 1 0\nf 1 2 3 4\n",
                             "o .x\nv 0 0 .0\r\nv\t.5 0 0 # .5\r\nv 1 1 \\\n.25\nv 0 1 0\nf 1 2 3 4",
                             "v 0 0 0\nv +.5 -.0 0\nv 1 1 .25\nv 0 1 0\nvt .5 .5\nvn .0 .0 1\n"
                             "f 1/1/1 2/1/1 3/1/1 4/1/1\n"}) {
        const ObstacleFile found = import("points.obj", text);
        EXPECT_EQ(found.mesh.points, plain.mesh.points) << text;
        EXPECT_EQ(found.mesh.faces, plain.mesh.faces) << text;
    }
}

// The three sides have different lengths, which identify the axes.
const Vec3 kSizes(1, 2, 3);

ObstacleMesh brick()
{
    return samples::box(Vec3::Zero(), kSizes);
}

double volume(const ObstacleMesh& mesh)
{
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.faces) six += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c]));
    return six / 6.0;
}

// A solid box with these opposite corners.
void expect_box(const ObstacleFile& file, const Vec3& a, const Vec3& b, const std::string& what)
{
    ASSERT_EQ(validate(file.mesh), "") << what;
    EXPECT_EQ(file.mesh.points.size(), 8u) << what;
    EXPECT_EQ(file.mesh.faces.size(), 12u) << what;
    Eigen::AlignedBox3d bounds;
    for (const Vec3& p : file.mesh.points) bounds.extend(p);
    const double size = (b - a).norm();
    EXPECT_LT((bounds.min() - a.cwiseMin(b)).norm(), kSingle * size) << what;
    EXPECT_LT((bounds.max() - a.cwiseMax(b)).norm(), kSingle * size) << what;
    EXPECT_NEAR(volume(file.mesh) / (b - a).cwiseAbs().prod(), 1.0, 10 * kSingle) << what;
    EXPECT_THAT(file.notes, Each(HasSubstr("welded"))) << what;
}

// Position of a file's brick with y or x up.
const Vec3 kYUp(1, -3, 2);
const Vec3 kXUp(-3, 2, 1);

TEST_F(ObstacleImport, EveryFormatGivesTheSameBox)
{
    struct Case {
        const char* name;
        std::string bytes;
        Vec3 corner;
        bool is_unwelded = false;
    };
    const ObstacleMesh mesh = brick();
    const Case cases[] = {
        {"box.obj", mesh_files::obj(mesh), kSizes},
        {"box.OBJ", mesh_files::obj(mesh), kSizes},
        {"ascii.stl", mesh_files::ascii_stl(mesh), kSizes, true},
        {"binary.stl", mesh_files::binary_stl(mesh), kSizes, true},
        {"ascii.ply", mesh_files::ascii_ply(mesh), kSizes},
        {"little.ply", mesh_files::binary_ply(mesh), kSizes},
        {"big.ply", mesh_files::binary_ply(mesh, true), kSizes},
        {"box.glb", mesh_files::glb(mesh), kYUp},
        {"box.dae", mesh_files::dae(mesh, "<up_axis>Z_UP</up_axis>"), kSizes},
        {"box.fbx", mesh_files::fbx(mesh, 2, 100.0), kSizes},
        {"box.3ds", mesh_files::three_ds(mesh), kSizes},
        {"box.3mf", mesh_files::three_mf(mesh, " unit=\"meter\""), kSizes},
    };
    for (const Case& c : cases) {
        const ObstacleFile file = import(c.name, c.bytes);
        expect_box(file, Vec3::Zero(), c.corner, c.name);
        for (const std::string& warning : file.warnings)
            EXPECT_TRUE(warning.starts_with("importer: ")) << c.name << ": " << warning;
        if (c.is_unwelded) {
            EXPECT_THAT(file.notes, Contains(HasSubstr("welded 28 vertices"))) << c.name;
        }
    }
}

TEST_F(ObstacleImport, PlainFormatsGiveNoWarning)
{
    const ObstacleMesh mesh = brick();
    EXPECT_THAT(import("a.obj", mesh_files::obj(mesh)).warnings, IsEmpty());
    EXPECT_THAT(import("a.ply", mesh_files::binary_ply(mesh)).warnings, IsEmpty());
    EXPECT_THAT(import("a.glb", mesh_files::glb(mesh)).warnings, IsEmpty());
    // (This file has no material.)
    EXPECT_THAT(import("a.dae", mesh_files::dae(mesh, "")).warnings, IsEmpty());
    EXPECT_THAT(import("a.3mf", mesh_files::three_mf(mesh, "")).warnings, IsEmpty());
}

TEST_F(ObstacleImport, DeclaredUnitsAndAxesAreApplied)
{
    struct Case {
        const char* name;
        std::string bytes;
        Vec3 corner;
    };
    const ObstacleMesh m = brick();
    const Case cases[] = {
        {"cm.dae", mesh_files::dae(m, "<unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis>"),
         0.01 * kSizes},
        {"inch_y.dae", mesh_files::dae(m, "<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Y_UP</up_axis>"),
         0.0254 * kYUp},
        {"none.dae", mesh_files::dae(m, ""), kYUp},  // y up is the format's default
        {"cm_y.fbx", mesh_files::fbx(m, 1, 1.0), 0.01 * kYUp},
        {"m_z.fbx", mesh_files::fbx(m, 2, 100.0), kSizes},
        {"inch_z.fbx", mesh_files::fbx(m, 2, 2.54), 0.0254 * kSizes},
        {"none.3mf", mesh_files::three_mf(m, ""), 1e-3 * kSizes},
        {"mm.3mf", mesh_files::three_mf(m, " unit='millimeter'"), 1e-3 * kSizes},
        {"inch.3mf", mesh_files::three_mf(m, " xml:lang=\"en\" unit = \"inch\""), 0.0254 * kSizes},
        {"foot.3mf", mesh_files::three_mf(m, " unit=\"foot\""), 0.3048 * kSizes},
        {"micron.3mf", mesh_files::three_mf(m, " unit=\"micron\""), 1e-6 * kSizes},
    };
    for (const Case& c : cases) expect_box(import(c.name, c.bytes), Vec3::Zero(), c.corner, c.name);
    // X_UP of COLLADA: x is up, right is -y, in is z; here up is turned to z about y alone.
    expect_box(import("x.dae", mesh_files::dae(m, "<up_axis>X_UP</up_axis>")), Vec3::Zero(), kXUp, "x.dae");
    expect_box(import("x.fbx", mesh_files::fbx(m, 0, 100.0)), Vec3::Zero(), kXUp, "x.fbx");
}

TEST_F(ObstacleImport, ExplicitUnitsAndAxesReplaceTheDeclared)
{
    const ObstacleMesh m = brick();
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", mesh_files::obj(m)},
        {"a.stl", mesh_files::binary_stl(m)},
        {"a.ply", mesh_files::ascii_ply(m)},
        {"a.glb", mesh_files::glb(m)},
        {"a.dae", mesh_files::dae(m, "<unit name=\"cm\" meter=\"0.01\"/><up_axis>X_UP</up_axis>")},
        {"a.fbx", mesh_files::fbx(m, 1, 2.54)},
        {"a.3ds", mesh_files::three_ds(m)},
        {"a.3mf", mesh_files::three_mf(m, " unit=\"inch\"")}};
    for (const auto& [name, bytes] : files) {
        expect_box(import(name, bytes, 0.001, 'z'), Vec3::Zero(), 0.001 * kSizes, name);
        expect_box(import(name, bytes, 2.0, 'y'), Vec3::Zero(), 2.0 * kYUp, name);
        expect_box(import(name, bytes, 1.0, 'x'), Vec3::Zero(), kXUp, name);
    }
}

TEST_F(ObstacleImport, NodePlacementsAreApplied)
{
    // glTF is y up: (x, y, z) -> (x, -z, y).
    const std::string placed = R"(,"scale":[2,2,2],"translation":[10,0,0])";
    expect_box(import("placed.glb", mesh_files::glb(brick(), placed)), Vec3(10, 0, 0), Vec3(12, -6, 4),
               "glb");
    expect_box(import("placed.dae", mesh_files::dae(brick(), "<up_axis>Z_UP</up_axis>",
                                                    "0 -1 0 5  1 0 0 0  0 0 1 0  0 0 0 1")),
               Vec3(5, 0, 0), Vec3(3, 1, 3), "dae");
}

TEST_F(ObstacleImport, MirroredNodesAreSolidsAndNoDefect)
{
    const ObstacleFile file = import("mirrored.glb", mesh_files::glb(brick(), R"(,"scale":[-1,1,1])"));
    expect_box(file, Vec3::Zero(), Vec3(-1, -3, 2), "mirrored");
    EXPECT_THAT(file.warnings, IsEmpty());
}

TEST_F(ObstacleImport, BuffersBesideTheMeshAreRead)
{
    write("buffer.bin", mesh_files::gltf_buffer(brick()));
    expect_box(import("box.gltf", mesh_files::gltf_json(brick(), "buffer.bin")), Vec3::Zero(), kYUp, "gltf");
    std::filesystem::create_directories(folder_ / "parts");
    write("parts/buffer.bin", mesh_files::gltf_buffer(brick()));
    expect_box(import("below.gltf", mesh_files::gltf_json(brick(), "parts/buffer.bin")), Vec3::Zero(), kYUp,
               "below");
    // A link to a file inside the folder.
    std::filesystem::create_symlink("parts/buffer.bin", folder_ / "link.bin");
    expect_box(import("link.gltf", mesh_files::gltf_json(brick(), "link.bin")), Vec3::Zero(), kYUp, "link");
}

TEST_F(ObstacleImport, MeshMayItselfBeALink)
{
    const std::string path = write("real.obj", mesh_files::obj(brick()));
    std::filesystem::create_symlink(path, folder_ / "link.obj");
    expect_box(import_obstacle((folder_ / "link.obj").string(), {}, {}), Vec3::Zero(), kSizes, "link");
}

TEST_F(ObstacleImport, NothingOutsideTheFolderIsOpened)
{
    // The mesh is in a subfolder. The file it refers to is beside that folder, and would be valid.
    const std::filesystem::path inner = folder_ / "inner";
    std::filesystem::create_directories(inner);
    write("out.bin", mesh_files::gltf_buffer(brick()));
    write("out.mtl", "newmtl red\nKd 1 0 0\n");
    std::filesystem::create_symlink(folder_ / "out.bin", inner / "link.bin");
    std::filesystem::create_directory_symlink(folder_, inner / "up");
    const std::string absolute = (folder_ / "out.bin").string();
    for (const std::string& uri : {std::string("../out.bin"), absolute, std::string("link.bin"),
                                   std::string("up/out.bin"), std::string("x/../../out.bin")}) {
        const std::string error = refusal("inner/a.gltf", mesh_files::gltf_json(brick(), uri));
        EXPECT_THAT(error, HasSubstr("the mesh's own folder")) << uri;
    }
    // The mesh is read without its materials.
    std::filesystem::create_symlink(folder_ / "out.mtl", inner / "link.mtl");
    for (const std::string name : {"../out.mtl", "link.mtl", "/etc/passwd"}) {
        const ObstacleFile file =
            import("inner/a.obj", "mtllib " + name + "\nusemtl red\n" + mesh_files::obj(brick()));
        expect_box(file, Vec3::Zero(), kSizes, name);
        EXPECT_THAT(file.warnings, Contains(HasSubstr("the mesh's own folder"))) << name;
    }
}

TEST_F(ObstacleImport, SecondaryPipesAndDevicesAreNotWaitedFor)
{
    ASSERT_EQ(::system(("mkfifo " + (folder_ / "buffer.bin").string()).c_str()), 0);
    EXPECT_THAT(refusal("pipe.gltf", mesh_files::gltf_json(brick(), "buffer.bin")), HasSubstr("buffer.bin"));
}

TEST_F(ObstacleImport, LinesAndPointsAreKept)
{
    const ObstacleMesh wire = samples::wire({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, false);
    const ObstacleFile lines = import("wire.obj", mesh_files::obj(wire));
    EXPECT_EQ(lines.mesh.points, wire.points);
    EXPECT_EQ(lines.mesh.segments, wire.segments);
    EXPECT_THAT(lines.warnings, IsEmpty());
    // One statement with several vertices.
    EXPECT_EQ(import("chain.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2 3 4 1\n").mesh.segments.size(),
              4u);

    const ObstacleMesh nails = samples::nails({{0, 0, 0}, {1, 2, 3}, {4, 5, 6}});
    EXPECT_EQ(import("nails.obj", mesh_files::obj(nails)).mesh.lone_points.size(), 3u);
    const ObstacleFile cloud = import("nails.ply", mesh_files::ascii_ply(nails));
    EXPECT_EQ(cloud.mesh.points, nails.points);
    EXPECT_EQ(cloud.mesh.lone_points, nails.lone_points);
}

TEST_F(ObstacleImport, PolygonsAreTriangulated)
{
    constexpr int kCorners = 200;
    std::string text, face = "f";
    for (int k = 0; k < kCorners; ++k) {
        const double radius = k % 2 == 0 ? 1.0 : 0.5;  // a star, concave at every second corner
        const double angle = 2.0 * M_PI * k / kCorners;
        text += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
        face += fmt::format(" {}", k + 1);
    }
    const ObstacleFile star = import("star.obj", text + face + "\n");
    EXPECT_EQ(validate(star.mesh), "");
    EXPECT_EQ(star.mesh.faces.size(), static_cast<std::size_t>(kCorners - 2));
    EXPECT_THAT(star.notes, ElementsAre("open: 200 border edges, two-sided"));

    // A self-crossing quadrilateral must not be changed silently.
    const ObstacleFile bowtie = import("bow.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n");
    EXPECT_EQ(validate(bowtie.mesh), "");
    EXPECT_THAT(bowtie.warnings, Not(IsEmpty()));
}

TEST_F(ObstacleImport, SizesFromMicronsToKilometres)
{
    for (const double scale : {1e-6, 1e-3, 1e3, 3e5}) {
        const ObstacleMesh mesh = samples::box(Vec3::Zero(), scale * kSizes);
        for (const auto& [name, bytes] :
             {std::pair{"a.obj", mesh_files::obj(mesh)}, std::pair{"a.stl", mesh_files::binary_stl(mesh)},
              std::pair{"a.glb", mesh_files::glb(mesh)}})
            expect_box(import(name, bytes), Vec3::Zero(), scale * (name[2] == 'g' ? kYUp : kSizes),
                       fmt::format("{} {}", name, scale));
    }
    // A plate a million times as wide as it is thick.
    const ObstacleMesh plate = samples::box(Vec3::Zero(), Vec3(1000, 1000, 1e-3));
    expect_box(import("plate.ply", mesh_files::ascii_ply(plate)), Vec3::Zero(), Vec3(1000, 1000, 1e-3),
               "plate");
}

TEST_F(ObstacleImport, WarnsOfSinglePrecisionFarFromTheOrigin)
{
    const Vec3 corner(50000, 0, 0);
    const ObstacleMesh far = samples::box(corner, corner + Vec3::Ones());
    EXPECT_THAT(import("far.obj", mesh_files::obj(far)).warnings,
                ElementsAre(HasSubstr("2.89e+04 times its size")));
    const ObstacleMesh nearer = samples::box(0.1 * corner, 0.1 * corner + Vec3::Ones());
    EXPECT_THAT(import("near.obj", mesh_files::obj(nearer)).warnings, IsEmpty());
}

TEST_F(ObstacleImport, RepairsAreToldWithTheirCounts)
{
    ObstacleMesh mesh = brick();
    mesh.faces.push_back(mesh.faces[0]);
    std::swap(mesh.faces[5][0], mesh.faces[5][1]);
    const ObstacleFile file = import("dirty.ply", mesh_files::binary_ply(mesh));
    expect_box(file, Vec3::Zero(), kSizes, "dirty");
    EXPECT_THAT(file.warnings, ElementsAre("dropped 1 duplicate face", HasSubstr("turned 1 of 12 faces")));
}

TEST_F(ObstacleImport, PlyEdgesAreMissedAloud)
{
    const std::string text = mesh_files::ascii_ply(brick());
    const std::size_t at = text.find("end_header");
    const std::string edges = text.substr(0, at) +
                              "element edge 2\nproperty int vertex1\nproperty int vertex2\n" +
                              text.substr(at) + "0 1\n1 2\n";
    EXPECT_THAT(import("edges.ply", edges).warnings, Contains(HasSubstr("its 2 edges")));
}

}  // namespace
}  // namespace arris
