// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "app/command_line.h"
#include "app/text/error_line.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_import.h"

int main(int argc, char** argv)
{
    // A closed pipe and a file that may not grow are errors of a write, not reasons to vanish.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // Not a command for people: the program starts itself with it to read a mesh file at arm's length. It
    // ends without tidying up: what the import library has left behind of a broken file is nobody's business.
    if (argc > 1 && std::strcmp(argv[1], "import-obstacle") == 0)
        std::_Exit(arris::import_obstacle_command(argc - 2, argv + 2));
    try {
        const int status = arris::run_command_line(argc, argv);
        // Output that went nowhere was not given.
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
            fmt::print(stderr, "arris: standard output: {}\n", std::strerror(errno));
            return 1;
        }
        return status;
    } catch (const arris::InputError& error) {
        fmt::print(stderr, "arris: {}\n", arris::printable(error.what()));
        return 2;
    } catch (const std::exception& error) {
        // A disk that refuses, memory that is not there: not the input's fault.
        fmt::print(stderr, "arris: {}\n", arris::printable(arris::error_line(error)));
        return 1;
    }
}
