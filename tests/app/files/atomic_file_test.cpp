// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>

#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

std::string error_of(const std::string& path, const std::string& bytes)
{
    try {
        write_atomically(path, bytes);
    } catch (const std::system_error& error) {
        return error.what();
    }
    return "";
}

TEST(AtomicFile, IsNotThereUntilItIsCommitted)
{
    const TemporaryDirectory dir;
    AtomicFile file(dir / "a.txt");
    file.write(std::string(3 << 20, 'x'));  // more than is buffered
    EXPECT_FALSE(std::filesystem::exists(dir / "a.txt"));
    file.commit();
    EXPECT_EQ(read_bytes(dir / "a.txt"), std::string(3 << 20, 'x'));
    EXPECT_EQ(dir.entry_count(), 1U);
}

TEST(AtomicFile, LeavesTheOldContentsWithoutACommit)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.txt", "old");
    {
        AtomicFile file(dir / "a.txt");
        file.write("new");
    }
    EXPECT_EQ(read_bytes(dir / "a.txt"), "old");
    EXPECT_EQ(dir.entry_count(), 1U);
}

TEST(AtomicFile, OverwritesWhatAKilledProcessLeft)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.txt.tmp", "a longer text that a killed process left behind");
    write_atomically(dir / "a.txt", "new");
    EXPECT_EQ(read_bytes(dir / "a.txt"), "new");
    EXPECT_EQ(dir.entry_count(), 1U);
}

TEST(AtomicFile, RefusesATemporaryThatSomebodyIsWriting)
{
    const TemporaryDirectory dir;
    AtomicFile first(dir / "a.txt");
    first.write("first");
    EXPECT_THAT(error_of(dir / "a.txt", "second"), ::testing::HasSubstr("another process is writing"));
    first.commit();
    EXPECT_EQ(read_bytes(dir / "a.txt"), "first");
}

TEST(AtomicFile, NamesThePathAndTheReasonWhereTheDiskRefuses)
{
    const TemporaryDirectory dir;
    EXPECT_THAT(error_of(dir / "missing/a.txt", ""), ::testing::AllOf(::testing::HasSubstr("missing/a.txt"),
                                                                      ::testing::HasSubstr("No such file")));
    std::filesystem::create_directories(dir / "taken/inside");
    EXPECT_THAT(error_of(dir / "taken", "x"), ::testing::HasSubstr("taken"));
    EXPECT_FALSE(std::filesystem::exists(dir / "taken.tmp"));
}

TEST(AtomicFile, ReportsAFullDisk)
{
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    EXPECT_THROW(write_fully(full, "x", "/dev/full"), std::system_error);
    close(full);
}

}  // namespace
}  // namespace arris
