// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// The OpenBLAS kernel that this process computes with, such as "Haswell". The kernel decides the last bits
/// of a factorisation. Programs that link arris_solver compute with Haswell's kernel on every x86-64
/// processor that has AVX2 and FMA (`kernel_choice.cpp`), and with the kernel that OpenBLAS chooses on any
/// other. The environment variable OPENBLAS_CORETYPE overrides both.
std::string blas_kernel();

}  // namespace arris
