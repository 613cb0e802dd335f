// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <exception>

#include "app/command_line.h"
#include "app/printable.h"
#include "geometry/input_error.h"

int main(int argc, char** argv)
{
    try {
        return arris::run_command_line(argc, argv);
    } catch (const arris::InputError& error) {
        fmt::print(stderr, "arris: {}\n", arris::printable(error.what()));
        return 2;
    } catch (const std::exception& error) {
        // A disk that refuses, memory that is not there: not the input's fault.
        fmt::print(stderr, "arris: {}\n", arris::printable(error.what()));
        return 1;
    }
}
