// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/usda_cache.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/input_error.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A text with one Mesh of two points, /root/body, and these attributes of /root and of the Mesh.
std::string stage(const std::string& root, const std::string& mesh, const std::string& head = "")
{
    return fmt::format("#usda 1.0\n(\n{}\n)\ndef Xform \"root\"\n{{\n{}\ndef Mesh \"body\"\n{{\n{}\n}}\n}}\n",
                       head, root, mesh);
}

constexpr const char* kPoints = "point3f[] points = [(1, 0, 0), (0, 2, 3)]\n";
constexpr const char* kSamples =
    "point3f[] points.timeSamples = {\n1: [(0, 0, 0), (1, 0, 0)],\n2: [(0, 0, 1), (1, 0, 2.5e-1)],\n"
    "4: [(0, 0, 3), (1, 4, 0)],\n}\n";

struct Written {
    TemporaryDirectory dir;
    VertexCacheRequest request;

    explicit Written(const std::string& bytes, const std::string& name = "a.usda")
    {
        request.path = dir / name;
        request.vertex_count = 2;
        write_bytes(request.path, bytes);
    }
    std::unique_ptr<VertexCache> open() const { return open_vertex_cache(request); }
    std::vector<Vec3> read(std::size_t sample = 0) const
    {
        std::vector<Vec3> vertices;
        open()->read(sample, vertices);
        return vertices;
    }
    std::string refusal() const
    {
        std::vector<Vec3> vertices;
        const std::string error = error_of([&] {
            const auto cache = open();
            for (std::size_t k = 0; k < cache->times().size(); ++k) cache->read(k, vertices);
        });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        EXPECT_THAT(error, HasSubstr(request.path));
        return error;
    }
};

/// What a stage with `kPoints` gives at a sample.
std::vector<Vec3> placed(const std::string& root, const std::string& mesh, std::size_t sample = 0)
{
    return Written(stage(root, kPoints + mesh)).read(sample);
}

void expect_near(const std::vector<Vec3>& vertices, const Vec3& first, const Vec3& second)
{
    ASSERT_EQ(vertices.size(), 2U);
    EXPECT_LT((vertices[0] - first).norm(), 1e-12) << vertices[0].transpose();
    EXPECT_LT((vertices[1] - second).norm(), 1e-12) << vertices[1].transpose();
}

TEST(UsdaCache, ReadsSamplesOfPointsInAnyOrder)
{
    const Written file(stage("", kSamples, "timeCodesPerSecond = 10\nupAxis = \"Y\"\nmetersPerUnit = 0.01"));
    const auto cache = file.open();
    EXPECT_THAT(cache->times(), ElementsAre(0.0, 0.1, 0.3));
    EXPECT_TRUE(cache->is_single());
    EXPECT_EQ(cache->describe(2), file.request.path + ": time code 4");
    EXPECT_EQ(cache->declared().up, 'y');
    EXPECT_EQ(cache->declared().metres_per_unit, 0.01);
    expect_near(file.read(2), {0, 0, 3}, {1, 4, 0});
    std::vector<Vec3> vertices;
    for (const std::size_t k : {1, 0, 1, 2, 0, 2}) {
        cache->read(k, vertices);
        expect_near(vertices,
                    k == 0   ? Vec3(0, 0, 0)
                    : k == 1 ? Vec3(0, 0, 1)
                             : Vec3(0, 0, 3),
                    k == 0   ? Vec3(1, 0, 0)
                    : k == 1 ? Vec3(1, 0, 0.25)
                             : Vec3(1, 4, 0));
    }
}

