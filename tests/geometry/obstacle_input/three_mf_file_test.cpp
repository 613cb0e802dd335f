// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/three_mf_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRounding = 1e-12;
constexpr const char* kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr const char* kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr const char* kRootType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

using Files = std::vector<std::pair<std::string, std::string>>;

// A box from the origin, as the element of a mesh.
std::string box(double x, double y, double z)
{
    const ObstacleMesh mesh = samples::box(Vec3::Zero(), Vec3(x, y, z));
    std::string text = "<mesh><vertices>";
    for (const Vec3& p : mesh.points)
        text += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", p.x(), p.y(), p.z());
    text += "</vertices><triangles>";
    for (const auto& [a, b, c] : mesh.faces)
        text += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", a, b, c);
    return text + "</triangles></mesh>";
}

std::string object(const std::string& id, const std::string& content, const std::string& attributes = "")
{
    return fmt::format("<object id=\"{}\" {}>{}</object>", id, attributes, content);
}

std::string model(const std::string& unit, const std::string& objects, const std::string& items,
                  const std::string& attributes = "")
{
    return fmt::format(
        "<?xml version=\"1.0\"?><model unit=\"{}\" xmlns=\"{}\" xmlns:p=\"{}\" {}><resources>{}</resources>"
        "<build>{}</build></model>",
        unit, kCore, kProduction, attributes, objects, items);
}

std::string relationships(const std::string& target)
{
    return fmt::format(
        "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/"
        "relationships\"><Relationship Target=\"/thumb.png\" Id=\"r1\" Type=\"http://thumbnail\"/>"
        "<Relationship Target=\"{}\" Id=\"r0\" Type=\"{}\"/></Relationships>",
        target, kRootType);
}

// A package whose other parts come before the root part, as archives have no order.
std::string package(const std::string& root, const Files& parts = {})
{
    Files files = parts;
    files.emplace_back("3D/root.model", root);
    files.emplace_back("_rels/.rels", relationships("/3D/root.model"));
    return mesh_files::zip(files);
}

struct Placed {
    const char* name;
    std::string bytes;
    Vec3 low;  // m
    Vec3 high;
    int boxes;
    double volume;  // m^3
};

