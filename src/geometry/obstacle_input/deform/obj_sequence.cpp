// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/obj_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obj_file.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/formats/mesh_folder_io.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why)
{
    throw InputError(path + ": " + why);
}

/// A file's name with a number in it.
struct NamePattern {
    std::string before, after;
    int width = 0;  ///< least number of digits, filled up with zeros; 0: no zeros in front

    std::string name(int number) const { return fmt::format("{}{:0{}}{}", before, number, width, after); }

    std::optional<int> parse(std::string_view name) const
    {
        if (name.size() <= before.size() + after.size() || !name.starts_with(before) ||
            !name.ends_with(after))
            return std::nullopt;
        const std::string_view digits =
            name.substr(before.size(), name.size() - before.size() - after.size());
        int number = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        // A sign, spaces or other zeros than the pattern's make another name.
        if (error != std::errc() || number < 0 || this->name(number) != name) return std::nullopt;
        return number;
    }
};

std::optional<NamePattern> find_pattern(const std::string& name)
{
    const std::size_t percent = name.find('%');
    const std::size_t letter = percent == std::string::npos ? percent : name.find('d', percent);
    if (letter == std::string::npos || name.find('%', percent + 1) != std::string::npos) return std::nullopt;
    const std::string_view width = std::string_view(name).substr(percent + 1, letter - percent - 1);
    NamePattern pattern{name.substr(0, percent), name.substr(letter + 1)};
    if (width.empty()) return pattern;
    if (width.size() != 2 || width[0] != '0' || width[1] < '1' || width[1] > '9') return std::nullopt;
    pattern.width = width[1] - '0';
    return pattern;
}

fs::path folder_of(const std::string& path)
{
    const fs::path parent = fs::path(path).parent_path();
    return parent.empty() ? fs::path(".") : parent;
}

/// The numbers of the files that the pattern names, ascending, and why the folder cannot be read, if so.
std::vector<int> find_numbers(const fs::path& folder, const NamePattern& pattern, std::error_code& error)
{
    std::vector<int> numbers;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        if (const std::optional<int> number = pattern.parse(entry->path().filename().string()))
            numbers.push_back(*number);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

/// Requires each file from the first to the last.
void require_all(const std::string& path, const NamePattern& pattern, const std::vector<int>& numbers,
                 const VertexCacheRequest& request)
{
    if (numbers.empty())
        refuse(path, fmt::format("no file has such a name, for example {}; allowed: at least one",
                                 pattern.name(request.first.value_or(1))));
    int expected = request.first.value_or(numbers.front());
    const auto require = [&](bool is_there) {
        if (!is_there)
            refuse(path, fmt::format("{} is missing; allowed: a file for each number from {} to {}",
                                     pattern.name(expected), request.first.value_or(numbers.front()),
                                     request.last.value_or(numbers.back())));
    };
    for (const int number : numbers) {
        require(number == expected);
        ++expected;
    }
    require(!request.last || *request.last == numbers.back());
}

class ObjSequence : public VertexCache {
  public:
    ObjSequence(fs::path folder, NamePattern pattern, int first, int vertex_count, std::vector<double> times)
        : VertexCache(std::move(times), false),
          folder_(std::move(folder)),
          pattern_(std::move(pattern)),
          first_(first),
          vertex_count_(vertex_count)
    {
    }

    std::string describe(std::size_t sample) const override { return path(sample).string(); }

    void read(std::size_t sample, std::vector<Vec3>& vertices) override
    {
        ObjFile file;
        try {
            file = read_obj(read_regular_file(path(sample), kLargestFile));
        } catch (const InputError& error) {
            refuse(describe(sample), error.what());
        }
        if (file.vertices.size() != static_cast<std::size_t>(vertex_count_))
            refuse(describe(sample), fmt::format("has {}; allowed: {}, as in the obstacle's file",
                                                 counted(static_cast<long long>(file.vertices.size()),
                                                         "vertex ('v')", "vertices ('v')"),
                                                 vertex_count_));
        vertices.clear();
        for (const ObjVertex& vertex : file.vertices) vertices.push_back(vertex.place);
    }

  private:
    fs::path path(std::size_t sample) const
    {
        return folder_ / pattern_.name(first_ + static_cast<int>(sample));
    }

    fs::path folder_;
    NamePattern pattern_;
    int first_;
    int vertex_count_;
};

}  // namespace

std::vector<std::string> list_obj_sequence(const std::string& path)
{
    const std::optional<NamePattern> pattern = find_pattern(fs::path(path).filename().string());
    if (!pattern) return {path};
    std::error_code ignored;
    std::vector<std::string> files;
    for (const int number : find_numbers(folder_of(path), *pattern, ignored))
        files.push_back((folder_of(path) / pattern->name(number)).string());
    return files;
}

std::unique_ptr<VertexCache> open_obj_sequence(const VertexCacheRequest& request)
{
    const std::optional<NamePattern> pattern = find_pattern(fs::path(request.path).filename().string());
    if (!pattern)
        refuse(
            request.path,
            "names no sequence of OBJ files; allowed: one %d, or %04d for four digits, in the file's name");
    if (request.first && request.last && *request.last < *request.first)
        refuse(request.path, fmt::format("last = {} is before first = {}", *request.last, *request.first));
    const fs::path folder = folder_of(request.path);
    std::error_code error;
    std::vector<int> numbers = find_numbers(folder, *pattern, error);
    if (error) refuse(request.path, error.message());
    std::erase_if(numbers, [&](int number) {
        return number < request.first.value_or(0) ||
               number > request.last.value_or(std::numeric_limits<int>::max());
    });
    require_all(request.path, *pattern, numbers, request);
    std::vector<double> times;
    for (std::size_t k = 0; k < numbers.size(); ++k)
        times.push_back(static_cast<double>(k) / request.frames_per_second.value_or(kDefaultFramesPerSecond));
    return std::make_unique<ObjSequence>(folder, *pattern, numbers.front(), request.vertex_count,
                                         std::move(times));
}

}  // namespace arris
