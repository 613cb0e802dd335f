// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/blas_kernel.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace arris {
namespace {

TEST(BlasKernel, IsHaswellsWhereTheProcessorHasItAndNoOtherIsAskedFor)
{
#if defined(__x86_64__)
    if (std::getenv("OPENBLAS_CORETYPE")) {  // scripts/test with another kernel
        EXPECT_STRCASEEQ(blas_kernel().c_str(), std::getenv("OPENBLAS_CORETYPE"));
        return;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        EXPECT_EQ(blas_kernel(), "Haswell");
    }
#endif
    EXPECT_FALSE(blas_kernel().empty());
}

TEST(BlasKernel, ItsChoiceIsNotPassedOnToOtherPrograms)
{
    EXPECT_EQ(std::getenv("ARRIS_CHOSE_BLAS_KERNEL"), nullptr);
    std::ifstream in("/proc/self/environ");  // as this program was started
    const std::string started((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (started.find("ARRIS_CHOSE_BLAS_KERNEL=") != std::string::npos) {
        EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
    }
}

}  // namespace
}  // namespace arris
