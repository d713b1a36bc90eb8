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

# The lookup for shaders of engines: -I to LAMBENT_SHADER_DIR, then #include "field/shaders/field_lookup.glsl"
# (GLSL), or "field/ports/lookup.hlsl"; lookup.wgsl is put before a shader's own text. Headers that shaders include
# say LAMBENT_BEGIN.
set(LAMBENT_SHADER_DIR ${CMAKE_INSTALL_INCLUDEDIR}/lambent/shaders)
file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/*/*.h)
set(shader_files field/lookup.inl.h field/ports/lookup.hlsl field/ports/lookup.wgsl
  field/shaders/field_lookup.glsl field/shaders/store.glsl field/shaders/tiles.glsl)
foreach(header IN LISTS headers)
  file(STRINGS ${PROJECT_SOURCE_DIR}/src/${header} begins REGEX "^LAMBENT_BEGIN")
  if(begins OR header STREQUAL shared/lang.h)
    list(APPEND shader_files ${header})
  endif()
endforeach()
foreach(file IN LISTS shader_files)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/src/${file} DESTINATION ${LAMBENT_SHADER_DIR}/${folder}
    COMPONENT library)
endforeach()

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
  INSTALL_DESTINATION ${LAMBENT_INSTALL_CMAKE_DIR} PATH_VARS LAMBENT_SHADER_DIR)
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
