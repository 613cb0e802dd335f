// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace arris {

/// Refuses a COLLADA file (1.4 or 1.5) whose shape the import library would misread without a word, or with a
/// message that helps nobody. Throws InputError, without the file's name and with the line, for:
///  - text that is no well-formed XML;
///  - arrays, indices and placements with words that are no numbers, or with another number of them than
///  their
///    element has;
///  - accessors that reach beyond their array, vertices without positions;
///  - polygons with holes, and a unit that is not positive.
void check_dae(std::string_view bytes);

}  // namespace arris
