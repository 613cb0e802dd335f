// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>

#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "tests/app/error_of.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

using Clock = std::chrono::steady_clock;

constexpr const char* kHelper = ARRIS_IMPORT_HELPER;

ObstacleMesh box()
{
    return samples::box(Vec3::Zero(), Vec3::Ones());
}

class ObstacleFileTest : public ::testing::Test {
  protected:
    ObstacleFileTest()
        : folder_(std::filesystem::path(::testing::TempDir()) /
                  (std::string("arris_obstacle_file_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~ObstacleFileTest() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const
    {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    static ObstacleFileRequest request_of(const std::string& path,
                                          std::vector<std::string> mode = {"import-obstacle"})
    {
        ObstacleFileRequest request;
        request.path = path;
        request.importer = std::move(mode);
        request.importer.insert(request.importer.begin(), kHelper);
        return request;
    }

    // The one-line error without the file's name, with which the error must begin.
    static std::string refusal(const ObstacleFileRequest& request)
    {
        const std::string error = error_of([&] { read_obstacle_file(request); });
        EXPECT_THAT(error, AllOf(StartsWith(request.path + ": "), Not(HasSubstr("\n"))));
        return error.substr(std::min(error.size(), request.path.size() + 2));
    }

    std::string refusal(const std::string& name, const std::string& bytes) const
    {
        return refusal(request_of(write(name, bytes)));
    }

    // The error for an importer process that behaves as the argument says.
    std::string fate_of(std::vector<std::string> mode,
                        std::chrono::milliseconds timeout = std::chrono::seconds(60))
    {
        ObstacleFileRequest request = request_of(write("box.obj", mesh_files::obj(box())), std::move(mode));
        request.timeout = timeout;
        return refusal(request);
    }

    std::filesystem::path folder_;
};

TEST_F(ObstacleFileTest, ReadsThroughAnotherProcess)
{
    ObstacleFileRequest request = request_of(write("box.stl", mesh_files::binary_stl(box())));
    request.metres_per_unit = 0.0254;
    request.up = 'y';
    const ObstacleFile file = read_obstacle_file(request);
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_EQ(file.mesh.points.size(), 8u);
    EXPECT_EQ(file.mesh.faces.size(), 12u);
    EXPECT_THAT(file.mesh.points, Contains(Vec3(0.0254, -0.0254, 0.0254)));
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_THAT(file.notes, ElementsAre(HasSubstr("welded 28 vertices")));
}

TEST_F(ObstacleFileTest, BringsWiresPointsAndNotes)
{
    const ObstacleFile file = read_obstacle_file(
        request_of(write("all.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\nf 1 2 3\nl 1 4\np 5\n")));
    EXPECT_EQ(file.mesh.faces, (std::vector<Face>{{0, 1, 2}}));
    EXPECT_EQ(file.mesh.segments, (std::vector<std::array<int, 2>>{{0, 3}}));
    EXPECT_EQ(file.mesh.lone_points, std::vector<int>{4});
    EXPECT_THAT(file.notes, ElementsAre("open: 3 border edges, two-sided"));
}

TEST_F(ObstacleFileTest, NamesThatLookLikeOptionsOrAreOddAreNames)
{
    for (const char* name :
         {"-.obj", "--help.obj", "a b.obj", "ü.obj", "%s%n.obj", "a\nb.obj", "'$(x)'.obj", "a?#.obj"}) {
        const ObstacleFile file = read_obstacle_file(request_of(write(name, mesh_files::obj(box()))));
        EXPECT_EQ(file.mesh.faces.size(), 12u) << name;
    }
}

TEST_F(ObstacleFileTest, RefusesRequestsThatCannotBe)
{
    ObstacleFileRequest request = request_of(write("box.obj", mesh_files::obj(box())));
    for (const double unit : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        request.metres_per_unit = unit;
        EXPECT_THAT(refusal(request), HasSubstr("must be positive"));
    }
    request.metres_per_unit = 1e-3;
    request.up = 'w';
    EXPECT_THAT(refusal(request), HasSubstr("must be x, y or z"));
}

// ----------------------------------------------------------------- broken files

std::string with_header_count(std::string bytes, std::size_t offset, std::uint32_t count)
{
    std::memcpy(bytes.data() + offset, &count, sizeof count);
    return bytes;
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string cut(const std::string& bytes, double share)
{
    return bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
}

TEST_F(ObstacleFileTest, BrokenFilesAreOneClearLine)
{
    struct Case {
        const char* name;
        std::string bytes;
        const char* says;
    };
    const ObstacleMesh m = box();
    ObstacleMesh beyond = m;
    beyond.faces[3][1] = 99;
    ObstacleMesh nan = m;
    nan.points[2].y() = std::nan("");
    const std::string obj = mesh_files::obj(m);
    const std::string stl = mesh_files::binary_stl(m);
    const std::string ascii_stl = mesh_files::ascii_stl(m);
    const std::string ply = mesh_files::binary_ply(m);
    const std::string ascii_ply = mesh_files::ascii_ply(m);
    const std::string glb = mesh_files::glb(m);
    const std::string dae = mesh_files::dae(m, "");
    const std::string fbx = mesh_files::fbx(m, 2, 100);
    const std::string three_ds = mesh_files::three_ds(m);
    const std::string three_mf = mesh_files::three_mf(m, "");
    const std::string gltf = mesh_files::gltf_json(m, "buffer.bin");
    write("buffer.bin", mesh_files::gltf_buffer(m));
    write("short.bin", mesh_files::gltf_buffer(m).substr(0, 50));
    const Case cases[] = {
        // The file is missing or is no file.
        {"empty.obj", "", "empty"},
        {"empty.stl", "", "empty"},
        {"empty.glb", "", "empty"},
        {"empty.3mf", "", "empty"},
        {"box.step", obj, "unknown format '.step'; allowed: .obj, .stl"},
        {"box", obj, "unknown format '.'"},
        {"box.obj.gz", obj, "unknown format '.gz'"},
        {"garbage.obj", "\x01\x02 garbage\n", "no faces"},
        {"glb.obj", glb, "not the text of an OBJ file"},
        {"stl.ply", stl, "not a PLY file"},
        {"ply.stl", ply, "not an STL file"},
        {"obj.stl", obj, "not an STL file"},
        {"obj.glb", obj, "not a GLB file"},
        {"obj.gltf", obj, "not a glTF file"},
        {"obj.dae", obj, "not a COLLADA file"},
        {"obj.3ds", obj, "not a 3DS file"},
        {"obj.3mf", obj, "not a 3MF file"},
        {"obj.fbx", obj, "cannot be imported"},
        {"old.glb", with_header_count(glb, 4, 1), "glTF version 1; allowed: 2"},
        // The file has no faces, lines or points.
        {"vertices.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
         "no faces ('f'), lines ('l') or points ('p') among 3"},
        {"none.stl", "solid x\nendsolid x\n", "no faces"},
        {"none_binary.stl", with_header_count(stl.substr(0, 84), 80, 0), "no faces"},
        {"none.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
         "no vertices"},
        {"none.dae", replaced(dae, "<instance_geometry url=\"#g\"/>", ""), "no faces, lines or points"},
        {"none.gltf", R"({"asset":{"version":"2.0"}})", "No scene"},
        // Coordinates are not finite or too large.
        {"nan.obj", replaced(obj, "v 0 0 0", "v 0 nan 0"), "line 1: 'v 0 nan 0'"},
        {"inf.obj", replaced(obj, "v 0 0 0", "v 0 0 inf"), "line 1"},
        {"overflow.obj", replaced(obj, "v 0 0 0", "v 0 0 1e999"), "line 1"},
        {"huge.obj", replaced(obj, "v 0 0 0", "v 0 0 1e300"), "vertex 1 (0, 0, inf) of face 1 is not finite"},
        {"far.obj", replaced(obj, "v 0 0 0", "v 0 0 1e7"), "within 1e+06 m"},
        {"word.obj", replaced(obj, "v 0 0 0", "v 0 0 zero"), "'zero' is no number"},
        {"nan.stl", with_header_count(stl, 84 + 12, 0x7fc00000), "is not finite"},
        {"inf.ply", replaced(ascii_ply, "\n0 0 0\n", "\n0 0 inf\n"), "vertex 1 (0, 0, inf)"},
        {"nan.ply", with_header_count(ply, ply.find("end_header\n") + 11, 0x7fc00000),
         "vertex 1 (nan, 0, 0)"},
        {"nan.gltf", replaced(gltf, "buffer.bin", "nan.bin"), "is not finite"},
        // Invalid indices.
        {"beyond.obj", obj + "f 1 2 9\n", "line 21: it names vertex 9, but there are 8"},
        {"zero.obj", obj + "f 0 1 2\n", "line 21: 'f 0 1 2': vertex 0 out of range"},
        {"negative.obj", obj + "f -1 -2 -9\n", "vertex -9 out of range"},
        {"index.obj", obj + "f a b c\n", "'a' is no index"},
        {"two.obj", obj + "f 1 2\n", "2 corners; at least 3"},
        {"beyond.ply", replaced(ascii_ply, "\n3 0 ", "\n3 8 "), "names vertex 8, but there are 8"},
        {"minus.ply", replaced(ascii_ply, "\n3 0 ", "\n3 -1 "), "names vertex -1"},
        {"beyond.gltf", replaced(gltf, "buffer.bin", "index.bin"), "damaged: "},
        {"beyond.glb", mesh_files::glb(beyond), "damaged: "},
        {"beyond.dae", mesh_files::dae(beyond, ""), "Invalid data index (99/8)"},
        {"beyond.fbx", mesh_files::fbx(beyond, 2, 100), "damaged: "},
        {"beyond.3mf", mesh_files::three_mf(beyond, ""), "face 4 names vertex 100, but there are 8"},
        {"beyond.3ds", mesh_files::three_ds(beyond), "damaged: 3DS: Vertex index overflow"},
        {"nan.dae", mesh_files::dae(nan, ""), "is not finite"},
        {"nan.fbx", mesh_files::fbx(nan, 2, 100), "is not finite"},
        {"nan.3mf", mesh_files::three_mf(nan, ""), "vertex 3 (1, nan, 0)"},
        {"nan.3ds", mesh_files::three_ds(nan), "is not finite"},
        // Truncated files.
        {"cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1", "line 3: 'v 0 1': a vertex has 3 numbers"},
        {"cut.stl", stl.substr(0, stl.size() - 1), "truncated"},
        {"half.stl", cut(stl, 0.5), "truncated"},
        {"header.stl", stl.substr(0, 80), "truncated"},
        {"cut_ascii.stl", cut(ascii_stl, 0.5), "truncated"},
        {"no_end.stl", replaced(ascii_stl, "endsolid box\n", ""), "truncated: no 'endsolid' after face 12"},
        {"cut.ply", ply.substr(0, ply.size() - 1), "truncated: its header counts 12 of element 'face'"},
        {"half.ply", cut(ply, 0.6), "truncated"},
        {"cut_ascii.ply", cut(ascii_ply, 0.8), "truncated"},
        {"header.ply", ply.substr(0, 60), "truncated: its header has no 'end_header'"},
        {"cut.glb", glb.substr(0, glb.size() - 4), "truncated: its header says"},
        {"half.glb", cut(glb, 0.5), "truncated"},
        {"chunk.glb", with_header_count(glb, 12, 100000), "truncated: the chunk at byte 12"},
        {"cut.gltf", cut(gltf, 0.7), "cannot be imported"},
        {"short.gltf", replaced(gltf, "buffer.bin", "short.bin"), "cannot be imported"},
        {"missing.gltf", replaced(gltf, "buffer.bin", "missing.bin"), "missing.bin"},
        {"cut.dae", cut(dae, 0.7), "cannot be imported"},
        {"cut.fbx", cut(fbx, 0.6), "unexpected end of file"},
        {"cut.3ds", cut(three_ds, 0.7), "truncated: its main chunk says"},
        {"cut.3mf", cut(three_mf, 0.7), "no whole ZIP archive"},
        // Headers that contradict the content.
        {"more.stl", with_header_count(stl, 80, 13),
         "its header counts 13 faces, 734 bytes, but the file has 684"},
        {"less.stl", with_header_count(stl, 80, 11), "its header counts 11 faces"},
        {"billion.stl", with_header_count(stl, 80, 0xffffffff), "its header counts 4294967295 faces"},
        {"billion.ply", replaced(ply, "element face 12", "element face 1000000000"), "counts 1000000000"},
        {"vertices.ply", replaced(ply, "element vertex 8", "element vertex 4000000000"), "counts 4000000000"},
        {"overflow.ply", replaced(ply, "element face 12", "element face 99999999999999999999999"),
         "no count"},
        {"minus_count.ply", replaced(ply, "element face 12", "element face -12"), "no count"},
        {"list.ply", replaced(ascii_ply, "\n3 0 ", "\n2000000000 0 "), "truncated"},
        {"type.ply", replaced(ply, "list uchar int", "list uchar quad"), "unknown type 'quad'"},
        {"float_count.ply", replaced(ply, "list uchar", "list float"), "no integer"},
        {"billion.glb", with_header_count(glb, 8, 0xffffffff), "truncated"},
        {"huge_chunk.3ds", with_header_count(three_ds, 2, 0xfffffff0), "truncated"},
        {"billion.gltf", replaced(gltf, R"("count":8)", R"("count":1000000000)"), "out of range"},
        {"unit.3mf", mesh_files::three_mf(m, " unit=\"furlong\""), "its unit 'furlong'"},
        {"axis.fbx", mesh_files::fbx(m, 7, 100), "state the up axis"},
        {"unit.fbx", mesh_files::fbx(m, 2, -1), "state the units"},
        {"unit.dae", mesh_files::dae(m, "<unit name=\"nil\" meter=\"0\"/>"), "its unit is 0 m"},
        // Nothing is left after repair.
        {"flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n",
         "nothing is left of it: removed 1 face without area"},
        {"point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "nothing is left of it"},
    };
    std::string nan_buffer = mesh_files::gltf_buffer(m);
    write("nan.bin", with_header_count(nan_buffer, 0, 0x7fc00000));
    write("index.bin", with_header_count(nan_buffer, 96, 0xffffffff));
    for (const Case& c : cases) EXPECT_THAT(refusal(c.name, c.bytes), HasSubstr(c.says)) << c.name;
}

TEST_F(ObstacleFileTest, WhatIsNoRegularFileIsRefusedAtOnce)
{
    const auto start = Clock::now();
    EXPECT_THAT(refusal(request_of((folder_ / "missing.obj").string())), HasSubstr("no such file"));
    EXPECT_THAT(refusal(request_of((folder_ / "no/such/folder.obj").string())), HasSubstr("no such file"));
    std::filesystem::create_directory(folder_ / "folder.obj");
    EXPECT_THAT(refusal(request_of((folder_ / "folder.obj").string())), HasSubstr("not a regular file"));
    ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    EXPECT_THAT(refusal(request_of((folder_ / "pipe.obj").string())), HasSubstr("not a regular file"));
    std::filesystem::create_symlink("/dev/zero", folder_ / "zero.ply");
    EXPECT_THAT(refusal(request_of((folder_ / "zero.ply").string())), HasSubstr("not a regular file"));
    std::filesystem::create_symlink("loop.obj", folder_ / "loop.obj");
    EXPECT_NE(refusal(request_of((folder_ / "loop.obj").string())), "");
    EXPECT_THAT(refusal(request_of("")), HasSubstr("unknown format"));
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(30));
}

TEST_F(ObstacleFileTest, FilesThatAreTooLargeAreRefusedUnread)
{
    const std::string path = write("large.obj", "");
    std::filesystem::resize_file(path, (std::uintmax_t{2} << 30) + 1);  // a sparse file: no disk is used
    EXPECT_THAT(refusal(request_of(path)), HasSubstr("2147483649 bytes; allowed are at most 2147483648"));
}

#if !defined(__SANITIZE_ADDRESS__)  // address sanitizers reserve all addresses: no limit holds
TEST_F(ObstacleFileTest, SmallFilesOfEndlessContentAreStopped)
{
    // Each node refers to the next one ten times: 1e9 triangles in a kilobyte.
    std::string nodes;
    for (int k = 1; k < 10; ++k)
        nodes += fmt::format(R"({{"children":[{0},{0},{0},{0},{0},{0},{0},{0},{0},{0}]}},)", k);
    const std::string tree = replaced(mesh_files::gltf_json(box(), "buffer.bin"), R"([{"mesh":0}])",
                                      "[" + nodes + R"({"mesh":0}])");
    write("buffer.bin", mesh_files::gltf_buffer(box()));
    // Each level of brackets is a recursive call of the parser.
    const std::string deep = R"({"asset":{"version":"2.0"},"x":)" + std::string(2000000, '[');
    for (const std::string& text : {tree, deep}) {
        ObstacleFileRequest request = request_of(write("small.gltf", text));
        request.timeout = std::chrono::seconds(20);
        EXPECT_THAT(refusal(request), AnyOf(HasSubstr("more memory"), HasSubstr("took longer"),
                                            HasSubstr("nodes"), HasSubstr("crashed"), HasSubstr("failed")));
    }
}
#endif

// A file truncated anywhere or with a flipped bit must give a mesh or a one-line error.
TEST_F(ObstacleFileTest, AnyDamageEndsInAMeshOrOneLine)
{
    const ObstacleMesh m = box();
    const std::pair<const char*, std::string> files[] = {
        {"x.glb", mesh_files::glb(m)},         {"x.3ds", mesh_files::three_ds(m)},
        {"x.ply", mesh_files::binary_ply(m)},  {"x.stl", mesh_files::binary_stl(m)},
        {"x.obj", mesh_files::obj(m)},         {"x.3mf", mesh_files::three_mf(m, "")},
        {"x.fbx", mesh_files::fbx(m, 2, 100)}, {"x.dae", mesh_files::dae(m, "")}};
    for (const auto& [name, bytes] : files)
        for (int k = 0; k < 12; ++k) {
            std::string damaged = bytes;
            const std::size_t at = (bytes.size() * (2 * k + 1)) / 24;
            if (k % 2 == 0) damaged.resize(at);
            if (k % 2 == 1) damaged[at] = static_cast<char>(damaged[at] ^ (1 << (k % 8)));
            ObstacleFileRequest request = request_of(write(name, damaged));
            request.timeout = std::chrono::seconds(60);
            const std::string error = error_of([&] {
                const ObstacleFile file = read_obstacle_file(request);
                EXPECT_EQ(validate(file.mesh), "");
            });
            EXPECT_THAT(error, AllOf(Not(HasSubstr("\n")), Not(HasSubstr("took longer"))))
                << name << " " << k;
        }
}

// ----------------------------------------------------------------- importers that fail

TEST_F(ObstacleFileTest, CrashesAreErrorsOfTheFile)
{
    EXPECT_THAT(fate_of({"abort"}), HasSubstr("its import crashed (signal 6, Aborted)"));
    // Address sanitizers catch these signals and exit.
    for (const int signal : {SIGSEGV, SIGFPE, SIGKILL})
        EXPECT_THAT(fate_of({"raise", std::to_string(signal)}),
                    AnyOf(HasSubstr("its import crashed (signal " + std::to_string(signal)),
                          HasSubstr("its import failed (exit status 1)")));
    EXPECT_THAT(fate_of({"exit", "3"}), HasSubstr("exit status 3"));
    EXPECT_THAT(fate_of({"exit", "0"}), HasSubstr("damaged"));
}

TEST_F(ObstacleFileTest, HangsAreStopped)
{
    const auto start = Clock::now();
    for (const char* mode : {"sleep", "spin", "linger"})
        EXPECT_THAT(fate_of({mode}, std::chrono::milliseconds(300)), HasSubstr("longer than 0.3 s")) << mode;
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(30));
}

TEST_F(ObstacleFileTest, WhatItLeavesBehindIsStopped)
{
    EXPECT_THAT(fate_of({"orphan"}, std::chrono::milliseconds(500)), HasSubstr("longer than 0.5 s"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "cmdline", std::ios::binary);
        const std::string line((std::istreambuf_iterator<char>(file)), {});
        EXPECT_EQ(line.find(folder_.string()), std::string::npos) << "process " << entry.path();
    }
}

#if !defined(__SANITIZE_ADDRESS__)  // address sanitizers reserve all addresses: no limit holds
TEST_F(ObstacleFileTest, MemoryIsLimited)
{
    EXPECT_THAT(fate_of({"memory"}), AllOf(Not(HasSubstr("it got")), HasSubstr("crashed (signal 6")));
}
#endif

TEST_F(ObstacleFileTest, RepliesAreNotTrusted)
{
    EXPECT_THAT(fate_of({"garbage"}), HasSubstr("damaged"));
    for (const char* how : {"short", "long", "count", "far"})
        EXPECT_THAT(fate_of({"wrong", how}), HasSubstr("damaged")) << how;
    for (const char* how : {"index", "negative", "nan"}) EXPECT_NE(fate_of({"wrong", how}), "") << how;

    const ObstacleFileRequest request =
        request_of(write("box.obj", mesh_files::obj(box())), {"wrong", "lines"});
    EXPECT_THAT(read_obstacle_file(request).warnings, ElementsAre("one two [31m"));
}

TEST_F(ObstacleFileTest, EndlessRepliesAreCutOff)
{
    EXPECT_THAT(fate_of({"flood"}), HasSubstr("more than 0.5 GB"));
}

TEST_F(ObstacleFileTest, ImporterThatIsNotThereIsSaidSo)
{
    ObstacleFileRequest request = request_of(write("box.obj", mesh_files::obj(box())));
    request.importer = {(folder_ / "no_program").string(), "import-obstacle"};
    EXPECT_THAT(refusal(request), HasSubstr("could not be started"));
    request.importer = {};
    EXPECT_NE(refusal(request), "");
}

TEST_F(ObstacleFileTest, ChildHasNoDescriptorsButItsOwn)
{
    // A descriptor without close-on-exec, as a careless library would open.
    const int leaked = ::open("/dev/zero", O_RDONLY);
    ASSERT_GE(leaked, 0);
    EXPECT_THAT(fate_of({"descriptors"}), HasSubstr("descriptors 0 1 2 3, no input"));
    ::close(leaked);
}

TEST_F(ObstacleFileTest, WorksWithoutStandardInput)
{
    // The pipe then gets descriptor 0.
    const int kept = ::fcntl(0, F_DUPFD_CLOEXEC, 10);
    ::close(0);
    EXPECT_THAT(fate_of({"descriptors"}), HasSubstr("descriptors 0 1 2 3, no input"));
    if (kept >= 0) {
        ::dup2(kept, 0);
        ::close(kept);
    }
}

TEST_F(ObstacleFileTest, SeveralThreadsReadAtOnce)
{
    const std::string path = write("box.obj", mesh_files::obj(box()));
    std::vector<std::thread> threads;
    std::vector<std::size_t> faces(4, 0);
    for (std::size_t t = 0; t < faces.size(); ++t)
        threads.emplace_back([&, t] {
            for (int k = 0; k < 5; ++k) faces[t] += read_obstacle_file(request_of(path)).mesh.faces.size();
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(faces, ::testing::Each(60u));
}

}  // namespace
}  // namespace arris
