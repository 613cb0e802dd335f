// SPDX-License-Identifier: GPL-3.0-or-later
// Changes sound files at random and reads them as the program does. Each must give a valid result or one line
// of an InputError, in bounded time and memory. Ends with status 1 where one does not, and with a signal's
// name and the file's number where reading in this process crashes or hangs.
//
// usage: arris_input_fuzz [--files N] [--seed S] [--first K] [--keep FOLDER]
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/import_command.h"
#include "geometry/obstacle_input/obstacle_import.h"
#include "tests/app/input_fuzz/input_kinds.h"
#include "tests/app/input_fuzz/mutation.h"

namespace {

constexpr unsigned kReadSeconds = 120;  // bound of reading one file
constexpr long kMostMemory = 2L << 20;  // KiB, of this process and of each importer
constexpr std::size_t kLongestLine = 2000;

struct Options {
    long files = 500;
    unsigned long seed = 1;
    long first = 0;
    std::string keep;  // folder of files that fail
};

struct Counts {
    long accepted = 0, refused = 0, failed = 0, import_crashed = 0;
};

char current[200];  // what is being read, for the signal handler

void tell_signal(int signal)
{
    const char* name = signal == SIGALRM ? "hangs: " : "crashes: ";
    if (::write(STDERR_FILENO, name, std::strlen(name)) < 0 ||
        ::write(STDERR_FILENO, current, std::strlen(current)) < 0)
        std::_Exit(4);
    std::_Exit(3);
}

long peak_memory(int who)
{
    rusage usage{};
    ::getrusage(who, &usage);
    return usage.ru_maxrss;
}

// What is wrong with the outcome of reading a file; empty if nothing is.
std::string find_fault(const arris::InputKind& kind, const std::string& path, Counts& counts)
{
    try {
        const std::string defect = kind.read(path);
        ++counts.accepted;
        return defect.empty() ? "" : "accepted, but invalid: " + defect;
    } catch (const arris::InputError& error) {
        ++counts.refused;
        const std::string line = error.what();
        if (line.find("its import crashed") != std::string::npos) ++counts.import_crashed;
        if (line.find("took longer") != std::string::npos) return "hangs: " + line;
        if (line.empty() || line.size() > kLongestLine || line.find('\n') != std::string::npos)
            return "its error is not one line: " + line;
        return "";
    } catch (const std::exception& error) {
        return std::string("throws what is no InputError: ") + error.what();
    }
}

Options parse(int argc, char** argv)
{
    Options options;
    for (int k = 1; k + 1 < argc; k += 2) {
        const std::string name = argv[k];
        if (name == "--files")
            options.files = std::atol(argv[k + 1]);
        else if (name == "--seed")
            options.seed = std::strtoul(argv[k + 1], nullptr, 10);
        else if (name == "--first")
            options.first = std::atol(argv[k + 1]);
        else if (name == "--keep")
            options.keep = argv[k + 1];
        else {
            fmt::print(stderr, "arris_input_fuzz: unknown argument {}\n", name);
            std::exit(2);
        }
    }
    return options;
}

// Reads changed file `number`; false where that goes wrong.
bool try_file(const std::vector<arris::InputKind>& kinds, const Options& options, long number,
              const std::filesystem::path& folder, std::map<std::string, Counts>& counts)
{
    const arris::InputKind& kind = kinds[static_cast<std::size_t>(number) % kinds.size()];
    std::seed_seq seed{options.seed, static_cast<unsigned long>(number)};
    std::mt19937 random(seed);
    const std::string path = (folder / kind.file).string();
    fmt::format_to_n(current, sizeof current - 1, "{}, seed {}, file {}\n", kind.name, options.seed, number);
    kind.write(path, arris::mutate(kind.seed, random));
    ::alarm(kReadSeconds);
    const std::string fault = find_fault(kind, path, counts[kind.name]);
    ::alarm(0);
    if (fault.empty()) return true;
    ++counts[kind.name].failed;
    fmt::print("{}, seed {}, file {}: {}\n", kind.name, options.seed, number, fault);
    if (!options.keep.empty()) {
        const std::filesystem::path kept = std::filesystem::path(options.keep) / std::to_string(number);
        std::filesystem::create_directories(kept);
        std::filesystem::copy(path, kept / kind.file, std::filesystem::copy_options::overwrite_existing);
    }
    return false;
}

int run(const Options& options, const std::filesystem::path& folder)
{
    const std::vector<arris::InputKind> kinds =
        arris::list_input_kinds({"/proc/self/exe", "import-obstacle"}, folder.string());
    std::map<std::string, Counts> counts;
    // A seed that is refused would make every test of its kind pass.
    for (const arris::InputKind& kind : kinds) {
        Counts sound;
        kind.write((folder / kind.file).string(), kind.seed);
        const std::string fault = find_fault(kind, (folder / kind.file).string(), sound);
        if (sound.accepted == 1 && fault.empty()) continue;
        fmt::print("{}: its sound file is refused\n", kind.name);
        return 1;
    }
    long failed = 0;
    for (long k = options.first; k < options.first + options.files; ++k)
        if (!try_file(kinds, options, k, folder, counts)) ++failed;
    for (const auto& [name, of] : counts)
        fmt::print("{:>16}: {} accepted, {} refused ({} as the import library crashed), {} failed\n", name,
                   of.accepted, of.refused, of.import_crashed, of.failed);
    const long memory = std::max(peak_memory(RUSAGE_SELF), peak_memory(RUSAGE_CHILDREN));
    fmt::print("seed {}, files {} to {}: {} failed; at most {} MiB of memory\n", options.seed, options.first,
               options.first + options.files - 1, failed, memory / 1024);
    return failed == 0 && memory <= kMostMemory ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc > 1 && std::strcmp(argv[1], "import-obstacle") == 0)
        std::_Exit(arris::import_obstacle_command(argc - 2, argv + 2));
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGALRM})
        std::signal(signal, tell_signal);
    const Options options = parse(argc, argv);
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("arris_input_fuzz_{}", ::getpid());
    std::filesystem::create_directories(folder);
    const int status = run(options, folder);
    std::filesystem::remove_all(folder);
    return status;
}
