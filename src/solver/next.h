// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// The answer to the end of a round of the step's stages 4 to 6 (rounds.h).
enum class Next {
    Assemble,  ///< another round, with a new system
    Resume,    ///< another round: constraints were added to the system
    Accept,    ///< the proposal becomes the state
    Fail       ///< the attempt has failed
};

}  // namespace arris
