// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons in files of every format that has them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include <algorithm>

#include "geometry/cloth_input/cloth_file.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kSingle = 1e-6;  // relative

using mesh_files::PolygonMesh;

// A prism over an outline in the plane y = 0, whose two ends are polygons that start at the given corner.
PolygonMesh prism(const std::vector<Vec2>& outline, std::size_t start)
{
    PolygonMesh made;
    const int n = static_cast<int>(outline.size());
    for (const double y : {0.0, 1.5})
        for (const Vec2& p : outline) made.points.emplace_back(p.x(), y, p.y());
    std::vector<int> front, back;
    for (int k = 0; k < n; ++k) {
        front.push_back((n - 1 - k + static_cast<int>(start)) % n);
        back.push_back(n + (k + static_cast<int>(start)) % n);
        made.faces.push_back({k, (k + 1) % n, n + (k + 1) % n, n + k});
    }
    made.faces.push_back(front);
    made.faces.push_back(back);
    return made;
}

std::string dae(const PolygonMesh& mesh)
{
    return mesh_files::dae(mesh, "<up_axis>Z_UP</up_axis>");
}

std::string fbx(const PolygonMesh& mesh)
{
    return mesh_files::fbx(mesh, 2, 100.0);
}

struct Outline {
    const char* name;
    std::vector<Vec2> corners;  // clockwise seen along +y
    double area;
};

