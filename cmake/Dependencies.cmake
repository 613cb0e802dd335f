# SPDX-License-Identifier: GPL-3.0-or-later
# Finds all dependencies: those of the libraries, the program, the tests and the benchmarks.

include(${CMAKE_CURRENT_LIST_DIR}/LibraryDependencies.cmake)
arris_find_package(tomlplusplus libtomlplusplus-dev CONFIG)
arris_find_package(CLI11 libcli11-dev CONFIG)
arris_find_library(muparser muParser.h muparser libmuparser-dev)
if(ARRIS_TESTS)
  arris_find_package(GTest libgtest-dev)
endif()
if(ARRIS_BENCH)
  arris_find_package(benchmark libbenchmark-dev)
endif()
