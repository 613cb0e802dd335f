// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/input_error.h"
#include "tests/app/example_frame.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Bits, not values: -0 must stay -0.
template <class T>
std::string bits(const std::vector<T>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

void expect_same_bits(const Frame& a, const Frame& b)
{
    EXPECT_EQ(bits(a.world), bits(b.world));
    EXPECT_EQ(bits(a.material), bits(b.material));
    EXPECT_EQ(bits(a.vertex_velocity), bits(b.vertex_velocity));
    EXPECT_EQ(bits(a.material_velocity), bits(b.material_velocity));
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(a.eol, b.eol);
    EXPECT_EQ(a.contact, b.contact);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(bits(a.strain), bits(b.strain));
    EXPECT_EQ(bits(a.stretch_energy), bits(b.stretch_energy));
    EXPECT_EQ(bits(a.bending_energy), bits(b.bending_energy));
    EXPECT_EQ(a.eol_edges, b.eol_edges);
    ASSERT_EQ(a.pieces.size(), b.pieces.size());
    for (std::size_t p = 0; p < a.pieces.size(); ++p) {
        EXPECT_EQ(a.pieces[p].name, b.pieces[p].name);
        EXPECT_EQ(a.pieces[p].shift, b.pieces[p].shift);
        EXPECT_EQ(a.pieces[p].begin, b.pieces[p].begin);
    }
}

/// The error that reading these bytes as a frame gives; empty if none.
std::string error_of(const std::string& bytes)
{
    // One file for thousands of calls: a directory for each would take most of the time.
    const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "_cloth_00000.ply";
    write_bytes(path, bytes);
    std::string message;
    try {
        read_frame(path);
    } catch (const InputError& error) {
        message = error.what();
        EXPECT_THAT(message, HasSubstr("cloth_00000.ply: "));
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    std::filesystem::remove(path);
    return message;
}

std::string example_bytes()
{
    const TemporaryDirectory dir;
    write_frame(dir / "a.ply", make_example_frame());
    return read_bytes(dir / "a.ply");
}

std::string replaced(std::string bytes, const std::string& from, const std::string& to)
{
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return bytes.replace(at, from.size(), to);
}

std::size_t body_offset(const std::string& bytes)
{
    return bytes.find("end_header\n") + 11;
}

constexpr std::size_t kVertexBytes = 94, kFaceBytes = 37;  // as the format's table says

template <class T>
std::string patched(std::string bytes, std::size_t offset_in_body, T value)
{
    std::memcpy(bytes.data() + body_offset(bytes) + offset_in_body, &value, sizeof value);
    return bytes;
}

TEST(Frame, ReadsBackBitForBit)
{
    const TemporaryDirectory dir;
    write_frame(dir / "a.ply", make_example_frame());
    expect_same_bits(read_frame(dir / "a.ply"), make_example_frame());
    EXPECT_EQ(dir.entry_count(), 1U);
}

/// Two triangles that are a piece each, of which the second one is where u is above 0.5.
Frame make_two_pieces()
{
    Frame frame = make_example_frame();
    frame.material = {{0, 0}, {0.25, 0}, {1, 0.5}, {2, 0.125}};
    frame.faces = {{0, 1, 2}, {2, 1, 3}};
    frame.faces[1] = {2, 3, 1};
    frame.pieces = {{"front"}, {"back", 0.1, 0.5}};
    return frame;
}

TEST(Frame, ReadsBackItsPieces)
{
    const TemporaryDirectory dir;
    write_frame(dir / "a.ply", make_two_pieces());
    const std::string bytes = read_bytes(dir / "a.ply");
    EXPECT_THAT(bytes,
                HasSubstr("comment piece front 0 -inf\ncomment piece back 0.1 0.5\nelement vertex 4\n"));
    EXPECT_THAT(bytes, HasSubstr("property double bending_energy\nproperty int piece\nelement edge"));
    const Frame read = read_frame(dir / "a.ply");
    expect_same_bits(read, make_two_pieces());
    EXPECT_EQ(read.piece_of(read.faces[0]), 0);
    EXPECT_EQ(read.piece_of(read.faces[1]), 1);
    EXPECT_EQ(read.faces_of(1), std::vector<int>{1});
    EXPECT_EQ(read.own_material(), (std::vector<Vec2>{{0, 0}, {0.25, 0}, {0.9, 0.5}, {1.9, 0.125}}));
    for (const char* wrong :
         {"comment piece front 0 -in7", "comment piece front 7 8    ", "comment pie   front 0 -inf"})
        EXPECT_NE(error_of(replaced(bytes, "comment piece front 0 -inf", wrong)), "") << wrong;
    EXPECT_NE(error_of(replaced(bytes, "back 0.1 0.5", "back nan 0.5")), "");
    EXPECT_NE(error_of(replaced(bytes, "back 0.1 0.5", "back 0.1 5.5")), "") << "no face is there";
    for (std::size_t n = 0; n < bytes.size(); n += 7) EXPECT_NE(error_of(bytes.substr(0, n)), "") << n;
}

TEST(Frame, ReadsBackItsSeams)
{
    // The example's two triangles, with a point of its own in the second one for vertices 1 and 2.
    Frame sewn = make_two_pieces();
    sewn.material = {{0, 0}, {0.25, 0}, {0.25, 0.5}, {2, 0.125}, {1.5, 0}, {1.5, 0.5}};
    sewn.face_points = {{0, 1, 2}, {5, 3, 4}};
    sewn.seam_vertices = {1, 2};
    const TemporaryDirectory dir;
    write_frame(dir / "a.ply", sewn);
    const std::string bytes = read_bytes(dir / "a.ply");
    EXPECT_THAT(bytes, HasSubstr("property int piece\nproperty list uchar int point_indices\nelement edge"));
    EXPECT_THAT(bytes, HasSubstr("element point 2\nproperty double u\nproperty double v\n"
                                 "property int vertex\nend_header\n"));
    const Frame read = read_frame(dir / "a.ply");
    expect_same_bits(read, sewn);
    EXPECT_EQ(read.face_points, sewn.face_points);
    EXPECT_EQ(read.seam_vertices, sewn.seam_vertices);
    EXPECT_EQ(read.faces_of(1), std::vector<int>{1});
    const Frame split = split_seams(read);
    EXPECT_EQ(split.faces, sewn.face_points);
    EXPECT_EQ(split.world[4], sewn.world[1]);
    EXPECT_EQ(split.ids[5], sewn.ids[2]);
    for (std::size_t n = 0; n < bytes.size(); n += 5) EXPECT_NE(error_of(bytes.substr(0, n)), "") << n;
    for (std::size_t n = body_offset(bytes); n < bytes.size(); ++n) {  // no byte brings it down
        std::string broken = bytes;
        broken[n] = static_cast<char>(broken[n] ^ 0x55);
        error_of(broken);
    }
    Frame crossed = sewn;
    crossed.face_points[1] = {4, 3, 5};
    write_frame(dir / "b.ply", crossed);
    EXPECT_THAT(error_of(read_bytes(dir / "b.ply")), HasSubstr("face 1 has a point of another vertex"));
}

TEST(Frame, ReadsBackWhenEmpty)
{
    const TemporaryDirectory dir;
    write_frame(dir / "a.ply", Frame{});
    expect_same_bits(read_frame(dir / "a.ply"), Frame{});
}

TEST(Frame, HasTheElementsOfTheFormatsTableInTheirOrder)
{
    const std::string bytes = example_bytes();
    EXPECT_EQ(
        bytes.substr(0, body_offset(bytes)),
        "ply\nformat binary_little_endian 1.0\n"
        "comment Arris frame: m, m/s, J; v: of the vertex, w: of the material there\n"
        "element vertex 4\n"
        "property double x\nproperty double y\nproperty double z\nproperty double u\nproperty double v\n"
        "property double vx\nproperty double vy\nproperty double vz\n"
        "property double wx\nproperty double wy\nproperty double wz\n"
        "property uint id\nproperty uchar eol\nproperty uchar contact\n"
        "element face 2\nproperty list uchar int vertex_indices\n"
        "property double strain\nproperty double stretch_energy\nproperty double bending_energy\n"
        "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n");
    EXPECT_EQ(bytes.size(), body_offset(bytes) + 4 * kVertexBytes + 2 * kFaceBytes + 8);
}

TEST(Frame, KeepsTheEdgeElementWhenThereAreNone)
{
    const TemporaryDirectory dir;
    Frame frame = make_example_frame();
    frame.eol_edges.clear();
    write_frame(dir / "a.ply", frame);
    EXPECT_THAT(read_bytes(dir / "a.ply"), HasSubstr("element edge 0\n"));
    expect_same_bits(read_frame(dir / "a.ply"), frame);
}

TEST(Frame, RefusesEveryTruncation)
{
    const std::string bytes = example_bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_NE(error_of(bytes.substr(0, size)), "") << size;
    EXPECT_EQ(error_of(bytes), "");
    EXPECT_THAT(error_of(bytes + "x"), HasSubstr("implies"));
}

TEST(Frame, SurvivesEveryCorruptedByte)
{
    const std::string bytes = example_bytes();
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const char wrong : {'\xff', '9'}) {
            std::string corrupted = bytes;
            corrupted[i] = wrong;
            const bool is_header_changed = corrupted != bytes && i < body_offset(bytes);
            EXPECT_TRUE(!is_header_changed || error_of(corrupted) != "") << i;
            if (!is_header_changed)
                error_of(corrupted);  // a value may have become another; it must not crash
        }
}

TEST(Frame, AllocatesNothingForAHeaderThatLies)
{
    const std::string bytes = example_bytes();
    rusage before = {}, after = {};
    getrusage(RUSAGE_SELF, &before);
    for (const char* count : {"2000000000", "2147483647"})
        for (const char* element : {"vertex 4", "face 2", "edge 1"}) {
            const std::string name = std::string(element).substr(0, std::string(element).size() - 1);
            EXPECT_THAT(
                error_of(replaced(bytes, std::string("element ") + element, "element " + name + count)),
                HasSubstr("implies"));
        }
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024);  // KiB; the lies are of 16 GB and more
}

