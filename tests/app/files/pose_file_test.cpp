// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <limits>

#include "app/files/binary_stream.h"
#include "geometry/input_error.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

const std::vector<std::vector<Vec3>> kSamples = {
    {{0.1, 0.2, 0.3}, {1, 2, 3}}, {{-0.1, 0.2, 1e-7}, {1, 2, 4}}, {{5, 6, 7}, {1, 2, 5}}};

std::shared_ptr<const PoseFile> write(PoseFileHead head,
                                      const std::vector<std::vector<Vec3>>& samples = kSamples)
{
    PoseFileWriter writer(std::move(head));
    for (const std::vector<Vec3>& sample : samples) writer.add(sample);
    return writer.finish();
}

PoseFileHead head()
{
    return {{-0.5, 0.25, 0.75}, 2, false, PoseInterpolation::Linear};
}

TEST(PoseFile, DoublesReadBackToTheLastBit)
{
    const TemporaryDirectory dir;
    const auto temporary = write(head());
    temporary->copy_to(dir / "a.poses");
    const auto copy = PoseFile::open(dir / "a.poses");
    EXPECT_EQ(std::filesystem::file_size(dir / "a.poses"), copy->size());
    for (const auto& file : {temporary, copy}) {
        EXPECT_EQ(file->times(), head().times);
        EXPECT_EQ(file->point_count(), 2U);
        EXPECT_EQ(file->head().interpolation, PoseInterpolation::Linear);
        std::vector<Vec3> points;
        for (const std::size_t k : {2, 0, 1}) {
            file->read(k, points);
            EXPECT_EQ(points, kSamples[k]);
        }
    }
}

TEST(PoseFile, SinglePrecisionTakesHalfTheBytesAndRoundsOnce)
{
    const TemporaryDirectory dir;
    PoseFileHead single = head();
    single.is_single = true;
    const auto file = write(single);
    std::vector<Vec3> points;
    file->read(1, points);
    EXPECT_EQ(points[0].x(), static_cast<double>(-0.1F));
    EXPECT_EQ(write(head())->size() - file->size(), 3U * 2U * 3U * 4U);
}

TEST(PoseFile, ACopyReplacesAFileAndLeavesItsReadersTheirs)
{
    const TemporaryDirectory dir;
    write(head())->copy_to(dir / "a.poses");
    const auto first = PoseFile::open(dir / "a.poses");
    std::vector<std::vector<Vec3>> others = kSamples;
    others[0][0].x() = 9.0;
    write(head(), others)->copy_to(dir / "a.poses");
    std::vector<Vec3> points;
    first->read(0, points);
    EXPECT_EQ(points, kSamples[0]);
    PoseFile::open(dir / "a.poses")->read(0, points);
    EXPECT_EQ(points, others[0]);
    EXPECT_EQ(dir.entry_count(), 1U);
}

TEST(PoseFile, EveryTruncationAndEveryFlippedByteIsOneInputError)
{
    const TemporaryDirectory dir;
    const std::string path = dir / "a.poses";
    write(head())->copy_to(path);
    const std::string whole = read_bytes(path);
    const auto refusal = [&] { return error_of([&] { PoseFile::open(path); }); };
    EXPECT_EQ(refusal(), "");
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write_bytes(path, whole.substr(0, length));
        EXPECT_THAT(refusal(), HasSubstr(path)) << length;
    }
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string damaged = whole;
        damaged[k] = static_cast<char>(damaged[k] ^ 0x81);
        write_bytes(path, damaged);
        EXPECT_THAT(refusal(), HasSubstr(path)) << k;
    }
    write_bytes(path, whole + "x");
    EXPECT_THAT(refusal(), HasSubstr("length"));
    std::filesystem::remove(path);
    EXPECT_THAT(refusal(), HasSubstr("is missing"));
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    EXPECT_THAT(refusal(), HasSubstr("is not a file of poses"));
}

TEST(PoseFile, SoundChecksumsDoNotMakeSoundValues)
{
    const TemporaryDirectory dir;
    const std::string path = dir / "a.poses";
    const auto refusal = [&](const PoseFileHead& wrong, const std::vector<std::vector<Vec3>>& samples) {
        return error_of([&] {
            write(wrong, samples)->copy_to(path);
            PoseFile::open(path);
        });
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    PoseFileHead wrong = head();
    wrong.times[1] = -0.5;
    EXPECT_THAT(refusal(wrong, kSamples), HasSubstr("times are invalid"));
    wrong.times[1] = std::nextafter(wrong.times[0], 1.0);
    EXPECT_THAT(refusal(wrong, kSamples), HasSubstr("times are invalid"));
    wrong.times[1] = kNan;
    EXPECT_THAT(refusal(wrong, kSamples), HasSubstr("times are invalid"));
    for (const double c : {kNan, std::numeric_limits<double>::infinity(), 2e6}) {
        std::vector<std::vector<Vec3>> samples = kSamples;
        samples[1][1].z() = c;
        EXPECT_THAT(refusal(head(), samples), HasSubstr("sample 1 has a place beyond 1e+06 m"));
    }
    EXPECT_THAT(refusal(head(), {kSamples[0], kSamples[1]}), HasSubstr("length"));
}

TEST(PoseFile, HugeCountsAreRefusedBeforeTheyAreAllocated)
{
    const TemporaryDirectory dir;
    const std::string path = dir / "a.poses";
    write(head())->copy_to(path);
    const std::string whole = read_bytes(path);
    const std::size_t begin = std::string("ARRIS poses\n").size() + 8 + std::string("poses 1").size() + 8;
    for (const std::size_t at : {std::size_t{0}, std::size_t{10}})  // points, times
        for (const std::uint64_t count : {~std::uint64_t{0}, std::uint64_t{1} << 60, std::uint64_t{0}}) {
            std::string damaged = whole;
            std::memcpy(damaged.data() + begin + at, &count, sizeof count);
            const std::uint32_t sum = checksum(std::string_view(damaged).substr(begin, 18 + 24));
            std::memcpy(damaged.data() + begin + 18 + 24, &sum, sizeof sum);
            write_bytes(path, damaged);
            EXPECT_THAT(error_of([&] { PoseFile::open(path); }), HasSubstr("damaged")) << at << ", " << count;
        }
}

}  // namespace
}  // namespace arris
