// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace arris {

/// The unit of a 3MF file's coordinates in metres: the attribute `unit` of its first model (3D Manufacturing
/// Format core specification 1.3, section 3.4; millimetres where there is none). Throws InputError, without
/// the file's name, for bytes that are no whole ZIP archive, an archive without a model, and a unit that the
/// specification does not have.
double three_mf_unit(std::string_view bytes);

}  // namespace arris
