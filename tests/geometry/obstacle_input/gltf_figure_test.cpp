// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_figure.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "tests/geometry/gltf_builder.h"
#include "tests/geometry/imported_file.h"

namespace arris {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The figure that a file shows, and its vertices at rest.
GltfFigure figure_of(const GltfBuilder& file)
{
    const GltfDocument document{file.parsed(), file.chunk};
    GltfAccessors accessors(document, [](const std::string&) { return std::string(); });
    return {document.json, accessors};
}

std::vector<Vec3> placed(const GltfFigure& figure, const GltfPose& pose)
{
    std::vector<Vec3> vertices;
    figure.place(pose, vertices);
    return vertices;
}

std::vector<Vec3> rest_of(const GltfBuilder& file)
{
    const GltfFigure figure = figure_of(file);
    return placed(figure, figure.rest());
}

void expect_near(const std::vector<Vec3>& vertices, const std::vector<Vec3>& expected,
                 double tolerance = 1e-12)
{
    ASSERT_EQ(vertices.size(), expected.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        EXPECT_LT((vertices[v] - expected[v]).norm(), tolerance) << v << ": " << vertices[v].transpose();
}

/// The error of a change of the bent tetrahedron; also of its import.
template <class Change>
std::string refusal(Change change)
{
    GltfBuilder file = make_bent_tetrahedron();
    change(file);
    const std::string error = error_of([&] { figure_of(file); });
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_NE(import_error("a.glb", file.glb()), "");
    return error;
}

// Turned by 90 degrees about z through (1, 0, 0), (x, y) is at (1 - y, x - 1).
const std::vector<Vec3> kBent = {
    {0, 0, 0}, {1, 1, 0}, {(1.0 + 0.0) / 2, (1.0 + 0.0) / 2, 0}, {(1.0 + 0.5) / 2, (0.5 + 0.0) / 2, 1}};

GltfPose bent_pose(const GltfFigure& figure)
{
    GltfPose pose = figure.rest();
    pose[1].rotation = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ());
    return pose;
}

TEST(GltfFigure, ASkinBlendsItsJointsAndForgetsTheMeshsNode)
{
    const GltfFigure figure = figure_of(make_bent_tetrahedron());
    EXPECT_EQ(figure.vertex_count(), 4U);
    expect_near(placed(figure, figure.rest()), kTetrahedron);
    expect_near(placed(figure, bent_pose(figure)), kBent);
}

TEST(GltfFigure, JointsHangOnTheNodesAboveThem)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json["nodes"].push_back({{"children", {0}}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 5}}});
    file.json["scenes"][0]["nodes"] = {3, 2};
    const GltfFigure figure = figure_of(file);
    std::vector<Vec3> expected;
    for (const Vec3& p : kBent) expected.push_back(2.0 * p + Vec3(0, 0, 5));
    expect_near(placed(figure, bent_pose(figure)), expected);
}

TEST(GltfFigure, WeightsMayBeIntegersAndCountRelativeToTheirSum)
{
    const auto with_weights = [](std::size_t (*add)(GltfBuilder&)) {
        GltfBuilder file = make_bent_tetrahedron();
        json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["WEIGHTS_0"] = add(file);
        const GltfFigure figure = figure_of(file);
        return placed(figure, bent_pose(figure));
    };
    expect_near(with_weights([](GltfBuilder& file) {
                    return file.add_numbers(
                        "VEC4",
                        std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 127, 127, 0, 0, 127, 127, 0, 0},
                        true);
                }),
                kBent);
    expect_near(with_weights([](GltfBuilder& file) {
                    return file.add_numbers("VEC4",
                                            std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 32767,
                                                                       32767, 0, 0, 32767, 32767, 0, 0},
                                            true);
                }),
                kBent);
    // Three quarters of the second joint for vertex 2, a quarter for vertex 3.
    const std::vector<Vec3> uneven = with_weights([](GltfBuilder& file) {
        return file.add_numbers(
            "VEC4", std::vector<float>{2, 0, 0, 0, 0.1F, 0, 0, 0, 0.5F, 1.5F, 0, 0, 0.25F, 0.75F, 0, 0});
    });
    expect_near(uneven, {kBent[0], kBent[1], {0.25, 0.25, 0}, {0.25 * 0.5 + 0.75, 0.75 * 0.5, 1}});
}

