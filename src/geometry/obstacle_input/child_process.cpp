// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <thread>

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

// Address and thread sanitizers reserve terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsAddresses = false;
#else
constexpr bool kLimitsAddresses = true;
#endif

// Exit status of a child that failed before it became `command`, as in shells.
constexpr int kNotStarted = 127;

// Lower descriptors are overwritten in the child.
constexpr int kFirstFree = 10;

class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int get() const { return fd_; }
    bool is_open() const { return fd_ >= 0; }
    void close()
    {
        if (fd_ >= 0) ::close(fd_);
        fd_ = -1;
    }

    // Moves the descriptor out of the range that the child overwrites.
    void move_up()
    {
        const int higher = fd_ < 0 ? -1 : ::fcntl(fd_, F_DUPFD_CLOEXEC, kFirstFree);
        close();
        fd_ = higher;
    }

  private:
    int fd_;
};

struct Limit {
    __rlimit_resource resource;
    rlimit value;
};

// No limit may be raised above the present hard limit.
Limit make_limit(__rlimit_resource resource, std::uint64_t value)
{
    rlimit now{};
    ::getrlimit(resource, &now);
    const rlim_t least = std::min<rlim_t>(value, now.rlim_max);
    return {resource, {least, least}};
}

std::vector<Limit> make_limits(const ChildLimits& limits)
{
    const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.wall).count();
    std::vector<Limit> made = {make_limit(RLIMIT_CPU, static_cast<std::uint64_t>(seconds) + 1),
                               make_limit(RLIMIT_CORE, 0), make_limit(RLIMIT_FSIZE, 0)};
    if (kLimitsAddresses) made.push_back(make_limit(RLIMIT_AS, limits.address_space));
    return made;
}

// This process's environment, but with one OpenBLAS thread. The program links OpenBLAS, which reserves memory
// for each core of the machine at its start; the child's memory is limited.
std::vector<char*> make_environment()
{
    static char one_thread[] = "OPENBLAS_NUM_THREADS=1";
    std::vector<char*> environment = {one_thread};
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry)
        if (!std::string_view(*entry).starts_with("OPENBLAS_NUM_THREADS=")) environment.push_back(*entry);
    environment.push_back(nullptr);
    return environment;
}

// Runs in the child. Only system calls are safe here, as locks held by other threads are never released.
[[noreturn]] void become(char* const* arguments, char* const* environment, const std::vector<Limit>& limits,
                         int null, int reply, pid_t parent)
{
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(kNotStarted);  // the parent died before the death signal was set
    for (const int standard : {0, 1, 2})
        if (::dup2(null, standard) < 0) ::_exit(kNotStarted);
    if (::dup2(reply, kReplyDescriptor) < 0) ::_exit(kNotStarted);
    if (::close_range(kReplyDescriptor + 1, ~0u, 0) != 0) ::_exit(kNotStarted);
    for (const Limit& limit : limits)
        if (::setrlimit(limit.resource, &limit.value) != 0) ::_exit(kNotStarted);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execve(arguments[0], arguments, environment);
    ::_exit(kNotStarted);
}

class Child {
  public:
    Child(pid_t pid, const ChildLimits& limits) : pid_(pid), limits_(limits), end_(Clock::now() + limits.wall)
    {
    }

    ChildResult collect(int reply)
    {
        ChildResult result{ChildEnd::Exited, 0, {}};
        const bool has_ended = read_all(reply, result) && wait_until_end(result);
        // Before the child is reaped: until then its number is not reused.
        ::kill(-pid_, SIGKILL);                 // processes that the child started
        if (!has_ended) ::kill(pid_, SIGKILL);  // in case the child has no group of its own yet
        reap(result);
        return result;
    }

  private:
    int milliseconds_left() const
    {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end_ - Clock::now()).count();
        return static_cast<int>(std::clamp<long long>(left, 0, 1000000));
    }

    // Returns false where the time or the reply's length limit was exceeded, with the reason in `result`.
    bool read_all(int reply, ChildResult& result)
    {
        std::array<char, 1 << 16> buffer;
        for (;;) {
            const int left = milliseconds_left();
            pollfd wanted{reply, POLLIN, 0};
            const int ready = ::poll(&wanted, 1, left);
            if (ready < 0 && errno == EINTR) continue;
            if (ready <= 0) {
                result.end = ChildEnd::TimedOut;
                return false;
            }
            const ssize_t size = ::read(reply, buffer.data(), buffer.size());
            if (size < 0 && errno == EINTR) continue;
            if (size <= 0) return true;
            result.reply.append(buffer.data(), static_cast<std::size_t>(size));
            if (result.reply.size() > limits_.reply) {
                result.end = ChildEnd::ReplyTooLong;
                return false;
            }
        }
    }

    bool wait_until_end(ChildResult& result) const
    {
        // The child has closed its reply and will end soon: poll at short intervals.
        while (is_running()) {
            if (milliseconds_left() == 0) {
                result.end = ChildEnd::TimedOut;
                return false;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }

    bool is_running() const
    {
        siginfo_t about{};
        return ::waitid(P_PID, static_cast<id_t>(pid_), &about, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               about.si_pid == 0;
    }

    // Keeps a reason that is already in `result`. Where no status is kept (SIGCHLD ignored), the reply alone
    // decides.
    void reap(ChildResult& result) const
    {
        int status = 0;
        pid_t ended = 0;
        do ended = ::waitpid(pid_, &status, 0);
        while (ended < 0 && errno == EINTR);
        if (ended < 0 || result.end != ChildEnd::Exited) return;
        if (WIFSIGNALED(status)) {
            result.end = ChildEnd::Killed;
            result.code = WTERMSIG(status);
        } else {
            result.code = WEXITSTATUS(status);
            if (result.code == kNotStarted) result.end = ChildEnd::NotStarted;
        }
    }

    pid_t pid_;
    ChildLimits limits_;
    Clock::time_point end_;
};

}  // namespace

ChildResult run_child(const std::vector<std::string>& command, const ChildLimits& limits)
{
    // Everything that allocates precedes fork.
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const std::vector<char*> environment = make_environment();
    const std::vector<Limit> made_limits = make_limits(limits);
    int ends[2] = {-1, -1};
    if (command.empty() || ::pipe2(ends, O_CLOEXEC) != 0) return {ChildEnd::NotStarted, 0, {}};
    Descriptor read_end(ends[0]);
    Descriptor write_end(ends[1]);
    Descriptor null(::open("/dev/null", O_RDWR | O_CLOEXEC));
    write_end.move_up();
    null.move_up();
    if (!write_end.is_open() || !null.is_open()) return {ChildEnd::NotStarted, 0, {}};

    const pid_t parent = ::getpid();
    const pid_t pid = ::fork();
    if (pid == 0)
        become(arguments.data(), environment.data(), made_limits, null.get(), write_end.get(), parent);
    if (pid < 0) return {ChildEnd::NotStarted, 0, {}};
    write_end.close();
    return Child(pid, limits).collect(read_end.get());
}

}  // namespace arris
