// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "tests/app/error_of.h"
#include "tests/geometry/gltf_builder.h"

namespace arris {
namespace {

using nlohmann::json;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Kind = GltfSampler::Kind;

constexpr double kRounding = 1e-12;

/// The pose of a file at a time of its animation.
GltfPose pose_at(const GltfBuilder& file, double time, const std::optional<std::string>& name = {})
{
    const GltfDocument document{file.parsed(), file.chunk};
    GltfAccessors accessors(document, [](const std::string&) { return std::string(); });
    const GltfFigure figure(document.json, accessors);
    GltfPose pose = figure.rest();
    GltfAnimation(document.json, name, figure, accessors).apply(time, pose);
    return pose;
}

std::string refusal(const GltfBuilder& file, const std::optional<std::string>& name = {})
{
    const std::string error = error_of([&] { pose_at(file, 0.0, name); });
    EXPECT_EQ(error.find('\n'), std::string::npos);
    return error;
}

TEST(GltfSampler, LinearValuesAreHeldOutsideTheirKeys)
{
    const GltfSampler sampler{Kind::Linear, false, 2, {1, 2, 4}, {0, 10, 1, 20, 5, 20}};
    EXPECT_THAT(sampler.at(0.0), ElementsAre(0, 10));
    EXPECT_THAT(sampler.at(1.0), ElementsAre(0, 10));
    EXPECT_THAT(sampler.at(1.25), ElementsAre(0.25, 12.5));
    EXPECT_THAT(sampler.at(3.0), ElementsAre(3, 20));
    EXPECT_THAT(sampler.at(4.0), ElementsAre(5, 20));
    EXPECT_THAT(sampler.at(9.0), ElementsAre(5, 20));
}

TEST(GltfSampler, StepsJumpAtTheirKeys)
{
    const GltfSampler sampler{Kind::Step, false, 1, {1, 2}, {3, 7}};
    for (const auto& [time, value] : {std::pair{0.0, 3.0}, {1.0, 3.0}, {1.999, 3.0}, {2.0, 7.0}, {5.0, 7.0}})
        EXPECT_THAT(sampler.at(time), ElementsAre(value)) << time;
}

TEST(GltfSampler, ASplineThroughACubicIsTheCubic)
{
    const auto f = [](double t) { return 2.0 * t * t * t - t * t + 5.0; };
    const auto slope = [](double t) { return 6.0 * t * t - 2.0 * t; };
    GltfSampler sampler{Kind::CubicSpline, false, 1, {-1, 0.5, 3}, {}};
    for (const double t : sampler.times)
        for (const double value : {slope(t), f(t), slope(t)}) sampler.values.push_back(value);
    for (const double t : {-1.0, -0.3, 0.0, 0.5, 0.7, 2.9, 3.0})
        EXPECT_THAT(sampler.at(t), ElementsAre(DoubleNear(f(t), 1e-12 * f(3.0)))) << t;
    EXPECT_THAT(sampler.at(7.0), ElementsAre(DoubleNear(f(3.0), kRounding)));
    // Tangents in of the first key and out of the last do nothing.
    sampler.values.front() = sampler.values.back() = 1e9;
    EXPECT_THAT(sampler.at(2.0), ElementsAre(DoubleNear(f(2.0), 1e-12 * f(3.0))));
}

TEST(GltfSampler, RotationsTurnEvenlyAlongTheShorterArc)
{
    const double h = std::sqrt(0.5);
    for (const double sign : {1.0, -1.0}) {
        const GltfSampler sampler{Kind::Linear, true, 4, {0, 1}, {0, 0, 0, 1, 0, 0, sign * h, sign * h}};
        const std::vector<double> q = sampler.at(1.0 / 3.0);
        const double angle = std::acos(0.0) / 6.0;  // half of 30 degrees
        EXPECT_NEAR(q[2], std::sin(angle), kRounding);
        EXPECT_NEAR(q[3], std::cos(angle), kRounding);
    }
}

TEST(GltfAnimation, MovesNodesAndWeights)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", file.add_points(kTetrahedron)}},
                                                          {{"POSITION", file.add_points(kTetrahedron)}}};
    file.animate(0, "translation", {0, 2}, {0, 0, 0, 4, 0, 2});
    file.animate(0, "scale", {0, 2}, {1, 1, 1, 3, 1, 1}, "STEP");
    file.animate(2, "weights", {0, 2}, {0, 1, 1, 0.5});
    const GltfPose pose = pose_at(file, 1.0);
    EXPECT_EQ(pose[0].translation, Vec3(2, 0, 1));
    EXPECT_EQ(pose[0].scale, Vec3::Ones());
    EXPECT_THAT(pose[2].weights, ElementsAre(0.5, 0.75));
    EXPECT_NEAR(pose[1].rotation.angularDistance(Eigen::Quaterniond::Identity()), std::acos(0.0), 1e-7);
    EXPECT_EQ(pose[1].translation, Vec3(1, 0, 0)) << "what is not animated stays";
}

