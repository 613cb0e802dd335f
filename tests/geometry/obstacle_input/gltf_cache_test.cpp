// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/gltf_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/input_error.h"
#include "geometry/obj_file.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"
#include "tests/geometry/gltf_builder.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Written {
    TemporaryDirectory dir;
    VertexCacheRequest request;

    explicit Written(const std::string& bytes, int vertex_count = 4)
    {
        request.path = dir / "a.glb";
        request.vertex_count = vertex_count;
        write_bytes(request.path, bytes);
    }
    std::unique_ptr<VertexCache> open() const { return open_vertex_cache(request); }
    std::string refusal() const
    {
        const std::string error = error_of([&] { open(); });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        EXPECT_THAT(error, HasSubstr(request.path + ": "));
        return error;
    }
};

/// Moves the tetrahedron of two bones along x from 0 at the first time to 1 m at the second.
GltfBuilder moved_between(float first, float second)
{
    GltfBuilder file = make_bent_tetrahedron();
    file.json.erase("animations");
    file.animate(0, "translation", {first, second}, {0, 0, 0, 1, 0, 0});
    return file;
}

TEST(GltfCache, IsSampledAtFramesFromTheFirstToTheLastKey)
{
    Written file(moved_between(0.5F, 0.75F).glb());
    const auto cache = file.open();
    ASSERT_EQ(cache->times().size(), 7U);
    for (int k = 0; k < 7; ++k) EXPECT_EQ(cache->times()[k], k / 24.0);
    EXPECT_TRUE(cache->is_single());
    EXPECT_EQ(cache->declared().metres_per_unit, 1.0);
    EXPECT_EQ(cache->declared().up, 'y');
    EXPECT_EQ(cache->describe(3), file.request.path + ": sample 3, at 0.625 s");
    std::vector<Vec3> vertices;
    for (const std::size_t k : {3, 0, 6}) {
        cache->read(k, vertices);
        ASSERT_EQ(vertices.size(), 4U);
        for (int v = 0; v < 4; ++v)
            EXPECT_LT((vertices[v] - kTetrahedron[v] - Vec3(static_cast<double>(k) / 6.0, 0, 0)).norm(),
                      1e-12);
    }
    file.request.first = 2;
    file.request.last = 4;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 1.0 / 24.0, 2.0 / 24.0));
    EXPECT_EQ(file.open()->describe(0), file.request.path + ": sample 2, at 0.583333 s");
    file.open()->read(1, vertices);
    EXPECT_NEAR(vertices[0].x(), 0.5, 1e-12);
    file.request.last = 7;
    EXPECT_THAT(file.refusal(), HasSubstr("has no sample 7; allowed: 0 to 6"));
}

TEST(GltfCache, TheLastKeyIsASampleAlsoBetweenFrames)
{
    Written file(moved_between(0.0F, 0.25F).glb());
    file.request.frames_per_second = 10.0;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 0.1, 0.2, 0.25));
    file.request.first = 3;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0));
    // 2.3 in single precision is at frame 23.
    Written rounded(moved_between(0.1F, 2.3F).glb());
    rounded.request.frames_per_second = 10.0;
    EXPECT_EQ(rounded.open()->times().size(), 23U);
    EXPECT_EQ(rounded.open()->times().back(), 2.2);
    // One key holds a pose.
    GltfBuilder still = make_bent_tetrahedron();
    still.json.erase("animations");
    still.animate(0, "translation", {3}, {5, 0, 0});
    EXPECT_THAT(Written(still.glb()).open()->times(), ElementsAre(0.0));
}

