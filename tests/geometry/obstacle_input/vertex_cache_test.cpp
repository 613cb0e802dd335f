// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/vertex_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "geometry/input_error.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"
#include "tests/geometry/cache_files.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using cache_files::mdd;
using cache_files::pc2;
using Samples = cache_files::Samples;

const Samples kSamples = {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0.5, 1}}, {{-2, 0, 1}, {1, 1e-3, 3}}};

struct Written {
    TemporaryDirectory dir;
    VertexCacheRequest request;

    Written(const std::string& name, const std::string& bytes)
    {
        request.path = dir / name;
        request.vertex_count = 2;
        write_bytes(request.path, bytes);
    }
    std::unique_ptr<VertexCache> open() const { return open_vertex_cache(request); }
    std::string refusal() const
    {
        const std::string error = error_of([&] { open(); });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        EXPECT_THAT(error, HasSubstr(request.path));
        return error;
    }
};

void expect_samples(VertexCache& cache, const Samples& expected)
{
    ASSERT_EQ(cache.times().size(), expected.size());
    std::vector<Vec3> vertices;
    for (std::size_t k = expected.size(); k-- > 0;) {  // in any order
        cache.read(k, vertices);
        ASSERT_EQ(vertices.size(), expected[k].size());
        for (std::size_t v = 0; v < vertices.size(); ++v)
            EXPECT_LT((vertices[v] - expected[k][v]).norm(), 1e-9) << k << ", " << v;
    }
}

TEST(VertexCache, MddIsBigEndianWithTimes)
{
    const Written file("a.mdd", mdd(kSamples, {0.0F, 0.25F, 1.0F}));
    const auto cache = file.open();
    expect_samples(*cache, kSamples);
    EXPECT_TRUE(cache->is_single());
    EXPECT_THAT(cache->times(), ElementsAre(0.0, 0.25, 1.0));
    EXPECT_EQ(cache->describe(2), file.request.path + ": sample 2");
}

TEST(VertexCache, Pc2IsLittleEndianWithFramesFromSampleToSample)
{
    Written file("a.PC2", pc2(kSamples, 0.5F));
    const auto cache = file.open();
    expect_samples(*cache, kSamples);
    EXPECT_THAT(cache->times(), ElementsAre(0.0, 0.5 / 24.0, 1.0 / 24.0));
    file.request.frames_per_second = 50.0;
    EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 0.01, 0.02));
}

TEST(VertexCache, ASequenceNeedsEachNumberOnce)
{
    Written file("b_7.obj", "v 0 0 0.1\nv 1 2 3\n");
    for (const char* name : {"b_8.obj", "b_9.obj", "b_10.obj"})
        write_bytes(file.dir / name, "v 0 0 1\nv 4 5 6\n");
    for (const char* other : {"b_011.obj", "b_-12.obj", "b_12.obj.bak", "b_.obj", "c_11.obj"})
        write_bytes(file.dir / other, "");
    file.request.path = file.dir / "b_%d.obj";
    const auto cache = file.open();
    expect_samples(
        *cache,
        {{{0, 0, 0.1}, {1, 2, 3}}, {{0, 0, 1}, {4, 5, 6}}, {{0, 0, 1}, {4, 5, 6}}, {{0, 0, 1}, {4, 5, 6}}});
    EXPECT_FALSE(cache->is_single());
    EXPECT_EQ(cache->times()[3], 3.0 / 24.0);
    EXPECT_EQ(cache->describe(3), file.dir / "b_10.obj");
    EXPECT_THAT(list_cache_files(file.request.path),
                ElementsAre(file.dir / "b_7.obj", file.dir / "b_8.obj", file.dir / "b_9.obj",
                            file.dir / "b_10.obj"));
    EXPECT_THAT(list_cache_files("no/body.mdd"), ElementsAre("no/body.mdd"));
    EXPECT_TRUE(list_cache_files("no/body_%d.obj").empty());

    file.request.first = 8;
    file.request.last = 9;
    EXPECT_EQ(file.open()->times().size(), 2U);
    EXPECT_EQ(file.open()->describe(0), file.dir / "b_8.obj");
    file.request.last = 11;
    EXPECT_THAT(file.refusal(), HasSubstr("b_11.obj is missing"));
    file.request.first.reset();
    file.request.last.reset();
    std::filesystem::remove(file.dir / "b_9.obj");
    EXPECT_THAT(file.refusal(),
                HasSubstr("b_9.obj is missing; allowed: a file for each number from 7 to 10"));
    file.request.path = file.dir / "d_%d.obj";
    EXPECT_THAT(file.refusal(), HasSubstr("no file has such a name, for example d_1.obj"));
    for (const char* pattern :
         {"b_%s.obj", "b_%4d.obj", "b_%d_%d.obj", "b_%00d.obj", "b_%12d.obj", "b_7.obj"}) {
        file.request.path = file.dir / pattern;
        EXPECT_THAT(file.refusal(), HasSubstr("allowed: one %d, or %04d")) << pattern;
    }
}

