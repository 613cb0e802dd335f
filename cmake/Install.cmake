# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install build` installs, in two components: the program with its pages and scenes, of which `cpack` makes
# a Debian package, and the libraries with their headers for find_package(arris).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS arris RUNTIME COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/arris.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/arris.bash RENAME arris COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/arris_blender.zip DESTINATION ${CMAKE_INSTALL_DATADIR}/arris COMPONENT program)
# Scenes name their meshes as ../meshes/...
install(DIRECTORY data/scenes data/meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/arris COMPONENT program)

set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/arris)
foreach(layer geometry physics solver)
  set_target_properties(arris_${layer} PROPERTIES EXPORT_NAME ${layer})
  install(DIRECTORY src/${layer} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/arris COMPONENT development
          FILES_MATCHING PATTERN "*.h")
endforeach()
install(TARGETS arris_geometry arris_physics arris_solver EXPORT arrisTargets ARCHIVE COMPONENT development
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/arris)
install(EXPORT arrisTargets NAMESPACE arris:: DESTINATION ${cmake_folder} COMPONENT development)
configure_package_config_file(cmake/arrisConfig.cmake.in ${PROJECT_BINARY_DIR}/arrisConfig.cmake
                              INSTALL_DESTINATION ${cmake_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/arrisConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/arrisConfig.cmake ${PROJECT_BINARY_DIR}/arrisConfigVersion.cmake
        cmake/LibraryDependencies.cmake DESTINATION ${cmake_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME arris)
set(CPACK_PACKAGE_CONTACT "Arris maintainers")
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME arris)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "xdg-utils, bash-completion")
include(CPack)