TEST(UsdaCache, TimesFollowTheFileOrTheScene)
{
    Written file(stage("", kSamples));
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 1.0 / 24.0, 3.0 / 24.0));
    EXPECT_FALSE(file.open()->declared().up.has_value());
    file.request.frames_per_second = 5.0;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 0.2, 0.6));
    file.request.first = 1;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 0.4));
    EXPECT_EQ(file.open()->describe(0), file.request.path + ": time code 2");
    file.request.last = 3;
    EXPECT_THAT(file.refusal(), HasSubstr("has no sample 3; allowed: 0 to 2"));
    EXPECT_THAT(Written(stage("", kSamples, "framesPerSecond = 48")).open()->times(),
                ElementsAre(0.0, 1.0 / 48.0, 3.0 / 48.0));
}

TEST(UsdaCache, SamplesAreTheUnionOfThoseOfPointsAndPlacements)
{
    const Written file(
        stage("double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 3: (30, 0, 0), }\n"
              "uniform token[] xformOpOrder = [\"xformOp:translate\"]",
              kSamples));
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 1.0 / 24.0, 2.0 / 24.0, 3.0 / 24.0, 4.0 / 24.0));
    expect_near(file.read(0), {0, 0, 0}, {1, 0, 0});        // points are held before their first sample
    expect_near(file.read(1), {10, 0, 0}, {11, 0, 0});      // a placement between its samples
    expect_near(file.read(3), {30, 0, 2}, {31, 2, 0.125});  // points between their samples
    expect_near(file.read(4), {30, 0, 3}, {31, 4, 0});      // a placement held after its last sample
}

TEST(UsdaCache, OperationsActFromTheLastToTheFirst)
{
    const std::string order = "uniform token[] xformOpOrder = ";
    // scaled, turned by 90 degrees about z, moved
    expect_near(
        placed("",
               "double3 xformOp:translate = (10, 0, 0)\nfloat xformOp:rotateZ = 90\nfloat3 xformOp:scale = "
               "(2, 1, 1)\n" +
                   order + "[\"xformOp:translate\", \"xformOp:rotateZ\", \"xformOp:scale\"]"),
        {10, 2, 0}, {8, 0, 3});
    // about a pivot at x = 1
    expect_near(
        placed("", "float3 xformOp:translate:pivot = (1, 0, 0)\nfloat xformOp:rotateZ:a = 90\n" + order +
                       "[\"xformOp:translate:pivot\", \"xformOp:rotateZ:a\", "
                       "\"!invert!xformOp:translate:pivot\"]"),
        {1, 0, 0}, {-1, -1, 3});
    // x first, then y, then z: (0, 2, 3) -> (0, -3, 2) -> (2, -3, 0) -> (3, 2, 0)
    expect_near(placed("", "float3 xformOp:rotateXYZ = (90, 90, 90)\n" + order + "[\"xformOp:rotateXYZ\"]"),
                {0, 0, -1}, {3, 2, 0});
    // z first, then y, then x: (0, 2, 3) -> (-2, 0, 3) -> (3, 0, 2) -> (3, -2, 0)
    expect_near(placed("", "float3 xformOp:rotateZYX = (90, 90, 90)\n" + order + "[\"xformOp:rotateZYX\"]"),
                {0, 0, 1}, {3, -2, 0});
    // a third of a turn about (1, 1, 1), the real part first: x -> y -> z -> x
    expect_near(placed("", "quatf xformOp:orient = (0.5, 0.5, 0.5, 0.5)\n" + order + "[\"xformOp:orient\"]"),
                {0, 1, 0}, {3, 0, 2});
    // a matrix for row vectors
    expect_near(
        placed("",
               "matrix4d xformOp:transform = ( (0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 2, 0), (5, 6, 7, 1) )\n" +
                   order + "[\"xformOp:transform\"]"),
        {5, 7, 7}, {3, 6, 13});
    expect_near(placed("", "double xformOp:translateY = 4\nfloat xformOp:scaleX = 3\n" + order +
                               "[\"xformOp:translateY\", \"xformOp:scaleX\"]"),
                {3, 4, 0}, {0, 6, 3});
}