TEST(VertexCache, ASequenceWithZerosInFront)
{
    Written file("b_0998.obj", "v 0 0 1\nv 1 0 0\n");
    for (const char* name : {"b_0999.obj", "b_1000.obj"}) write_bytes(file.dir / name, "v 0 0 1\nv 1 0 0\n");
    write_bytes(file.dir / "b_998.obj", "");
    file.request.path = file.dir / "b_%04d.obj";
    EXPECT_EQ(file.open()->times().size(), 3U);
    EXPECT_EQ(file.open()->describe(0), file.dir / "b_0998.obj");
}

TEST(VertexCache, DamagedObjFilesOfASequenceAreNamed)
{
    Written file("b_1.obj", "v 0 0 1\n");
    file.request.path = file.dir / "b_%d.obj";
    std::vector<Vec3> vertices;
    const auto refusal = [&] { return error_of([&] { file.open()->read(0, vertices); }); };
    EXPECT_EQ(refusal(), file.dir / "b_1.obj: has 1 vertex ('v'); allowed: 2, as in the obstacle's file");
    write_bytes(file.dir / "b_1.obj", "v 0 0 1\nv 1 2\n");
    EXPECT_THAT(refusal(), HasSubstr(file.dir / "b_1.obj: line 2: "));
}

TEST(VertexCache, PartsOfAFileBeginAtTheFirstSampleUsed)
{
    Written file("a.mdd", mdd(kSamples, {1.0F, 1.25F, 2.0F}));
    file.request.first = 1;
    const auto cache = file.open();
    EXPECT_THAT(cache->times(), ElementsAre(0.0, 0.75));
    EXPECT_THAT(cache->describe(0), HasSubstr("sample 1"));
    std::vector<Vec3> vertices;
    cache->read(0, vertices);
    EXPECT_EQ(vertices[1], Vec3(1, 0.5, 1));
    file.request.last = 1;
    EXPECT_EQ(file.open()->times().size(), 1U);
    file.request.last = 0;
    EXPECT_THAT(file.refusal(), HasSubstr("last = 0 is before first = 1"));
    file.request.last = 3;
    EXPECT_THAT(file.refusal(), HasSubstr("has no sample 3; allowed: 0 to 2"));
}

TEST(VertexCache, TimesOfFramesAreThoseOfTheOutput)
{
    for (const double rate : {24.0, 25.0, 30.0, 60.0, 120.0}) {
        std::vector<float> times;
        Samples samples;
        for (int k = 0; k < 500; ++k) {
            times.push_back(static_cast<float>((k + 7) / rate));
            samples.push_back({{0, 0, 0}, {1, 0, 0}});
        }
        const Written file("a.mdd", mdd(samples, times));
        const auto cache = file.open();
        for (int k = 0; k < 500; ++k) EXPECT_EQ(cache->times()[k], k / rate) << rate;
    }
    // Other times stay.
    const Written file("a.mdd", mdd(kSamples, {0.0F, 0.04F, 0.081F}));
    EXPECT_EQ(file.open()->times()[2], static_cast<double>(0.081F));
}

TEST(VertexCache, TimesMustAscendUnlessARateReplacesThem)
{
    for (const std::vector<float>& times : {std::vector<float>{0.0F, 0.0F, 0.1F},
                                            {0.0F, 0.2F, 0.1F},
                                            {0.0F, NAN, 1.0F},
                                            {0.0F, INFINITY, 1.0F}}) {
        Written file("a.mdd", mdd(kSamples, times));
        EXPECT_THAT(file.refusal(), HasSubstr("allowed: times that ascend"));
        file.request.frames_per_second = 10.0;
        EXPECT_THAT(file.open()->times(), ElementsAre(0.0, 0.1, 0.2));
    }
}

