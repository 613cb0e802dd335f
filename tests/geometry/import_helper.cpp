// SPDX-License-Identifier: GPL-3.0-or-later
// An importer process that behaves or misbehaves as its first argument says.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "geometry/obstacle_input/child_process.h"
#include "geometry/obstacle_input/import_command.h"
#include "geometry/obstacle_input/obstacle_reply.h"
#include "tests/geometry/sample_obstacles.h"

namespace {

void reply(const std::string& bytes)
{
    if (::write(arris::kReplyDescriptor, bytes.data(), bytes.size()) < 0) std::_Exit(9);
}

void use_memory()
{
    // Writes to each page. Under address sanitizers memory limits have no effect, so this mode stops by
    // itself.
    std::vector<std::string> blocks;
    for (int k = 0; k < 4096; ++k) blocks.emplace_back(std::size_t{1} << 20, 'x');
    reply(arris::encode_refusal("it got 4 GiB"));
}

void flood()
{
    const std::string block(1 << 20, 'x');
    for (;;)
        if (::write(arris::kReplyDescriptor, block.data(), block.size()) < 0) std::_Exit(9);
}

// Reports the child's descriptors and standard files.
void tell_descriptors()
{
    std::string open;
    for (int fd = 0; fd < 1000; ++fd)
        if (::fcntl(fd, F_GETFD) >= 0) open += " " + std::to_string(fd);
    char byte = 0;
    const bool is_at_end = ::read(0, &byte, 1) == 0;
    reply(arris::encode_refusal("descriptors" + open + (is_at_end ? ", no input" : ", input")));
}

// A mesh with errors that only a check of the reply finds.
void reply_wrong_mesh(const std::string& how)
{
    arris::ObstacleFile file;
    file.mesh = arris::samples::box(arris::Vec3::Zero(), arris::Vec3::Ones());
    if (how == "index") file.mesh.faces[0][0] = 1000000;
    if (how == "negative") file.mesh.faces[0][0] = -5;
    if (how == "nan") file.mesh.points[0].x() = std::strtod("nan", nullptr);
    if (how == "far") file.mesh.points[0].x() = 1e7;
    if (how == "lines") file.warnings = {"one\ntwo\x1b[31m"};
    std::string bytes = arris::encode_reply(file);
    if (how == "short") bytes.resize(bytes.size() - 1);
    if (how == "long") bytes += "x";
    if (how == "count") std::memset(bytes.data() + 16, 0xff, 8);
    reply(bytes);
}

}  // namespace

int main(int argc, char** argv)
{
    const std::string mode = argc > 1 ? argv[1] : "";
    if (mode == "import-obstacle") std::_Exit(arris::import_obstacle_command(argc - 2, argv + 2));
    if (mode == "abort") std::abort();
    if (mode == "raise") std::raise(std::atoi(argv[2]));
    if (mode == "sleep") ::sleep(1000);
    if (mode == "spin")
        for (;;) ::getppid();
    if (mode == "linger") {  // replies, but does not exit
        ::close(arris::kReplyDescriptor);
        ::sleep(1000);
    }
    if (mode == "orphan" && ::fork() == 0) ::sleep(1000);  // leaves a child process that holds the pipe
    if (mode == "memory") use_memory();
    if (mode == "flood") flood();
    if (mode == "garbage") reply("a mesh, I promise");
    if (mode == "descriptors") tell_descriptors();
    if (mode == "wrong") reply_wrong_mesh(argv[2]);
    if (mode == "exit") return std::atoi(argv[2]);
    return 0;
}