TEST(UsdaCache, PrimsAboveTheMeshActUnlessTheirStackIsReset)
{
    const std::string root =
        "float xformOp:rotateX = 90\nuniform token[] xformOpOrder = [\"xformOp:rotateX\"]";
    const std::string own = "double3 xformOp:translate = (0, 1, 0)\nuniform token[] xformOpOrder = [";
    expect_near(placed(root, own + "\"xformOp:translate\"]"), {1, 0, 1}, {0, -3, 3});
    expect_near(placed(root, own + "\"!resetXformStack!\", \"xformOp:translate\"]"), {1, 1, 0}, {0, 3, 3});
    // Operations that the order does not name do nothing.
    expect_near(placed("float xformOp:rotateX = 90", ""), {1, 0, 0}, {0, 2, 3});
}

TEST(UsdaCache, QuaternionsTurnAlongTheShorterArc)
{
    const double s = std::sqrt(0.5);
    const Written file(
        stage(fmt::format("quatd xformOp:orient.timeSamples = {{ 0: (1, 0, 0, 0), 2: ({}, 0, 0, {}) }}\n"
                          "float xformOp:rotateX:b.timeSamples = {{ 1: 0 }}\n"
                          "uniform token[] xformOpOrder = [\"xformOp:orient\", \"xformOp:rotateX:b\"]",
                          -s, -s),
              kPoints));
    expect_near(file.read(1), {s, s, 0}, {-2 * s, 2 * s, 3});
}

TEST(UsdaCache, DoublesStayDoubles)
{
    const Written file(stage("", "point3d[] points = [(0.1, 0, 0), (1, 1e-9, 0)]"));
    EXPECT_FALSE(file.open()->is_single());
    EXPECT_EQ(file.read()[1].y(), 1e-9);
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0));
}

TEST(UsdaCache, PassesOverEverythingElse)
{
    const std::string text = R"(#usda 1.0
(
    "Notes: { [ ( and \" "
    doc = """of
many { lines"""
    customLayerData = { string a = "}" ; dictionary b = { int[] c = [1, 2] } }
    defaultPrim = "root"
)
# { a comment
over "other" { def Mesh "hidden" { point3f[] points = [(0, 0, 0)] } }
class "kind" { }
def Scope "materials" { def Material "m" ( prepend apiSchemas = ["A"] ) {
    token outputs:surface.connect = </materials/m/s.outputs:surface>
    asset inputs:file = @textures/{a}.png@ ( colorSpace = "auto" ) ; asset other = @@@b@@@
    rel target = [</a[b]>, </c>]
    reorder properties = ["a", "b"]
} }
def Xform "root" (
    prepend references = None
    kind = "component"  # )
)
{
    custom double declared
    custom string note = 'it\'s }'
    prepend rel material:binding = </materials/m> ( bindMaterialAs = "strong" )
    rel empty
    reorder nameChildren = ["body"]
    float visible.timeSamples = { 0: 1, 7: None }
    /* { */ // {
    def Mesh "body" ( doc = "a" ) {
        int[] faceVertexIndices = [0, 1]
        uniform token subdivisionScheme = "none"
        point3f[] points ( interpolation = "vertex" )
        point3f[] points.timeSamples = {1.5:[(1,2,3),(4,5,6)]}
        normal3f[] normals.timeSamples = { 9: [(0, 0, 1)] }
        texCoord2f[] primvars:st = [(0, 0)] (
            interpolation = "vertex"
        )
    }
}
)";
    expect_near(Written(text).read(), {1, 2, 3}, {4, 5, 6});
    EXPECT_THAT(Written(text).open()->describe(0), HasSubstr("time code 1.5"));
    expect_near(Written(text, "a.USD").read(), {1, 2, 3}, {4, 5, 6});
}

