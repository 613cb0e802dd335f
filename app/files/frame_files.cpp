// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>

#include "geometry/input_error.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

// Accepts only names of the form that frame_file makes, so not "cloth_7.ply" or "cloth_000007.ply".
std::optional<std::int64_t> frame_number(const std::string& name)
{
    constexpr std::string_view kPrefix = "cloth_", kSuffix = ".ply";
    if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return std::nullopt;
    std::int64_t number = 0;
    std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), number);
    const bool is_canonical = number >= 0 && name == fs::path(frame_file("", number, "ply")).filename();
    return is_canonical ? std::optional(number) : std::nullopt;
}

}  // namespace

std::string frames_directory(const std::string& run_dir)
{
    return run_dir + "/frames";
}

std::string frame_file(const std::string& run_dir, std::int64_t index, const std::string& extension,
                       const std::string& name)
{
    return fmt::format("{}/{}_{:05}.{}", frames_directory(run_dir), name, index, extension);
}

std::int64_t count_frames(const std::string& run_dir)
{
    std::int64_t count = 0, last = -1;
    std::error_code error;
    for (fs::directory_iterator entry(frames_directory(run_dir), error), end; !error && entry != end;
         entry.increment(error)) {
        const auto number = frame_number(entry->path().filename().string());
        if (!number) continue;
        ++count;
        last = std::max(last, *number);
    }
    // Numbers are unique, so last + 1 of them means that none is missing.
    if (count == last + 1) return count;
    std::int64_t missing = 0;
    while (fs::exists(frame_file(run_dir, missing, "ply"))) ++missing;
    throw InputError(frame_file(run_dir, missing, "ply") + ": is missing, but later frames exist");
}

void refuse_no_frames(const std::string& run_dir)
{
    throw InputError(
        frames_directory(run_dir) +
        ": has no frames (cloth_00000.ply, ...); an assembly has them with cloth.assembly.frames = true");
}

}  // namespace arris