TEST(VertexCache, LengthsMustFitTheCounts)
{
    for (const std::string& name : {std::string("a.mdd"), std::string("a.pc2")}) {
        const std::string whole = name == "a.mdd" ? mdd(kSamples, {0.0F, 1.0F, 2.0F}) : pc2(kSamples, 1.0F);
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const Written file(name, whole.substr(0, length));
            EXPECT_NE(file.refusal(), "") << length;
        }
        EXPECT_THAT(Written(name, whole.substr(0, whole.size() - 1)).refusal(), HasSubstr("truncated"));
        EXPECT_THAT(Written(name, whole + "x").refusal(), HasSubstr("more than"));
        EXPECT_THAT(Written(name, whole + std::string(24, 'x')).refusal(), HasSubstr("more than"));
        EXPECT_THAT(Written(name, whole + std::string(28, 'x')).refusal(), HasSubstr("more than"));
    }
}

TEST(VertexCache, CountsAreCheckedBeforeAnythingIsAllocated)
{
    const auto with_word = [](std::string bytes, std::size_t at, const char* word) {
        return bytes.replace(at, 4, std::string(word, 4));
    };
    const std::string m = mdd(kSamples, {0.0F, 1.0F, 2.0F}), p = pc2(kSamples, 1.0F);
    for (const char* word :
         {"\x7f\xff\xff\xff", "\xff\xff\xff\xff", "\x00\x00\x00\x00", "\x80\x00\x00\x00"}) {
        for (const std::size_t at : {0, 4}) EXPECT_NE(Written("a.mdd", with_word(m, at, word)).refusal(), "");
        for (const std::size_t at : {16, 28})
            EXPECT_NE(Written("a.pc2", with_word(p, at, word)).refusal(), "");
    }
    EXPECT_THAT(Written("a.pc2", with_word(p, 12, "\x02\0\0\0")).refusal(),
                HasSubstr("version 2; allowed: 1"));
    EXPECT_THAT(Written("a.pc2", with_word(p, 24, "\0\0\0\0")).refusal(),
                HasSubstr("frames from sample to sample"));
    EXPECT_THAT(Written("a.pc2", with_word(p, 24, "\0\0\xc0\x7f")).refusal(),
                HasSubstr("frames from sample"));
}

TEST(VertexCache, AnotherByteOrderIsRefused)
{
    EXPECT_THAT(Written("a.mdd", mdd(kSamples, {0.0F, 1.0F, 2.0F}, std::endian::little)).refusal(),
                HasSubstr("fewer than"));
    EXPECT_NE(Written("a.pc2", pc2(kSamples, 1.0F, std::endian::big)).refusal(), "");
}

TEST(VertexCache, OtherFilesAndCountsAreRefused)
{
    EXPECT_NE(Written("a.mdd", "").refusal(), "");
    EXPECT_NE(Written("a.pc2", "").refusal(), "");
    EXPECT_THAT(Written("a.pc2", std::string(100, 'x')).refusal(), HasSubstr("is not a PC2 file"));
    EXPECT_THAT(Written("a.abc", "").refusal(), HasSubstr("allowed: .mdd, .pc2, .usda, .gltf, .glb, or .obj"));
    EXPECT_THAT(Written("a.mdd", mdd({}, {})).refusal(), HasSubstr("holds 0 samples; allowed: at least 1"));

    Written file("a.mdd", mdd(kSamples, {0.0F, 1.0F, 2.0F}));
    file.request.vertex_count = 3;
    EXPECT_THAT(file.refusal(), HasSubstr("has 2 vertices in each sample; allowed: 3"));
    file.request.path = file.dir / "b.mdd";
    EXPECT_THAT(file.refusal(), HasSubstr("no such file"));
    file.request.path = file.dir / "folder.mdd";
    std::filesystem::create_directory(file.request.path);
    EXPECT_THAT(file.refusal(), HasSubstr("not a regular file"));
    file.request.path = file.dir / "pipe.mdd";
    ASSERT_EQ(::mkfifo(file.request.path.c_str(), 0600), 0);
    EXPECT_THAT(file.refusal(), HasSubstr("not a regular file"));
}

TEST(VertexCache, AFileThatShrinksWhileItIsReadIsAnError)
{
    const Written file("a.mdd", mdd(kSamples, {0.0F, 1.0F, 2.0F}));
    const auto cache = file.open();
    std::filesystem::resize_file(file.request.path, 60);
    std::vector<Vec3> vertices;
    EXPECT_THAT(error_of([&] { cache->read(2, vertices); }), HasSubstr("has become shorter"));
}

}  // namespace
}  // namespace arris
