// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "geometry/obstacle_input/obstacle_file.h"

namespace arris {

/// What an importer process writes: a mesh with warnings and notes. Bytes of this machine's own layout; they
/// live for as long as the process.
std::string encode_reply(const ObstacleFile& file);

/// What it writes instead where the file cannot be read.
std::string encode_refusal(const std::string& why);

/// Takes a reply apart without trusting it: lengths are held against the bytes before anything is allocated,
/// the mesh must pass `validate` and lie within 1e6 m, texts are cut to one line each. Throws InputError: the
/// refusal's own text, or what is wrong with the reply.
ObstacleFile decode_reply(std::string_view bytes);

/// `text` on one line, control characters as spaces, at most 500 bytes.
std::string one_line(std::string_view text);

}  // namespace arris
