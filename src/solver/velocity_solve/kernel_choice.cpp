// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the BLAS kernel of a program, so that a run gives the same bytes on every processor that has this
// kernel.
//
// OpenBLAS has a kernel for each type of processor. They round differently, and cloth that crumples follows
// another path after a difference in the last bit. OpenBLAS reads OPENBLAS_CORETYPE once, when the library is
// loaded, before any code of the program can set it. So the program sets the variable and replaces itself by
// itself, before main. (What runs earlier, in .preinit_array, runs before libc has an environment.)
//
// The same environment keeps OpenBLAS from starting threads: none of them would ever be used, and when they
// start they wait awake, a tenth of a second.
//
// Only programs do that: no other file refers to this one, and src/solver/CMakeLists.txt asks for it where a
// program is linked. A shared library that links arris_solver computes with the kernel of its process.
#if defined(__x86_64__)

#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace {

constexpr const char *kKernel = "OPENBLAS_CORETYPE", *kThreads = "OPENBLAS_NUM_THREADS",
                     *kIsChosen = "ARRIS_CHOSE_BLAS_KERNEL";
constexpr const char *kOnlyKernel = "kernel", *kKernelAndThreads = "kernel and threads";

[[gnu::constructor]] void choose_kernel(int, char** argv, char**)
{
    if (const char* chosen = std::getenv(kIsChosen)) {  // programs that this one starts choose for themselves
        if (std::strcmp(chosen, kKernelAndThreads) == 0) unsetenv(kThreads);
        unsetenv(kIsChosen);
        unsetenv(kKernel);
        return;
    }
    if (std::getenv(kKernel)) return;
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
    const bool are_threads_free = std::getenv(kThreads) == nullptr;
    if ((!are_threads_free || setenv(kThreads, "1", 1) == 0) && setenv(kKernel, "Haswell", 1) == 0 &&
        setenv(kIsChosen, are_threads_free ? kKernelAndThreads : kOnlyKernel, 1) == 0)
        execv("/proc/self/exe", argv);
    unsetenv(kIsChosen);  // not executed again: the kernel is that which OpenBLAS has chosen
    unsetenv(kKernel);
    if (are_threads_free) unsetenv(kThreads);
}

}  // namespace

#endif

extern "C" {
extern const char arris_kernel_choice;
const char arris_kernel_choice = 0;
}