TEST(UsdaCache, TheMeshIsTheOnlyOneWithSamplesElseTheOnlyOne)
{
    const std::string a = "def Mesh \"a\"\n{\n" + std::string(kPoints) + "}\n",
                      b = "def Mesh \"b\"\n{\n" + std::string(kSamples) + "}\n",
                      c = "def Mesh \"c\"\n{\n" + std::string(kSamples) + "}\n";
    EXPECT_EQ(Written("#usda 1.0\n" + a + b).open()->times().size(), 3U);
    EXPECT_THAT(Written("#usda 1.0\n" + b + a + c).refusal(),
                HasSubstr("has 2 meshes with samples in time: state `prim`; allowed: /b, /c"));
    Written file("#usda 1.0\n" + a + b + c);
    file.request.prim = "/a";
    EXPECT_EQ(file.open()->times().size(), 1U);
    file.request.prim = "/d";
    EXPECT_THAT(file.refusal(), HasSubstr("has no Mesh /d; allowed: /a, /b, /c"));
    EXPECT_THAT(Written("#usda 1.0\ndef Xform \"x\" { }").refusal(), HasSubstr("has no Mesh"));
    EXPECT_THAT(Written("#usda 1.0\ndef Mesh \"x\" { }").refusal(), HasSubstr("Mesh /x has no points"));
}

TEST(UsdaCache, CompositionAndBinaryFilesNameUsdcat)
{
    for (const char* metadata :
         {"references = @a.usd@</a> (offset = 1)", "prepend payload = [@a@]", "inherits = </a>"}) {
        const std::string text =
            fmt::format("#usda 1.0\ndef \"root\" ( {} ) {{ def Mesh \"body\" {{ {} }} }}", metadata, kPoints);
        EXPECT_THAT(Written(text).refusal(), AllOf(HasSubstr("prim /root has `"), HasSubstr("usdcat")))
            << metadata;
    }
    EXPECT_THAT(Written(stage("variantSet \"v\" = { \"a\" { def Mesh \"m\" { } } }", kPoints)).refusal(),
                AllOf(HasSubstr("prim /root has `variantSet`"), HasSubstr("usdcat")));
    EXPECT_THAT(Written(stage("", kPoints, "subLayers = [ @a.usda@ ]")).refusal(),
                AllOf(HasSubstr("line 3: "), HasSubstr("usdcat")));
    EXPECT_EQ(error_of([&] { Written(stage("", kPoints, "subLayers = [ ]")).open(); }), "");
    EXPECT_THAT(Written("PXR-USDC\x00\x08", "a.usd").refusal(), HasSubstr("usdcat"));
    EXPECT_THAT(Written("PK\x03\x04zzzz", "a.usdz").refusal(), HasSubstr("usdcat"));
    EXPECT_THAT(Written("xusda 1.0").refusal(), HasSubstr("is not a USD text"));
    EXPECT_NE(Written("").refusal(), "");
    EXPECT_THAT(Written(stage("", std::string(kPoints) + "int[] primvars:skel:jointIndices = [0]")).refusal(),
                HasSubstr("UsdSkel"));
}

TEST(UsdaCache, CountsOfPointsMustBeTheMeshs)
{
    Written file(stage("", kSamples));
    file.request.vertex_count = 3;
    EXPECT_THAT(file.refusal(), HasSubstr("Mesh /root/body has 2 points at time code 1; allowed: 3"));
    const std::string text = "point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0)], 2: [(0, 0, 0)] }";
    EXPECT_THAT(Written(stage("", text)).refusal(), HasSubstr("has 1 point at time code 2; allowed: 2"));
}

