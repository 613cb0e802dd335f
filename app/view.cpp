// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/view.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/export/export_frames.h"
#include "app/files/frame_files.h"
#include "app/run/run_export_options.h"
#include "app/text/printable.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

bool is_current(const std::string& run_dir, const std::string& page)
{
    const std::int64_t frames = count_frames(run_dir);
    return frames > 0 && fs::exists(page) &&
           fs::last_write_time(page) >= fs::last_write_time(frame_file(run_dir, frames - 1, "ply"));
}

bool has_display()
{
    const auto is_set = [](const char* name) {
        const char* value = std::getenv(name);
        return value && *value;
    };
    return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

enum class Opening { Done, NoOpener, Failed };

Opening open_page(const std::string& page)
{
    std::string program = "xdg-open", path = page;
    char* const arguments[] = {program.data(), path.data(), nullptr};
    pid_t child = -1;
    if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
        return Opening::NoOpener;
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? Opening::Done : Opening::Failed;
}

}  // namespace

void view(const std::string& run_dir)
{
    const ExportOptions options = read_export_options(run_dir);
    const std::string page = exported_path(run_dir, "viewer");
    if (!is_current(run_dir, page)) {
        for (const std::string& warning : warn_of_missing_files(run_dir))
            fmt::print(stderr, "warning: {}\n", printable(warning));
        export_frames(run_dir, {"viewer"}, options);
    }
    fmt::print("viewer  {}\n", printable(page));
    std::fflush(stdout);                                       // before the browser's own lines
    const std::string absolute = fs::absolute(page).string();  // no argument that begins with a hyphen
    const Opening opening = has_display() ? open_page(absolute) : Opening::NoOpener;
    if (!has_display())
        fmt::print("not opened: there is no display; open the file in a browser\n");
    else if (opening == Opening::NoOpener)
        fmt::print("not opened: xdg-open is not installed; open the file in a browser\n");
    else if (opening == Opening::Failed)
        fmt::print("not opened: xdg-open failed; open the file in a browser\n");
}

}  // namespace arris
