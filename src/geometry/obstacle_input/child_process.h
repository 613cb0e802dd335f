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
    int code;           ///< exit status, or the signal that killed it
    std::string reply;  ///< all it wrote
};

/// The descriptor on which a child of run_child replies.
constexpr int kReplyDescriptor = 3;

/// Runs `command` (a program by path, then its arguments) and collects what it writes to kReplyDescriptor.
/// The child has no other descriptors but /dev/null as its three standard ones, leaves no core, may write no
/// file, may use as much CPU as wall time, and dies with the calling thread. When this returns it has ended,
/// by force if it took too long or said too much, along with processes it started (unless they left its
/// group). Thread-safe: between fork and exec only system calls are made.
ChildResult run_child(const std::vector<std::string>& command, const ChildLimits& limits);

}  // namespace arris