TEST(Frame, RefusesCountsThatMakeNoSense)
{
    const std::string bytes = example_bytes();
    for (const char* count : {"-4", "2147483648", "18446744073709551615", "99999999999999999999999", "four",
                              "", "4.0", "+4", "04", " 4", "4 "})
        EXPECT_THAT(error_of(replaced(bytes, "element vertex 4", std::string("element vertex ") + count)),
                    HasSubstr("not a frame"))
            << count;
    EXPECT_THAT(error_of(replaced(bytes, "element face 2", "element faces 2")), HasSubstr("face elements"));
}

TEST(Frame, RefusesWhatIsNotAFrame)
{
    const std::string bytes = example_bytes();
    EXPECT_THAT(error_of(""), HasSubstr("does not begin with \"ply\""));
    EXPECT_THAT(error_of("solid"), HasSubstr("does not begin with \"ply\""));
    EXPECT_THAT(error_of(replaced(bytes, "little", "big")), HasSubstr("header"));
    EXPECT_THAT(error_of(replaced(bytes, "property double x", "property float x")), HasSubstr("header"));
    EXPECT_THAT(error_of(replaced(bytes, "end_header\n", "end_header\r\n")), HasSubstr("header"));
    EXPECT_THAT(error_of("ply\n" + std::string(1 << 20, '\n')), HasSubstr("not a frame"));
}

