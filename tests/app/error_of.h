// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/input_error.h"

namespace arris {

/// The line of the InputError that `action` throws; empty if it throws none.
template <class Action>
std::string error_of(Action action)
{
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace arris
