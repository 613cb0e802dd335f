// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/error_line.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>

namespace arris {

std::string error_line(const std::exception& error)
{
    if (const auto* of_file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        return fmt::format("{}: cannot be used: {}", of_file->path1().string(), of_file->code().message());
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
        return "not enough memory; a coarser cloth needs less";
    return error.what();
}

}  // namespace arris