TEST(GltfAnimation, SplinesOfRotationsAreMadeUnitLength)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json.erase("animations");
    file.animate(1, "rotation", {0, 1},
                 {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    const Eigen::Quaterniond q = pose_at(file, 0.5)[1].rotation;  // the mean of both ends
    EXPECT_NEAR(q.z(), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(q.w(), std::sqrt(0.5), 1e-12);
}

TEST(GltfAnimation, RotationsMayBeNormalizedIntegers)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json["animations"][0]["samplers"][0]["output"] =
        file.add_numbers("VEC4", std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 32767, 32767}, true);
    EXPECT_NEAR(pose_at(file, 1.0)[1].rotation.z(), std::sqrt(0.5), 1e-12);
}

TEST(GltfAnimation, TheOnlyOneIsTakenElseThatOfTheName)
{
    GltfBuilder file = make_bent_tetrahedron();
    EXPECT_EQ(refusal(file, "walk"), "");
    EXPECT_EQ(refusal(file, "run"), "it has no animation \"run\"; allowed: \"walk\"");
    file.add("animations", {{"name", "run"}});
    file.animate(0, "translation", {0}, {7, 0, 0});
    file.add("animations", json::object());
    EXPECT_EQ(refusal(file),
              "it has 3 animations: state `animation`; allowed: \"walk\", \"run\", one without a name");
    EXPECT_EQ(pose_at(file, 0.0, "run")[0].translation, Vec3(7, 0, 0));
    file.json["animations"][2]["name"] = "run";
    EXPECT_THAT(refusal(file, "run"), HasSubstr("it has 2 animations of that name"));
    file.json.erase("animations");
    EXPECT_THAT(refusal(file), HasSubstr("it has no animation"));
}

TEST(GltfAnimation, DamagedOnesAreRefused)
{
    const auto of_rotation = [](const std::vector<float>& times, const std::vector<float>& values,
                                const char* kind = "LINEAR") {
        GltfBuilder file = make_bent_tetrahedron();
        file.json.erase("animations");
        file.animate(1, "rotation", times, values, kind);
        return refusal(file);
    };
    EXPECT_THAT(
        of_rotation({0, 2, 1}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}),
        HasSubstr("channel 0 of its animation: key 2 is at 1 s, the one before at 2 s; allowed: times "
                  "that ascend"));
    EXPECT_THAT(of_rotation({0, 0}, {0, 0, 0, 1, 0, 0, 0, 1}), HasSubstr("times that ascend"));
    EXPECT_THAT(of_rotation({0, NAN}, {0, 0, 0, 1, 0, 0, 0, 1}), HasSubstr("holds nan in element 1"));
    EXPECT_THAT(of_rotation({}, {}), HasSubstr("has no keys"));
    EXPECT_THAT(of_rotation({0, 1}, {0, 0, 0, 1}), HasSubstr("has 4 numbers for 2 keys; allowed: 4 a key"));
    EXPECT_THAT(of_rotation({0, 1}, {0, 0, 0, 1, 0, 0, 0, 1}, "CUBICSPLINE"), HasSubstr("allowed: 12 a key"));
    EXPECT_THAT(of_rotation({0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}), HasSubstr("rotation of key 1 has length 0"));
    EXPECT_THAT(of_rotation({0}, {0, 0, 0, 1}, "SMOOTH"), HasSubstr("its interpolation is \"SMOOTH\""));
    EXPECT_THAT(of_rotation({0}, {0, 0, 0, INFINITY}), HasSubstr("holds inf in element 0"));

    const auto changed = [](const char* pointer, const json& value) {
        GltfBuilder file = make_bent_tetrahedron();
        file.json[json::json_pointer(pointer)] = value;
        return refusal(file);
    };
    EXPECT_THAT(changed("/animations/0/channels/0/sampler", 1),
                HasSubstr("names sampler 1, but there are 1"));
    EXPECT_THAT(changed("/animations/0/channels/0/target/node", 3), HasSubstr("element 3 of its nodes"));
    EXPECT_THAT(changed("/animations/0/channels/0/target/path", "colour"), HasSubstr("moves \"colour\""));
    EXPECT_THAT(changed("/animations/0/channels", json::array()), HasSubstr("its animation moves nothing"));
    EXPECT_THAT(changed("/animations/0/samplers/0/input", 99), HasSubstr("element 99 of its accessors"));
    EXPECT_THAT(changed("/nodes/1", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}}),
                HasSubstr("moves node 1, which has a matrix"));
}

}  // namespace
}  // namespace arris
