// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace arris {

/// The unit of a 3MF file's coordinates, in metres: the attribute `unit` of its first model, millimetres by
/// default (3D Manufacturing Format core specification 1.3, section 3.4). Throws InputError, without the
/// file's name, for an incomplete ZIP archive, an archive without a model, and a unit that is not in the
/// specification.
double three_mf_unit(std::string_view bytes);

}  // namespace arris