TEST(Frame, RefusesMissingFilesAndDirectories)
{
    const TemporaryDirectory dir;
    EXPECT_THROW(read_frame(dir / "missing.ply"), InputError);
    EXPECT_THROW(read_frame(dir.path()), InputError);
    EXPECT_THROW(read_frame("/dev/null"), InputError);
}

TEST(Frame, NamesTheVertexWhoseValueIsNotFinite)
{
    const std::string bytes = example_bytes();
    for (std::size_t column = 0; column < 11; ++column)
        for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()})
            EXPECT_THAT(error_of(patched(bytes, 2 * kVertexBytes + 8 * column, value)),
                        AllOf(HasSubstr("vertex 2"), HasSubstr("not finite")));
    const std::size_t second_face = 4 * kVertexBytes + kFaceBytes;
    for (std::size_t column = 0; column < 3; ++column)
        EXPECT_THAT(error_of(patched(bytes, second_face + 13 + 8 * column, std::nan(""))),
                    AllOf(HasSubstr("face 1"), HasSubstr("not finite")));
}

TEST(Frame, NamesTheElementWhoseIndexIsOutOfRange)
{
    const std::string bytes = example_bytes();
    const std::size_t faces = 4 * kVertexBytes, edges = faces + 2 * kFaceBytes;
    for (const std::int32_t index : {4, -1, 2147483647, -2147483647 - 1}) {
        EXPECT_THAT(error_of(patched(bytes, faces + kFaceBytes + 1 + 4, index)),
                    AllOf(HasSubstr("face 1"), HasSubstr("of 4")));
        EXPECT_THAT(error_of(patched(bytes, edges + 4, index)),
                    AllOf(HasSubstr("edge 0"), HasSubstr("of 4")));
    }
    for (int corner = 0; corner < 3; ++corner)  // of face (0, 1, 2), made its successor
        EXPECT_THAT(
            error_of(patched(bytes, faces + 1 + 4 * static_cast<std::size_t>(corner), (corner + 1) % 3)),
            HasSubstr("face 0 repeats a vertex"));
    EXPECT_THAT(error_of(patched(bytes, edges, 2)), HasSubstr("edge 0 repeats a vertex"));
}

TEST(Frame, RefusesPolygonsAndUnknownFlags)
{
    const std::string bytes = example_bytes();
    EXPECT_THAT(error_of(patched(bytes, 4 * kVertexBytes, std::uint8_t{4})),
                HasSubstr("face 0 is not a triangle"));
    EXPECT_THAT(error_of(patched(bytes, 92, std::uint8_t{3})), HasSubstr("vertex 0"));
    EXPECT_THAT(error_of(patched(bytes, 93, std::uint8_t{2})), HasSubstr("vertex 0"));
}

}  // namespace
}  // namespace arris