TEST(GltfCache, ErrorsBeginWithTheFile)
{
    const GltfBuilder sound = moved_between(0.0F, 1.0F);
    EXPECT_THAT(Written(sound.glb(), 5).refusal(), HasSubstr("shows 4 vertices; allowed: 5"));
    EXPECT_THAT(Written(moved_between(0.0F, 1e30F).glb()).refusal(), HasSubstr("allowed: fewer than 1e+06"));
    const std::string whole = sound.glb();
    for (std::size_t length = 0; length < whole.size(); length += 7)
        EXPECT_NE(Written(whole.substr(0, length)).refusal(), "") << length;
    GltfBuilder packed = sound;
    packed.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}};
    EXPECT_THAT(Written(packed.glb()).refusal(), AllOf(HasSubstr("compressed"), HasSubstr("allowed: ")));
    GltfBuilder odd = sound;
    odd.json["nodes"] = "none";
    EXPECT_NE(Written(odd.glb()).refusal(), "");
    Written missing(whole);
    missing.request.path = missing.dir / "b.glb";
    EXPECT_THAT(missing.refusal(), HasSubstr("no such file"));
}

// scripts/moving_meshes describes the figure: limbs of a skeleton that swing at their tops and bend at their
// middles, with two joints each, and parts that only move with it.

constexpr double kRate = 24.0;

double time_of(std::size_t frame)
{
    return static_cast<double>(frame) / kRate;
}

double smooth(double x)
{
    x = std::clamp(x, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

struct Limb {
    int side;
    bool is_leg;
    Vec3 top, middle;
    double bottom;  // height

    double strength(double time) const { return smooth((time - 0.25) / 0.75); }
    double phase(double time) const { return 2.0 * std::numbers::pi * 0.9 * (time - 0.25); }
    double swing(double time) const
    {
        return strength(time) * (is_leg ? 0.42 : -0.45) * side * std::sin(phase(time));
    }
    double bend(double time) const
    {
        if (!is_leg) return strength(time) * 0.35;
        return -strength(time) * 0.5 * std::pow(std::max(0.0, side * std::cos(phase(time))), 2.0);
    }
    Eigen::Quaterniond spread() const
    {
        return Eigen::Quaterniond(Eigen::AngleAxisd((is_leg ? 0.02 : 0.16) * side, Vec3::UnitX()));
    }
    double weight(const Vec3& p) const
    {
        const Vec3 upright = top + spread().conjugate() * (p - top);
        const double length = top.z() - bottom;
        const double along = std::clamp((top.z() - upright.z()) / length, 0.0, 1.0);
        return smooth((along - (top.z() - middle.z()) / length) / 0.2 + 0.5);
    }
};

/// A turn about y that moves what hangs forward, along x.
Eigen::Quaterniond turn(double angle)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(-angle, Vec3::UnitY()));
}

std::vector<Limb> figure_limbs()
{
    std::vector<Limb> limbs;
    for (const int side : {1, -1}) {
        limbs.push_back({side, true, {0, 0.09 * side, 0.88}, {0, 0.09 * side, 0.48}, 0.08});
        limbs.push_back({side, false, {0, 0.21 * side, 1.38}, {0, 0.21 * side, 1.1}, 0.84});
    }
    return limbs;
}

void append(std::vector<float>& numbers, const Eigen::Quaterniond& q)
{
    for (const double c : {q.x(), q.y(), q.z(), q.w()}) numbers.push_back(static_cast<float>(c));
}

void append(std::vector<float>& numbers, const Vec3& v)
{
    for (const double c : v) numbers.push_back(static_cast<float>(c));
}

