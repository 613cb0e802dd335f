// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "geometry/obstacle_input/obstacle_import.h"
#include "tests/app/error_of.h"

namespace arris {

/// Imports a mesh file with these bytes from a folder of the running test.
inline ObstacleFile imported(const std::string& name, const std::string& bytes)
{
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                         (std::string("arris_") + test.test_suite_name() + "_" + test.name());
    std::filesystem::create_directories(folder);
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary) << bytes;
    ObstacleFile file;
    const std::string error = error_of([&] { file = import_obstacle(path.string(), {}, {}); });
    std::filesystem::remove_all(folder);
    if (!error.empty()) throw InputError(error);
    return file;
}

/// The error of an import; empty if it succeeds.
inline std::string import_error(const std::string& name, const std::string& bytes)
{
    return error_of([&] { imported(name, bytes); });
}

/// Volume that the faces enclose.
inline double volume_of(const ObstacleMesh& mesh)
{
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.faces) six += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c]));
    return six / 6.0;
}

}  // namespace arris
