# SPDX-License-Identifier: GPL-3.0-or-later
# Compile options of every target, in one INTERFACE target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # ccache needs this sloppiness to cache files that use a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

# The Python module links the libraries of the program. Nobody replaces their functions, so the compiler may inline them.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_library(arris_options INTERFACE)
target_compile_options(arris_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -fno-semantic-interposition
  -Wno-restrict       # false alarms on std::string in GCC 12 (bug 105651)
  -ffp-contract=off   # makes results independent of fused multiply-add
  -frounding-math)    # CGAL's interval arithmetic changes the rounding mode
# Eigen uses one thread: the project parallelises over elements, and results must not depend on the number of threads.
target_compile_definitions(arris_options INTERFACE EIGEN_DONT_PARALLELIZE)
if(ARRIS_WERROR)
  target_compile_options(arris_options INTERFACE -Werror)
endif()
if(ARRIS_SANITIZE)
  target_compile_options(arris_options INTERFACE -fsanitize=${ARRIS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(arris_options INTERFACE -fsanitize=${ARRIS_SANITIZE})
endif()

# Precompiles headers that are slow to parse and used in nearly every file.
function(arris_precompile target)
  target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore> <algorithm> <string>
                            <vector> <fmt/format.h>)
endfunction()
