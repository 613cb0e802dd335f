// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace arris {

/// All of a file of a run but what is seconds, memory or threads.
inline std::string timeless(const std::filesystem::path& file)
{
    const std::string bytes = read_bytes(file.string());
    if (file.filename() == "report.html") return "";  // the same as report.json, for a person
    if (file.filename() == "report.json") {
        nlohmann::json report = nlohmann::json::parse(bytes);
        for (const char* key : {"wall_seconds", "cpu_seconds", "peak_memory_bytes", "phases", "threads"})
            report.erase(key);
        return report.dump();
    }
    if (file.filename() != "steps.csv") return bytes;
    std::istringstream lines(bytes);
    std::string line, kept;
    std::vector<bool> is_seconds;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string cell;
        for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
            if (kept.find('\n') == std::string::npos) is_seconds.push_back(cell.ends_with("_s"));
            if (!is_seconds[k]) kept += cell + ",";
        }
        kept += "\n";
    }
    return kept;
}

/// Expects the same files in two folders of runs.
inline void expect_same_run(const std::string& a, const std::string& b)
{
    namespace fs = std::filesystem;
    std::vector<std::string> files_a, files_b;
    for (const auto& entry : fs::recursive_directory_iterator(a))
        if (entry.is_regular_file()) files_a.push_back(fs::relative(entry.path(), a).string());
    for (const auto& entry : fs::recursive_directory_iterator(b))
        if (entry.is_regular_file()) files_b.push_back(fs::relative(entry.path(), b).string());
    std::sort(files_a.begin(), files_a.end());
    std::sort(files_b.begin(), files_b.end());
    EXPECT_EQ(files_a, files_b);
    for (const std::string& file : files_a)
        EXPECT_TRUE(timeless(fs::path(a) / file) == timeless(fs::path(b) / file)) << file;
}

}  // namespace arris
