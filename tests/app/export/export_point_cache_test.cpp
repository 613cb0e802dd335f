// SPDX-License-Identifier: GPL-3.0-or-later
//
// scripts/test_formats reads the caches again.
#include "app/export/export_point_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

FrameSource make_two_points()
{
    return {2, [](std::size_t i) {
                Frame frame;
                frame.world = {{1.0, -2.0, 0.5}, {static_cast<double>(i), 0.0, 0.0}};
                return frame;
            }};
}

TEST(ExportPointCache, BytesAreThoseOfTheFormats)
{
    const TemporaryDirectory dir;
    write_pc2(dir / "a.pc2", make_two_points());
    const std::string pc2 = read_bytes(dir / "a.pc2");
    ASSERT_EQ(pc2.size(), 32U + 2U * 24U);
    EXPECT_EQ(pc2.substr(0, 32),
              std::string("POINTCACHE2\0\1\0\0\0\2\0\0\0\0\0\0\0\0\0\x80\x3f\2\0\0\0", 32));
    EXPECT_EQ(pc2.substr(32, 12), std::string("\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f", 12));
    EXPECT_EQ(pc2.substr(68, 4), std::string("\0\0\x80\x3f", 4));

    write_mdd(dir / "a.mdd", make_two_points(), 2.0);
    const std::string mdd = read_bytes(dir / "a.mdd");
    ASSERT_EQ(mdd.size(), 16U + 2U * 24U);
    EXPECT_EQ(mdd.substr(0, 16), std::string("\0\0\0\2\0\0\0\2\0\0\0\0\x3f\0\0\0", 16));
    EXPECT_EQ(mdd.substr(16, 12), std::string("\x3f\x80\0\0\xc0\0\0\0\x3f\0\0\0", 12));
    EXPECT_EQ(mdd.substr(52, 4), std::string("\x3f\x80\0\0", 4));
}

TEST(ExportPointCache, RefusesAnotherMeshAndHugeNumbers)
{
    const TemporaryDirectory dir;
    FrameSource growing = make_two_points(), huge = make_two_points();
    growing.read = [](std::size_t i) {
        Frame frame;
        frame.world.resize(1 + i, Vec3::Zero());
        return frame;
    };
    huge.read = [](std::size_t) {
        Frame frame;
        frame.world = {{0.0, 1e39, 0.0}};
        return frame;
    };
    for (const char* path : {"a.pc2", "a.mdd"}) {
        const auto error_with = [&](const FrameSource& frames) {
            return error_of([&] {
                std::string(path) == "a.pc2" ? write_pc2(dir / path, frames)
                                             : write_mdd(dir / path, frames, 24.0);
            });
        };
        EXPECT_THAT(error_with(growing), AllOf(HasSubstr(path), HasSubstr("frame 1 has 2 vertices")));
        EXPECT_THAT(error_with(huge), AllOf(HasSubstr("vertex 0"), HasSubstr("beyond a float")));
    }
    EXPECT_EQ(dir.entry_count(), 0U);
}

}  // namespace
}  // namespace arris
