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
#include "geometry/obstacle_input/import_command.h"

int main(int argc, char** argv)
{
    // A closed pipe or a file-size limit must make write() fail, not kill the process.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // Internal command: the program starts itself with it to read an untrusted mesh file in a separate
    // process. It ends without running destructors: after a broken file those of the import library are not
    // safe.
    if (argc > 1 && std::strcmp(argv[1], "import-obstacle") == 0)
        std::_Exit(arris::import_obstacle_command(argc - 2, argv + 2));
    try {
        const int status = arris::run_command_line(argc, argv);
        // Lost output, such as a full disk, is an error.
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
            fmt::print(stderr, "arris: standard output: {}\n", std::strerror(errno));
            return 1;
        }
        return status;
    } catch (const arris::InputError& error) {
        fmt::print(stderr, "arris: {}\n", arris::printable(error.what()));
        return 2;
    } catch (const std::exception& error) {
        // A failure that is not the input's fault, such as a full disk or too little memory.
        fmt::print(stderr, "arris: {}\n", arris::printable(arris::error_line(error)));
        return 1;
    }
}
