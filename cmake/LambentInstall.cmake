# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: the library, its public headers and what find_package(lambent) reads (component
# "library"), and the program (component "program").
include(CMakePackageConfigHelpers)

set_target_properties(lambent PROPERTIES
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

set(LAMBENT_INSTALL_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/lambent)
install(TARGETS lambent EXPORT lambent COMPONENT library)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lambent DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT library FILES_MATCHING PATTERN "*.h")
install(EXPORT lambent NAMESPACE lambent:: FILE lambent-targets.cmake
  DESTINATION ${LAMBENT_INSTALL_CMAKE_DIR} COMPONENT library)

# Who links a static library links what it is made of, and must find that; a shared one brings it
# along.
get_target_property(lambent_type lambent TYPE)
if(lambent_type STREQUAL "STATIC_LIBRARY")
  set(LAMBENT_IS_STATIC TRUE)
else()
  set(LAMBENT_IS_STATIC FALSE)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lambent-config.cmake.in
  ${PROJECT_BINARY_DIR}/cmake/lambent-config.cmake
  INSTALL_DESTINATION ${LAMBENT_INSTALL_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/lambent-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/cmake/lambent-config.cmake
  ${PROJECT_BINARY_DIR}/cmake/lambent-config-version.cmake
  DESTINATION ${LAMBENT_INSTALL_CMAKE_DIR} COMPONENT library)

if(TARGET lambent_cli)
  file(RELATIVE_PATH lambent_lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(lambent_cli PROPERTIES INSTALL_RPATH "\$ORIGIN/${lambent_lib_from_bin}")
  install(TARGETS lambent_cli COMPONENT program)
endif()
