// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "geometry/obstacle_input/obstacle_file.h"

namespace arris {

/// Encodes an importer process's reply: a mesh with warnings and notes. Uses this machine's byte layout; a
/// reply is never stored.
std::string encode_reply(const ObstacleFile& file);

/// Encodes the reply for a file that cannot be read.
std::string encode_refusal(const std::string& why);

/// Decodes an untrusted reply. Lengths are compared with the bytes before any allocation. The mesh must pass
/// `validate` and lie within 1e6 m; texts are shortened to one line each. Throws InputError with the
/// refusal's own text, or with what is wrong with the reply.
ObstacleFile decode_reply(std::string_view bytes);

}  // namespace arris
