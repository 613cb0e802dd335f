// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_file.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/child_process.h"
#include "geometry/obstacle_input/obstacle_reply.h"

namespace arris {
namespace {

// An importer's trees take about ten times a text mesh's size; an unpacked archive takes ten times more.
constexpr std::uint64_t kBaseMemory = std::uint64_t{2} << 30;
constexpr std::uint64_t kMemoryPerByte = 64;

// Room for 1e7 faces if most of their points are shared.
constexpr std::uint64_t kLongestReply = std::uint64_t{1} << 29;

std::uint64_t memory_for(const std::string& path)
{
    struct stat status {};
    const bool is_file = ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
    const std::uint64_t size = is_file ? static_cast<std::uint64_t>(status.st_size) : 0;
    const std::uint64_t physical = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                   static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return std::max(kBaseMemory, std::min(kBaseMemory + kMemoryPerByte * size, physical));
}

std::string ending(const ChildResult& child, std::chrono::milliseconds timeout)
{
    const double seconds = static_cast<double>(timeout.count()) / 1000.0;
    switch (child.end) {
        case ChildEnd::TimedOut:
            return fmt::format("its import took longer than {:g} s and was stopped", seconds);
        case ChildEnd::ReplyTooLong:
            return "its mesh takes more than 0.5 GB, some 1e7 faces";
        case ChildEnd::NotStarted:
            return "the program that imports it could not be started";
        case ChildEnd::Killed:
            if (child.code == SIGXCPU)
                return fmt::format("its import took longer than {:g} s and was stopped", seconds);
            return fmt::format(
                "its import crashed (signal {}, {}): the file is damaged, or holds what the import "
                "library cannot read",
                child.code, ::strsignal(child.code));
        case ChildEnd::Exited:
            break;
    }
    return fmt::format("its import failed (exit status {})", child.code);
}

}  // namespace

ObstacleFile read_obstacle_file(const ObstacleFileRequest& request)
{
    const auto refuse = [&](const std::string& why) { throw InputError(request.path + ": " + why); };
    if (request.metres_per_unit &&
        !(*request.metres_per_unit > 0.0 && std::isfinite(*request.metres_per_unit)))
        refuse(fmt::format("unit {} m must be positive", *request.metres_per_unit));
    if (request.up && *request.up != 'x' && *request.up != 'y' && *request.up != 'z')
        refuse(fmt::format("up '{}' must be x, y or z", *request.up));

    std::vector<std::string> command = request.importer;
    command.push_back(std::to_string(kReplyDescriptor));
    command.push_back(request.metres_per_unit ? fmt::format("{}", *request.metres_per_unit) : "-");
    command.push_back(request.up ? std::string(1, *request.up) : "-");
    command.push_back(request.path);
    const ChildResult child = run_child(command, {request.timeout, memory_for(request.path), kLongestReply});
    if (child.end != ChildEnd::Exited || child.code != 0) refuse(ending(child, request.timeout));
    try {
        return decode_reply(child.reply);
    } catch (const InputError& error) {
        throw InputError(request.path + ": " + error.what());
    }
}

}  // namespace arris
