// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/blas_kernel.h"

#include <openblas_config.h>

extern "C" char* openblas_get_corename();

namespace arris {

std::string blas_kernel()
{
    return openblas_get_corename();
}

}  // namespace arris