TEST(GltfFigure, ASecondSetOfJointsCounts)
{
    GltfBuilder file = make_bent_tetrahedron();
    json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    // Half of vertex 0 follows the second joint.
    attributes["JOINTS_1"] =
        file.add_numbers("VEC4", std::vector<std::uint16_t>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    attributes["WEIGHTS_1"] =
        file.add_numbers("VEC4", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const GltfFigure figure = figure_of(file);
    std::vector<Vec3> expected = kBent;
    expected[0] = 0.5 * Vec3(1, -1, 0);
    expect_near(placed(figure, bent_pose(figure)), expected);
    attributes["JOINTS_2"] = attributes["JOINTS_1"];
    EXPECT_THAT(error_of([&] { figure_of(file); }), HasSubstr("more than 8 joints a vertex"));
}

TEST(GltfFigure, WithoutInverseBindMatricesTheyAreIdentity)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json["skins"][0].erase("inverseBindMatrices");
    std::vector<Vec3> expected = kTetrahedron;  // joint 1 is at x = 1
    expected[1].x() += 1.0;
    for (const int v : {2, 3}) expected[v].x() += 0.5;
    expect_near(rest_of(file), expected);
}

TEST(GltfFigure, MorphTargetsMoveVerticesBeforeTheSkin)
{
    GltfBuilder file = make_bent_tetrahedron();
    json& primitive = file.json["meshes"][0]["primitives"][0];
    const std::size_t all = file.add_points({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    // Only vertex 1 of the second target moves: sparse, without data of its own.
    const std::size_t places = file.add_view(std::vector<std::uint8_t>{1});
    const std::size_t values = file.add_view(std::vector<float>{4, 0, 0});
    const std::size_t sparse =
        file.add("accessors", {{"componentType", 5126},
                               {"count", 4},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 1},
                                 {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                 {"values", {{"bufferView", values}}}}}});
    primitive["targets"] = {{{"POSITION", all}}, {{"NORMAL", all}}, {{"POSITION", sparse}}};
    expect_near(rest_of(file), kTetrahedron);
    file.json["meshes"][0]["weights"] = {0.5, 9, 0};
    std::vector<Vec3> raised = kTetrahedron;
    for (Vec3& p : raised) p.z() += 0.5;
    expect_near(rest_of(file), raised);
    file.json["nodes"][2]["weights"] = {0, 9, 0.25};  // of the node, before those of the mesh
    const GltfFigure figure = figure_of(file);
    std::vector<Vec3> expected = kBent;
    expected[1] = {1, 2, 0};
    expect_near(placed(figure, bent_pose(figure)), expected);

    // The import library knows neither skin nor targets.
    const ObstacleFile found = imported("a.glb", file.glb());
    ASSERT_EQ(found.mesh.points.size(), 4U);
    EXPECT_EQ(found.origins.vertex_count, 4);
    std::vector<Vec3> vertices = kTetrahedron;
    vertices[1].x() += 1.0;
    for (std::size_t p = 0; p < 4; ++p) {
        const Vec3& q = vertices[found.origins.of_points[p]];
        EXPECT_LT((found.mesh.points[p] - Vec3(q.x(), -q.z(), q.y())).norm(), 1e-12);
    }
}

TEST(GltfFigure, NodesPlaceMeshesInTheOrderInWhichTheyAreImported)
{
    GltfBuilder file;
    const std::size_t mesh = file.add_mesh(kTetrahedron, kTetrahedronCorners);
    json second = file.json["meshes"][0]["primitives"][0];
    second["attributes"]["POSITION"] =
        file.add_points({{0, 0, -9}, {2, 0, -9}, {1, 1, -9}, {1, 0.5, -8}, {7, 7, 7}});
    file.json["meshes"][0]["primitives"].push_back(second);
    const double s = std::sqrt(0.5);
    file.add("nodes",
             {{"mesh", mesh}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, s, s}}, {"scale", {1, 2, 1}}});
    file.add("nodes",
             {{"children", {0, 3}}, {"matrix", {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 100, 1}}});
    file.add("nodes", {{"mesh", mesh}});  // not shown
    file.add("nodes", {{"mesh", mesh}, {"translation", {0, 0, 50}}});
    file.show(1);

    const std::vector<Vec3> vertices = rest_of(file);
    ASSERT_EQ(vertices.size(), 18U);
    // (2, 0, 0) -> (0, 2, 0) -> (10, 2, 0); then x stays, y becomes z, z becomes -y
    EXPECT_LT((vertices[1] - Vec3(10, 0, 102)).norm(), 1e-12);
    // (1, 1, 0) -> (1, 2, 0) -> (-2, 1, 0) -> (8, 1, 0)
    EXPECT_LT((vertices[2] - Vec3(8, 0, 101)).norm(), 1e-12);
    EXPECT_LT((vertices[9 + 4 + 4] - Vec3(7, -57, 107)).norm(), 1e-12);

    const ObstacleFile found = imported("a.glb", file.glb());
    ASSERT_EQ(found.origins.vertex_count, 18);
    ASSERT_EQ(found.mesh.points.size(), 16U);
    for (std::size_t p = 0; p < 16; ++p) {
        const Vec3& q = vertices[found.origins.of_points[p]];
        EXPECT_LT((found.mesh.points[p] - Vec3(q.x(), -q.z(), q.y())).norm(), 1e-5) << p;
    }
}

