// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/import_command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_import.h"
#include "geometry/obstacle_input/obstacle_reply.h"

namespace arris {
namespace {

std::string make_reply(char** arguments)
{
    try {
        const std::string unit = arguments[1];
        const std::string up = arguments[2];
        return encode_reply(
            import_obstacle(arguments[3], unit == "-" ? std::nullopt : std::optional<double>(std::stod(unit)),
                            up == "-" ? std::nullopt : std::optional<char>(up[0])));
    } catch (const InputError& error) {
        return encode_refusal(error.what());
    } catch (const std::bad_alloc&) {
        return encode_refusal("its import needs more memory than it may have");
    } catch (const std::exception& error) {
        return encode_refusal(std::string("cannot be imported: ") + error.what());
    }
}

bool write_all(int descriptor, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

}  // namespace

int import_obstacle_command(int count, char** arguments)
{
    if (count != 4) return 2;
    return write_all(std::atoi(arguments[0]), make_reply(arguments)) ? 0 : 1;
}

}  // namespace arris
