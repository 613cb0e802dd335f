# SPDX-License-Identifier: GPL-3.0-or-later
# Embeds a file of any content and size in a target. The assembler's .incbin copies the bytes, which is fast and has no
# limit on string literals (g++ and clang on Linux).
#
#   arris_embed(arris_app report_template report_template.html)
#
# makes `#include "embedded/report_template.h"` declare `std::string_view arris::embedded::report_template()`.
# The file may also be made by the build in this directory (OUTPUT of a custom command).
function(arris_embed target name file)
  get_filename_component(ARRIS_EMBED_FILE ${file} ABSOLUTE)
  set(ARRIS_EMBED_NAME ${name})
  string(REGEX REPLACE "([\\\\\"])" "\\\\\\1" ARRIS_EMBED_PATH "${ARRIS_EMBED_FILE}")
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embedded.h.in ${folder}/${name}.h @ONLY)
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embedded.cpp.in ${folder}/${name}.cpp @ONLY)
  set_source_files_properties(${folder}/${name}.cpp PROPERTIES
    OBJECT_DEPENDS ${ARRIS_EMBED_FILE} SKIP_PRECOMPILE_HEADERS ON)
  target_sources(${target} PRIVATE ${folder}/${name}.cpp)
  target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
