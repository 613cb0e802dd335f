// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/frame_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/input_error.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

TEST(FrameFiles, AreNumberedWithFiveDigitsOrMore)
{
    EXPECT_EQ(frame_file("out", 0, "ply"), "out/frames/cloth_00000.ply");
    EXPECT_EQ(frame_file("out", 99999, "obj"), "out/frames/cloth_99999.obj");
    EXPECT_EQ(frame_file("out", 100000, "ply"), "out/frames/cloth_100000.ply");
}

TEST(FrameFiles, AreCountedAmongOthers)
{
    const TemporaryDirectory dir;
    EXPECT_EQ(count_frames(dir.path()), 0);
    std::filesystem::create_directories(frames_directory(dir.path()));
    EXPECT_EQ(count_frames(dir.path()), 0);
    for (const char* other :
         {"cloth_00000.obj", "cloth_7.ply", "cloth_000001.ply", "cloth_.ply", "cloth_-0001.ply",
          "cloth_00003.ply.tmp", "cloth_99999999999999999999.ply", "table_00000.ply", "cloth_0000x.ply"})
        write_bytes(dir / ("frames/" + std::string(other)), "");
    EXPECT_EQ(count_frames(dir.path()), 0);
    for (int i = 0; i < 3; ++i) write_bytes(frame_file(dir.path(), i, "ply"), "");
    EXPECT_EQ(count_frames(dir.path()), 3);
}

TEST(FrameFiles, NamesTheFirstOneMissing)
{
    const TemporaryDirectory dir;
    std::filesystem::create_directories(frames_directory(dir.path()));
    for (const int i : {0, 1, 3, 100000}) write_bytes(frame_file(dir.path(), i, "ply"), "");
    try {
        count_frames(dir.path());
        FAIL() << "a gap was not noticed";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("cloth_00002.ply: is missing"));
    }
}

}  // namespace
}  // namespace arris