TEST(UsdaCache, DamagedTextsAreErrorsOfOneLine)
{
    const auto of_points = [](const std::string& value) {
        return Written(stage("", "point3f[] points = " + value)).refusal();
    };
    EXPECT_THAT(of_points("[(0, 0, 0), (1, 0)]"), HasSubstr("line 10: ')' where ',' is missing"));
    EXPECT_THAT(of_points("[(0, 0, 0), (1, 0, a)]"), HasSubstr("'a' is no number"));
    EXPECT_THAT(of_points("[(0, 0, 0), (1, 0, 1e999)]"), HasSubstr("'1e999' is no number"));
    EXPECT_THAT(of_points("[(0, 0, 0) (1, 0, 0)]"), HasSubstr("where ',' is missing"));
    EXPECT_THAT(of_points("[(0, 0, 0), (1, 0, 0], 5)"), HasSubstr("']' where ')' is missing"));
    EXPECT_THAT(of_points(std::string(300, '[')), HasSubstr("brackets within brackets"));
    EXPECT_THAT(of_points("None"), HasSubstr("has no points"));
    const auto of_samples = [](const std::string& samples) {
        return Written(stage("", "point3f[] points.timeSamples = " + samples)).refusal();
    };
    EXPECT_THAT(of_samples("{ 1: None }"), HasSubstr("has no value at time code 1"));
    EXPECT_THAT(of_samples("{ nan: [(0, 0, 0), (1, 0, 0)] }"), HasSubstr("time code nan"));
    EXPECT_THAT(of_samples("{ 1: [(0, 0, 0), (1, 0, 0)], 1.0: [(0, 0, 0), (1, 0, 0)] }"),
                HasSubstr("two values at time code 1"));
    const auto of_root = [](const std::string& root) { return Written(stage(root, kPoints)).refusal(); };
    const std::string order = "\nuniform token[] xformOpOrder = [\"xformOp:";
    EXPECT_THAT(of_root(order + "shear\"]"),
                HasSubstr("prim /root: xformOp:shear is not known; allowed: xformOp:translate"));
    EXPECT_THAT(of_root(order + "scale\"]"), HasSubstr("prim /root: xformOp:scale has no value"));
    EXPECT_THAT(of_root("float3 xformOp:scale = (1, 2, nan)" + order + "scale\"]"), HasSubstr("finite"));
    EXPECT_THAT(
        of_root(
            "float3 xformOp:scale = (1, 2, 0)\nuniform token[] xformOpOrder = [\"!invert!xformOp:scale\"]"),
        HasSubstr("has no inverse"));
    EXPECT_THAT(of_root("quatf xformOp:orient = (0, 0, 0, 0)" + order + "orient\"]"), HasSubstr("length 0"));
    EXPECT_THAT(
        of_root("matrix4d xformOp:transform = ((1, 0, 0, 1), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))" +
                order + "transform\"]"),
        HasSubstr("is a projection"));
    for (const char* head :
         {"metersPerUnit = 0", "metersPerUnit = inf", "upAxis = \"W\"", "timeCodesPerSecond = -1"})
        EXPECT_THAT(Written(stage("", kPoints, head)).refusal(), HasSubstr("allowed: ")) << head;
}

TEST(UsdaCache, EveryTruncationIsAnErrorOrAWholeMesh)
{
    const std::string whole = stage(
        "double3 xformOp:translate.timeSamples = { 0: (0, 0, 0) }\n"
        "uniform token[] xformOpOrder = [\"xformOp:translate\"] /* \" */",
        "string note = \"\"\"a\nb\"\"\"\n" + std::string(kSamples), "doc = 'a'");
    const std::size_t end = whole.find_last_of('}');
    for (std::size_t length = 0; length < end; ++length)
        EXPECT_NE(Written(whole.substr(0, length)).refusal(), "") << length;
    EXPECT_EQ(error_of([&] { Written(whole).open(); }), "");
}

TEST(UsdaCache, ValuesMayLieAnywhereAboutTheBlocksOfTheReader)
{
    for (const std::size_t blanks : {65400, 65500, 65530, 131000}) {
        const Written file(stage(std::string(blanks, ' ') + "#" + std::string(70000, '\'') + "\n", kSamples));
        expect_near(file.read(1), {0, 0, 1}, {1, 0, 0.25});
    }
}

}  // namespace
}  // namespace arris
