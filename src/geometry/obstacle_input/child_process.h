// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace arris {

struct ChildLimits {
    std::chrono::milliseconds wall;
    std::uint64_t address_space;  ///< bytes; not applied under address and thread sanitizers
    std::uint64_t reply;          ///< bytes
};

enum class ChildEnd { Exited, Killed, TimedOut, ReplyTooLong, NotStarted };

struct ChildResult {
    ChildEnd end;
    int code;           ///< exit status, or the signal that killed the child
    std::string reply;  ///< everything that the child wrote
};

/// The descriptor on which a child of run_child replies.
constexpr int kReplyDescriptor = 3;

/// Runs `command` (a program's path, then its arguments) and collects what the child writes to
/// kReplyDescriptor. The child's three standard descriptors are /dev/null; it has no others. It writes no
/// core dump and no file, may use as much CPU time as wall time, and dies with the calling thread.
///
/// When run_child returns, the child has ended. A child that took too long or replied too much is killed,
/// along with processes it started (unless they left its process group). Thread-safe: only system calls are
/// made between fork and exec.
ChildResult run_child(const std::vector<std::string>& command, const ChildLimits& limits);

}  // namespace arris