TEST(GltfFigure, WhatTheSpecificationForbidsIsRefused)
{
    const auto primitive = [](GltfBuilder& file) -> json& { return file.json["meshes"][0]["primitives"][0]; };
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    primitive(file)["attributes"]["JOINTS_0"] = file.add_numbers(
                        "VEC4", std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0});
                }),
                HasSubstr("mesh 0, primitive 0: vertex 2 names joint 2 of skin 0, but there are 2"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    primitive(file)["attributes"]["WEIGHTS_0"] = file.add_numbers(
                        "VEC4", std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
                }),
                HasSubstr("the weights of vertex 1 are 0"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    primitive(file)["attributes"]["WEIGHTS_0"] = file.add_numbers(
                        "VEC4", std::vector<float>{1, 0, 0, 0, 2, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
                }),
                HasSubstr("vertex 1 has weight -1; allowed: at least 0"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    primitive(file)["attributes"]["WEIGHTS_0"] =
                        file.add_numbers("VEC4", std::vector<float>{1, 0, 0, 0});
                }),
                HasSubstr("joints for 4 vertices and weights for 1"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { primitive(file)["attributes"].erase("JOINTS_0"); }),
                HasSubstr("has no JOINTS_0 for skin 0"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { primitive(file)["attributes"].erase("WEIGHTS_0"); }),
                HasSubstr("it names element null of its accessors"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { file.json["skins"][0]["joints"][1] = 7; }),
                HasSubstr("it names element 7 of its nodes, but there are 3"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { file.json["nodes"][2]["skin"] = 1; }),
                HasSubstr("it names element 1 of its skins, but there are 1"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    file.json["skins"][0]["inverseBindMatrices"] =
                        file.add_numbers("MAT4", std::vector<float>(16, 1.0F));
                }),
                HasSubstr("skin 0 has 1 inverse bind matrices; allowed: one for each of 2 joints"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    file.json["skins"][0]["inverseBindMatrices"] = file.add_numbers(
                        "MAT4", std::vector<float>(32, std::numeric_limits<float>::quiet_NaN()));
                }),
                HasSubstr("holds nan in element 0; allowed: finite numbers"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) {
                    primitive(file)["targets"] = {{{"POSITION", file.add_points({{0, 0, 1}})}}};
                }),
                HasSubstr("target 0 moves 1 vertices; allowed: 4"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { file.json["nodes"][1]["children"] = {0}; }),
                HasSubstr("hang on each other in a circle"));
    EXPECT_THAT(refusal([&](GltfBuilder& file) { file.json["nodes"][2]["children"] = {1}; }),
                HasSubstr("node 1 is a child of nodes 0 and 2"));
}

TEST(GltfFigure, SparseElementsMustBeThere)
{
    const auto sparse = [](std::uint64_t count, std::uint8_t place, std::uint64_t values_count) {
        return refusal([&](GltfBuilder& file) {
            const std::size_t places = file.add_view(std::vector<std::uint8_t>{place});
            const std::size_t values = file.add_view(std::vector<float>(3 * values_count, 1.0F));
            file.json["accessors"][file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
                                       .get<std::size_t>()]["sparse"] = {
                {"count", count},
                {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                {"values", {{"bufferView", values}}}};
        });
    };
    EXPECT_THAT(sparse(1, 4, 1), HasSubstr("names element 4 in a sparse index, but there are 4"));
    EXPECT_THAT(sparse(1, 0, 0), HasSubstr("reaches beyond the end of its buffer"));
    EXPECT_THAT(sparse(2, 0, 2), HasSubstr("reaches beyond the end of its buffer"));
    EXPECT_THAT(sparse(5, 0, 5), HasSubstr("has 5 sparse elements; allowed: at most 4"));
}

}  // namespace
}  // namespace arris
