# SPDX-License-Identifier: GPL-3.0-or-later
# Finds what the libraries need, for this project and for one that uses its install. All are Debian packages; the error
# message names a missing one.

function(arris_missing what package)
  message(FATAL_ERROR "${what} was not found. On Debian: apt-get install ${package}")
endfunction()

macro(arris_find_package name package)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    arris_missing(${name} ${package})
  endif()
endmacro()

# Makes an imported target `target` from the header and library of a library without a CMake package.
function(arris_find_library target header library package)
  cmake_parse_arguments(ARG "" "" "SUFFIXES" ${ARGN})
  if(TARGET ${target})
    return()
  endif()
  string(MAKE_C_IDENTIFIER "${target}" id)
  find_path(${id}_INCLUDE ${header} PATH_SUFFIXES ${ARG_SUFFIXES})
  find_library(${id}_LIBRARY ${library})
  mark_as_advanced(${id}_INCLUDE ${id}_LIBRARY)
  if(NOT ${id}_INCLUDE OR NOT ${id}_LIBRARY)
    arris_missing("${library} (${header})" ${package})
  endif()
  add_library(${target} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${${id}_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${${id}_INCLUDE})
endfunction()

find_package(Threads REQUIRED)
arris_find_package(CGAL libcgal-dev 5.5 CONFIG)
arris_find_package(Boost libboost-dev)
arris_find_package(assimp libassimp-dev 5.2 CONFIG)
arris_find_package(Eigen3 libeigen3-dev 3.4 NO_MODULE)
arris_find_package(TBB libtbb-dev)
arris_find_package(fmt libfmt-dev CONFIG)
arris_find_package(nlohmann_json nlohmann-json3-dev CONFIG)
arris_find_package(ZLIB zlib1g-dev)
arris_find_package(EXPAT libexpat1-dev)
arris_find_library(cholmod cholmod.h cholmod libsuitesparse-dev SUFFIXES suitesparse)
arris_find_library(openblas openblas_config.h openblas libopenblas-dev SUFFIXES openblas x86_64-linux-gnu openblas-pthread)
arris_find_library(nlopt nlopt.hpp nlopt_cxx libnlopt-cxx-dev)