std::vector<Outline> outlines()
{
    return {
        {"square", {{0, 0}, {0, 1}, {1, 1}, {1, 0}}, 1.0},
        {"two steps", {{0, 0}, {0, 0.1}, {0.08, 0.1}, {0.08, 0.05}, {0.16, 0.05}, {0.16, 0}}, 0.012},
        {"three steps", {{0, 0}, {0, 3}, {1, 3}, {1, 2}, {2, 2}, {2, 1}, {3, 1}, {3, 0}}, 6.0},
        {"U", {{0, 0}, {0, 3}, {1, 3}, {1, 1}, {2, 1}, {2, 3}, {3, 3}, {3, 0}}, 7.0},
        {"plus",
         {{1, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {2, 2}, {3, 2}, {3, 1}, {2, 1}, {2, 0}},
         5.0},
        {"corners on sides", {{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}, {2, 1}, {2, 0}, {1, 0}}, 4.0},
        {"dart", {{0, 0}, {1, 1}, {0, 2}, {3, 1}}, 2.0},
    };
}

TEST(ObstaclePolygons, EveryFormatAndStartGivesTheSameSolid)
{
    const struct {
        const char* file;
        std::string (*write)(const PolygonMesh&);
    } formats[] = {{"prism.obj", mesh_files::obj},
                   {"prism.ply", mesh_files::ascii_ply},
                   {"prism.dae", dae},
                   {"prism.fbx", fbx}};
    for (const Outline& outline : outlines())
        for (std::size_t start = 0; start < outline.corners.size(); ++start)
            for (const auto& format : formats) {
                SCOPED_TRACE(fmt::format("{}, start {}, {}", outline.name, start, format.file));
                const ObstacleFile file = imported(format.file, format.write(prism(outline.corners, start)));
                EXPECT_EQ(validate(file.mesh), "");
                EXPECT_EQ(file.mesh.points.size(), 2 * outline.corners.size());
                EXPECT_EQ(file.mesh.faces.size(), 4 * outline.corners.size() - 4);
                EXPECT_NEAR(volume_of(file.mesh), 1.5 * outline.area, kSingle * outline.area);
                double area = 0.0;
                double expected = 2.0 * outline.area;
                for (const auto& [a, b, c] : file.mesh.faces) {
                    const std::vector<Vec3>& p = file.mesh.points;
                    area += 0.5 * (p[b] - p[a]).cross(p[c] - p[a]).norm();
                }
                for (std::size_t k = 0; k < outline.corners.size(); ++k)
                    expected +=
                        1.5 * (outline.corners[(k + 1) % outline.corners.size()] - outline.corners[k]).norm();
                EXPECT_NEAR(area, expected, kSingle * expected);
                for (const std::string& warning : file.warnings)
                    EXPECT_TRUE(warning.starts_with("importer: ")) << warning;
            }
}

TEST(ObstaclePolygons, MirroredNodesMirrorTheirPolygons)
{
    std::string text = dae(prism(outlines()[1].corners, 2));
    text.insert(text.find("<instance_geometry"), "<scale>-1 1 1</scale>");
    const ObstacleFile file = imported("mirrored.dae", text);
    EXPECT_NEAR(volume_of(file.mesh), 1.5 * 0.012, kSingle);
    for (const std::string& warning : file.warnings)
        EXPECT_THAT(warning, ::testing::Not(HasSubstr("turned")));
}

TEST(ObstaclePolygons, HolesMayBeJoinedByABridge)
{
    const ObstacleFile file =
        imported("frame.obj",
                 "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\n"
                 "f 1 2 3 4 1 5 6 7 8 5\n");
    EXPECT_EQ(file.mesh.faces.size(), 8u);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_THAT(file.notes, ElementsAre(HasSubstr("open: 8 border edges")));
}

TEST(ObstaclePolygons, CrossingPolygonsAreSaidToCross)
{
    const struct {
        const char* name;
        const char* text;
        int crossing;
    } cases[] = {
        {"bow-tie", "v 0 0 0\nv 1 0 0\nv 0.2 1 0\nv 0.8 1.2 0\nf 1 2 3 4\n", 1},
        {"symmetric bow-tie", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", 1},
        {"two of three", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 3 2 4\nf 1 2 3 4\nf 2 3 4 1\n", 2},
        {"pentagram", "v 1 0 0\nv -0.8 0.6 0\nv 0.3 -0.95 0\nv 0.3 0.95 0\nv -0.8 -0.6 0\nf 1 2 3 4 5\n", 1},
    };
    for (const auto& c : cases)
        EXPECT_THAT(imported("crossing.obj", c.text).warnings,
                    ::testing::Contains(HasSubstr(c.crossing == 1 ? "1 polygon crosses itself"
                                                                  : "2 polygons cross themselves")))
            << c.name;
}

TEST(ObstaclePolygons, CrossingPolygonsAreCutAlikeFromEveryStart)
{
    const std::string corners = "v 0 0 0\nv 2 2 0\nv 2 0 0.5\nv 0 2 0\nv -1 0.5 0\n";
    const std::string faces[] = {"f 1 2 3 4 5\n", "f 2 3 4 5 1\n", "f 3 4 5 1 2\n", "f 5 1 2 3 4\n"};
    const auto surface = [&](const std::string& face) {
        const ObstacleFile file = imported("crossing.obj", corners + face);
        EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("1 polygon crosses itself"))) << face;
        const ObstacleMesh& mesh = file.mesh;
        double area = 0.0;
        for (const auto& [a, b, c] : mesh.faces)
            area += (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
        return area;
    };
    for (const std::string& face : faces) EXPECT_NEAR(surface(face), surface(faces[0]), 1e-12) << face;
}

TEST(ObstaclePolygons, BentPolygonsAreToldWithPlaceAndDistance)
{
    const auto warnings = [](double bend, const char* file) {
        const PolygonMesh mesh = {{{5, 0, bend}, {6, 0, -bend}, {6, 1, bend}, {5, 1, -bend}}, {{0, 1, 2, 3}}};
        const std::string name = file;
        return imported(name, name.ends_with("obj")   ? mesh_files::obj(mesh)
                              : name.ends_with("dae") ? dae(mesh)
                                                      : mesh_files::ascii_ply(mesh))
            .warnings;
    };
    for (const char* file : {"a.obj", "a.ply", "a.dae"}) {
        EXPECT_THAT(warnings(1e-4, file), IsEmpty()) << file;
        EXPECT_THAT(
            warnings(0.05, file),
            ElementsAre(::testing::AllOf(HasSubstr("1 polygon is not flat; it has a corner at [5, 0, 0.05]"),
                                         HasSubstr("0.05 m off its plane (0.071 of its size)"))))
            << file;
    }
}

TEST(ObstaclePolygons, RepeatedCornersDoNoHarm)
{
    const ObstacleFile file = imported("twice.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 2 3 4 4\n");
    EXPECT_EQ(file.mesh.faces.size(), 2u);
    EXPECT_THAT(file.warnings, IsEmpty());
}

// --- cloth

ClothFile cloth(const std::string& text)
{
    const std::string path =
        ::testing::TempDir() + fmt::format("arris_obstacle_polygons_cloth_{}.obj", ::getpid());
    std::ofstream(path, std::ios::binary) << text;
    return read_cloth_file(path, 1.0, 'z');
}

// A polygon of cloth that starts at the given corner. With UVs, the world is the material bent about v.
std::string cloth_text(const std::vector<Vec2>& outline, std::size_t start, bool has_uvs)
{
    std::string text, face = "f";
    for (const Vec2& p : outline) {
        text += fmt::format("v {} {} {}\n", p.x(), p.y(), has_uvs ? 0.1 * p.x() * p.x() : 0.0);
        text += fmt::format("vt {} {}\n", p.x(), p.y());
    }
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const std::size_t corner = (k + start) % outline.size() + 1;
        face += has_uvs ? fmt::format(" {0}/{0}", corner) : fmt::format(" {}", corner);
    }
    return text + face + "\n";
}

TEST(ObstaclePolygons, ClothOfEveryStartHasTheSameMaterial)
{
    for (const Outline& outline : outlines())
        for (const bool is_reversed : {false, true})
            for (const bool has_uvs : {false, true})
                for (std::size_t start = 0; start < outline.corners.size(); ++start) {
                    SCOPED_TRACE(fmt::format("{}, start {}", outline.name, start));
                    std::vector<Vec2> corners = outline.corners;
                    if (is_reversed) std::reverse(corners.begin(), corners.end());
                    const ClothFile file = cloth(cloth_text(corners, start, has_uvs));
                    EXPECT_EQ(file.mesh.faces.size(), corners.size() - 2);
                    double area = 0.0;
                    for (const auto& [a, b, c] : file.mesh.faces) {
                        const std::vector<Vec2>& X = file.mesh.material;
                        const Vec2 u = X[b] - X[a], v = X[c] - X[a];
                        EXPECT_GT(u.x() * v.y() - u.y() * v.x(), 0.0);
                        area += 0.5 * (u.x() * v.y() - u.y() * v.x());
                    }
                    EXPECT_NEAR(area, outline.area, 1e-12 * outline.area);
                }
}

// A frame whose hole is joined by a bridge, one way of which has a corner that is off by rounding.
TEST(ObstaclePolygons, ClothHasNoGapsWithinRounding)
{
    for (const double off : {0.0, 1e-16, -1e-16, 1e-7, -1e-7})
        for (const bool has_uvs : {false, true})
            for (std::size_t start = 0; start < 11; start += 5) {
                const std::vector<Vec2> bridge = {{0, 0},           {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1},
                                                  {0.3, 0.3 + off}, {0, 0}, {4, 0}, {4, 4}, {0, 4}};
                const ClothFile file = cloth(cloth_text(bridge, start, has_uvs));
                double area = 0.0;
                for (const auto& [a, b, c] : file.mesh.faces)
                    area +=
                        0.5 * twice_area(file.mesh.material[a], file.mesh.material[b], file.mesh.material[c]);
                EXPECT_NEAR(area, 12.0, 1e-6) << off << " " << start;
                EXPECT_EQ(file.mesh.vertex_count(), 9) << off << " " << start;
            }
    // Corners of the two ways that are nearly one become one.
    const std::vector<Vec2> twice = {{0, 0},        {1, 1},    {1, 2}, {2, 2}, {2, 1},
                                     {1, 1 + 1e-8}, {1e-8, 0}, {3, 0}, {3, 3}, {0, 3}};
    EXPECT_EQ(cloth(cloth_text(twice, 0, false)).mesh.vertex_count(), 8);
}

TEST(ObstaclePolygons, ClothThatHangsTogetherInAPointIsTold)
{
    const std::vector<Vec2> lobes = {{0, 0}, {4, 0}, {4, 2}, {4 / 3.0, 0}, {0, 2}};
    EXPECT_THAT(
        error_of([&] { cloth(cloth_text(lobes, 0, false)); }),
        ::testing::AllOf(HasSubstr("vertex 4 joins parts of the cloth in a single point, where the polygon"),
                         HasSubstr("touches itself; allowed: parts that share an edge, or that are apart")));
}

TEST(ObstaclePolygons, ClothThatCrossesItselfIsRefused)
{
    const std::string corners = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_THAT(error_of([&] { cloth(corners + "f 1 2 3 4\n"); }),
                HasSubstr("line 5: its polygon crosses itself; allowed: corners in their order"));
    EXPECT_THAT(
        error_of([&] {
            cloth("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
        }),
        HasSubstr("line 9: its polygon crosses itself in material space"));
    EXPECT_THAT(error_of([&] { cloth("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n"); }),
                HasSubstr("line 5: its polygon has no area"));
}

}  // namespace
}  // namespace arris