/// The figure in the pose of its first sample, with a skin of nine joints and its walk.
GltfBuilder make_walking_figure(const std::vector<Vec3>& points, std::size_t frames)
{
    constexpr std::size_t kLimbPoints = 206;
    const std::vector<Limb> limbs = figure_limbs();
    GltfBuilder file;
    std::vector<float> times, ways, inverse(16, 0.0F);
    double way = 0.0;
    for (std::size_t k = 0; k < frames; ++k) {
        const double time = time_of(k);
        if (k > 0) way += 1.1 * limbs[0].strength(time - 0.5 / kRate) / kRate;
        times.push_back(static_cast<float>(time));
        append(ways, {way, 0, 0.015 * limbs[0].strength(time) * std::cos(2.0 * limbs[0].phase(time))});
    }
    const std::size_t root = file.add("nodes", {{"children", nlohmann::json::array()}});
    nlohmann::json joints = {root};
    for (int k = 0; k < 4; ++k) inverse[5 * k] = 1.0F;
    for (const Limb& limb : limbs) {
        const Vec3 bone = limb.middle - limb.top;
        const std::size_t top =
            file.add("nodes", {{"translation", {limb.top.x(), limb.top.y(), limb.top.z()}}});
        const std::size_t bend = file.add("nodes", {{"translation", {bone.x(), bone.y(), bone.z()}}});
        file.json["nodes"][top]["children"] = {bend};
        file.json["nodes"][root]["children"].push_back(top);
        joints.push_back(top);
        joints.push_back(bend);
        for (const Vec3& at : {Vec3(Vec3::Zero()), bone}) {
            Eigen::Isometry3d bind =
                Eigen::Translation3d(limb.top) * limb.spread() * Eigen::Translation3d(at);
            const Eigen::Matrix4f matrix = bind.inverse().matrix().cast<float>();
            inverse.insert(inverse.end(), matrix.data(), matrix.data() + 16);
        }
        std::vector<float> swings, bends;
        for (std::size_t k = 0; k < frames; ++k) {
            append(swings, limb.spread() * turn(limb.swing(time_of(k))));
            append(bends, turn(limb.bend(time_of(k))));
        }
        file.animate(top, "rotation", times, swings);
        file.animate(bend, "rotation", times, bends);
    }
    file.animate(root, "translation", times, ways);

    std::vector<std::uint8_t> names;
    std::vector<float> weights;
    for (std::size_t v = 0; v < points.size(); ++v) {
        const std::size_t limb = v / kLimbPoints;
        const bool is_limb = limb < limbs.size();
        const double weight = is_limb ? limbs[limb].weight(points[v]) : 0.0;
        const auto first = static_cast<std::uint8_t>(is_limb ? 1 + 2 * limb : 0);
        names.insert(names.end(), {first, static_cast<std::uint8_t>(is_limb ? first + 1 : 0), 0, 0});
        weights.insert(weights.end(), {static_cast<float>(1.0 - weight), static_cast<float>(weight), 0, 0});
    }
    const std::size_t mesh = file.add_mesh(
        points, {0, 1, 2},
        {{"JOINTS_0", file.add_numbers("VEC4", names)}, {"WEIGHTS_0", file.add_numbers("VEC4", weights)}});
    file.add("skins", {{"joints", joints}, {"inverseBindMatrices", file.add_numbers("MAT4", inverse)}});
    file.show(root);
    file.show(file.add("nodes", {{"mesh", mesh}, {"skin", 0}}));
    return file;
}

// The cache has single precision (6e-8 of 3 m), the mesh seven digits, and skin and animation single
// precision.
TEST(GltfCache, AWalkingFigureIsThatOfItsPointCache)
{
    VertexCacheRequest request;
    request.path = ARRIS_SOURCE_DIR "/data/meshes/figure.pc2";
    std::vector<Vec3> points;
    for (const ObjVertex& vertex : read_obj(read_bytes(ARRIS_SOURCE_DIR "/data/meshes/figure.obj")).vertices)
        points.push_back(vertex.place);
    request.vertex_count = static_cast<int>(points.size());
    ASSERT_EQ(points.size(), 1374U);
    const auto expected = open_vertex_cache(request);
    const std::size_t frames = expected->times().size();
    const Written file(make_walking_figure(points, frames).glb(), request.vertex_count);
    const auto found = file.open();
    ASSERT_EQ(found->times(), expected->times());
    std::vector<Vec3> a, b;
    double most = 0.0;
    for (std::size_t k = 0; k < frames; ++k) {
        expected->read(k, a);
        found->read(k, b);
        for (std::size_t v = 0; v < points.size(); ++v) most = std::max(most, (a[v] - b[v]).norm());
    }
    EXPECT_LT(most, 1e-6);
    EXPECT_GT((a[0] - points[0]).norm(), 1.0) << "the figure has not walked";
}

}  // namespace
}  // namespace arris