TEST(ThreeMfFile, PackagesArePlaced)
{
    const std::string one = object("1", box(1, 2, 3));
    const std::string item = "<item objectid=\"1\"/>";
    const std::string turn = "transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"";  // x to y, y to -x, then 10 along x
    const Files millimetres = {
        {"3D/Objects/other.model", model("millimeter", object("7", box(1000, 2000, 3000)), "")}};
    const Placed cases[] = {
        {"one object", package(model("meter", one, item)), {0, 0, 0}, {1, 2, 3}, 1, 6},
        {"first in the archive is another part",
         package(model("inch", one, item), millimetres),
         {0, 0, 0},
         0.0254 * Vec3(1, 2, 3),
         1,
         6 * std::pow(0.0254, 3)},
        {"item's transform",
         package(model("meter", one, "<item objectid=\"1\" " + turn + "/>")),
         {8, 0, 0},
         {10, 1, 3},
         1,
         6},
        {"translation in inches",
         package(model("inch", one, "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/>")),
         0.0254 * Vec3(10, 0, 0), 0.0254 * Vec3(11, 2, 3), 1, 6 * std::pow(0.0254, 3)},
        {"mirrored",
         package(model("meter", one, "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>")),
         {-1, 0, 0},
         {0, 2, 3},
         1,
         6},
        {"two items",
         package(model("meter", one, item + "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>")),
         {0, 0, 0},
         {6, 2, 3},
         2,
         12},
        {"object that is not built",
         package(model("meter", one + object("2", box(9, 9, 9)), item)),
         {0, 0, 0},
         {1, 2, 3},
         1,
         6},
        {"components",
         package(model("meter",
                       one + object("2",
                                    "<components><component objectid=\"1\"/><component objectid=\"1\" "
                                    "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components>"),
                       "<item objectid=\"2\" " + turn + "/>")),
         {8, 0, 0},
         {10, 6, 3},
         2,
         12},
        {"part of a component",
         package(model("meter",
                       object("2",
                              "<components><component p:path=\"/3D/Objects/other.model\" objectid=\"7\" "
                              "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components>"),
                       "<item objectid=\"2\"/>", "requiredextensions=\"p\""),
                 millimetres),
         {5, 0, 0},
         {6, 2, 3},
         1,
         6},
        {"part of an item",
         package(model("inch", "", "<item objectid=\"7\" p:path=\"/3D/Objects/other.model\"/>"), millimetres),
         {0, 0, 0},
         {1, 2, 3},
         1,
         6},
        {"own and other part",
         package(model("meter", one,
                       item + "<item objectid=\"7\" p:path=\"/3d/objects/Other.model\" "
                              "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>"),
                 millimetres),
         {0, 0, 0},
         {6, 2, 3},
         2,
         12},
        {"chain of parts",
         package(model("meter", "", "<item objectid=\"3\" p:path=\"/a.model\"/>"),
                 {{"a.model", model("centimeter",
                                    object("3",
                                           "<components><component p:path=\"/b.model\" objectid=\"4\" "
                                           "transform=\"1 0 0 0 1 0 0 0 1 500 0 0\"/></components>"),
                                    "")},
                  {"b.model", model("micron", object("4", box(1e6, 2e6, 3e6)), "")}}),
         {5, 0, 0},
         {6, 2, 3},
         1,
         6},
        {"other prefixes",
         mesh_files::zip(
             {{"_rels/.rels", relationships("3D/root.model")},
              {"3D/root.model",
               fmt::format("<m:model unit='meter' xmlns:m='{}' xmlns:prod='{}' requiredextensions='prod'>"
                           "<m:build><m:item objectid='7' prod:path='/other.model'/></m:build></m:model>",
                           kCore, kProduction)},
              {"other.model", model("meter", object("7", box(1, 2, 3)), "")}}),
         {0, 0, 0},
         {1, 2, 3},
         1,
         6},
        {"surface",
         package(model("meter", object("1", box(1, 2, 3), "type=\"surface\""), item)),
         {0, 0, 0},
         {1, 2, 3},
         1,
         6},
        {"materials required",
         package(model("meter", one, item,
                       "requiredextensions=\"m\" "
                       "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"")),
         {0, 0, 0},
         {1, 2, 3},
         1,
         6},
    };
    for (const Placed& c : cases) {
        const ObstacleFile file = imported("a.3mf", c.bytes);
        Eigen::AlignedBox3d bounds;
        for (const Vec3& p : file.mesh.points) bounds.extend(p);
        EXPECT_LT((bounds.min() - c.low).norm(), kRounding) << c.name;
        EXPECT_LT((bounds.max() - c.high).norm(), kRounding) << c.name;
        EXPECT_EQ(file.mesh.faces.size(), 12u * static_cast<unsigned>(c.boxes)) << c.name;
        EXPECT_NEAR(volume_of(file.mesh), c.volume, kRounding) << c.name;
        EXPECT_THAT(file.warnings, IsEmpty()) << c.name;
    }
}

TEST(ThreeMfFile, PackagesInEverySpellingAreRead)
{
    const std::string item = "<item objectid=\"1\"/>";
    const std::string one = object("1", box(1, 2, 3));
    const std::string root = model("meter", one, item);
    std::string chain = object("0", box(1, 2, 3));
    for (int k = 1; k <= 300; ++k)
        chain += object(fmt::format("{}", k),
                        fmt::format("<components><component objectid=\"{}\"/></components>", k - 1));
    // The comment of an archive stands at its end, with its length in front.
    std::string commented = package(root);
    const std::string comment = "made PK\x05\x06 by a program whose name is long enough";
    commented[commented.size() - 2] = static_cast<char>(comment.size());
    commented += comment;
    const std::pair<const char*, std::string> cases[] = {
        {"deep", package(model("meter", chain, "<item objectid=\"300\"/>"))},
        {"comment with the mark of the end", commented},
        {"bytes behind the end", package(root) + std::string(100, '\0')},
        {"percent-encoded target", mesh_files::zip({{"_rels/.rels", relationships("/3D/my%20root.model")},
                                                    {"3D/my root.model", root}})},
        {"backslash in a name",
         mesh_files::zip({{"_rels/.rels", relationships("/3D/root.model")}, {"3D\\root.model", root}})},
        {"blanks around numbers",
         package(model("meter", object("1", box(1, 2, 3)), "<item objectid=\" 1 \"/>"))},
    };
    for (const auto& [name, bytes] : cases) {
        const ObstacleFile file = imported("a.3mf", bytes);
        EXPECT_NEAR(volume_of(file.mesh), 6.0, kRounding) << name;
        EXPECT_THAT(file.warnings, IsEmpty()) << name;
    }
}

TEST(ThreeMfFile, VendorsElementsAreLeftOutAloud)
{
    const std::string vendor = "xmlns:v=\"http://vendor.com/x\"";
    const std::string item = "<item objectid=\"1\"/>";
    const ObstacleFile file = imported(
        "a.3mf", package(model("meter", object("1", box(1, 2, 3) + "<v:note/>"), item + item, vendor)));
    EXPECT_NEAR(volume_of(file.mesh), 6.0, kRounding);
    EXPECT_THAT(file.warnings, ElementsAre("object 1 of its part '3D/root.model' has <note> of an extension, "
                                           "which is not read",
                                           "dropped 12 duplicate faces"));
    EXPECT_THAT(import_error("a.3mf", package(model("meter", object("1", "<v:note/>"), item, vendor))),
                HasSubstr("has no mesh"));
}

TEST(ThreeMfFile, SupportsAreLeftOutAloud)
{
    const std::string objects = object("1", box(1, 2, 3)) + object("2", box(9, 9, 9), "type=\"support\"") +
                                object("3", box(9, 9, 9), "type=\"solidsupport\"") +
                                object("4", box(9, 9, 9), "type=\"other\"");
    const ObstacleFile file = imported(
        "a.3mf",
        package(model(
            "meter", objects,
            "<item objectid=\"1\"/><item objectid=\"2\"/><item objectid=\"3\"/><item objectid=\"4\"/>")));
    EXPECT_EQ(file.mesh.faces.size(), 12u);
    EXPECT_THAT(file.warnings, ElementsAre("1 placed object of type 'other' is left out",
                                           "1 placed object of type 'solidsupport' is left out",
                                           "1 placed object of type 'support' is left out"));
}

TEST(ThreeMfFile, DefectsAreOneClearLine)
{
    const std::string one = object("1", box(1, 2, 3));
    const std::string item = "<item objectid=\"1\"/>";
    const std::string root = model("meter", one, item);
    const std::string alternatives =
        "xmlns:pa=\"http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04\"";
    const std::string beams = "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\"";
    const struct {
        const char* name;
        std::string bytes;
        const char* says;
    } cases[] = {
        {"no relationships", mesh_files::zip({{"3D/3dmodel.model", root}}),
         "its archive has no '_rels/.rels'"},
        {"no root", mesh_files::zip({{"_rels/.rels", "<Relationships/>"}, {"a.model", root}}),
         "holds 0 models"},
        {"root that is missing",
         mesh_files::zip({{"_rels/.rels", relationships("/a.model")}, {"b.model", root}}),
         "its archive has no 'a.model'"},
        {"part that is missing",
         package(model("meter", "", "<item objectid=\"7\" p:path=\"/other.model\"/>")),
         "its archive has no 'other.model'"},
        {"object that is missing", package(model("meter", one, "<item objectid=\"2\"/>")),
         "object 2 of its part '3D/root.model' is placed, but is not there"},
        {"component that is missing",
         package(model("meter", object("2", "<components><component objectid=\"9\"/></components>"),
                       "<item objectid=\"2\"/>")),
         "object 9 of its part '3D/root.model' is placed"},
        {"circle",
         package(model("meter", object("2", "<components><component objectid=\"2\"/></components>"),
                       "<item objectid=\"2\"/>")),
         "components refer to each other in a circle"},
        {"circle of two",
         package(model("meter",
                       object("2", "<components><component objectid=\"3\"/></components>") +
                           object("3", "<components><component objectid=\"2\"/></components>"),
                       "<item objectid=\"2\"/>")),
         "components refer to each other in a circle"},
        {"two files of one name",
         mesh_files::zip({{"_rels/.rels", relationships("/a.model")}, {"a.model", root}, {"A.model", root}}),
         "its archive has two files named 'a.model'"},
        {"alternatives required",
         package(model("meter", one, item, "requiredextensions=\"pa\" " + alternatives)),
         "it requires the 3MF extension 'pa'"},
        {"alternatives",
         package(model("meter", object("1", box(1, 2, 3) + "<pa:alternatives/>"), item, alternatives)),
         "has its shape from <alternatives> of an extension"},
        {"nothing built", package(model("meter", one, "")), "its build has no items"},
        {"only supports", package(model("meter", object("1", box(1, 2, 3), "type=\"support\""), item)),
         "no faces"},
        {"unit", package(model("furlong", one, item)), "its part '3D/root.model': its unit 'furlong'"},
        {"type", package(model("meter", object("1", box(1, 2, 3), "type=\"modle\""), item)),
         "its type 'modle' is none of"},
        {"transform", package(model("meter", one, "<item objectid=\"1\" transform=\"1 0 0\"/>")),
         "has 3 numbers; allowed: 12"},
        {"word in a transform",
         package(model("meter", one, "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 a 0 0\"/>")),
         "'a' is no finite number"},
        {"beams required", package(model("meter", one, item, "requiredextensions=\"b\" " + beams)),
         "it requires the 3MF extension 'b'"},
        {"beams",
         package(model("meter", object("1", "<mesh><vertices/><triangles/><b:beamlattice/></mesh>"), item,
                       beams)),
         "has its shape from <beamlattice> of an extension"},
        {"prefix that is not declared", package(model("meter", one, item, "requiredextensions=\"q\"")),
         "'q' (not declared)"},
        {"no XML", package("<model"), "its part '3D/root.model': line 1: no well-formed XML"},
        {"no model", package("<html/>"), "no 3MF model: it begins with <html>"},
        {"vertex without z",
         package(model("meter", object("1", "<mesh><vertices><vertex x=\"1\" y=\"2\"/></vertices></mesh>"),
                       item)),
         "<vertex> has no attribute 'z'"},
        {"index",
         package(model(
             "meter",
             object("1",
                    "<mesh><vertices/><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>"),
             item)),
         "face 1 names vertex 1, but there are 0"},
    };
    for (const auto& c : cases) EXPECT_THAT(import_error("a.3mf", c.bytes), HasSubstr(c.says)) << c.name;
    std::string damaged = package(root);
    damaged[damaged.find("vertex x")] = 'V';
    EXPECT_THAT(import_error("a.3mf", damaged), HasSubstr("does not have its checksum"));
}

}  // namespace
}  // namespace arris
