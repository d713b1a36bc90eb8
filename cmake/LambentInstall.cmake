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
  COMPONENT library FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")
install(EXPORT lambent NAMESPACE lambent:: FILE lambent-targets.cmake
  DESTINATION ${LAMBENT_INSTALL_CMAKE_DIR} COMPONENT library)

# For shaders of engines: -I to LAMBENT_SHADER_DIR, then #include "field_lookup.glsl" and "ray_results.h" (GLSL), or
# "lookup.hlsl"; lookup.wgsl and lookup_webgl.glsl are put before a shader's own text. Beside them lies what they include of src/.
set(LAMBENT_SHADER_DIR ${CMAKE_INSTALL_INCLUDEDIR}/lambent/shaders)
file(GLOB open_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/lambent/shaders/*)
set(shader_files)
while(open_files)
  list(POP_FRONT open_files file)
  # Installed files are read again at the next configuration, as they may include others by then
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} includes REGEX "^#include \"")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" include "${include}")
    if(EXISTS ${PROJECT_SOURCE_DIR}/src/${include} AND NOT include IN_LIST shader_files)
      list(APPEND shader_files ${include})
      list(APPEND open_files ${PROJECT_SOURCE_DIR}/src/${include})
    endif()
  endforeach()
endwhile()
foreach(file IN LISTS shader_files)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/src/${file} DESTINATION ${LAMBENT_SHADER_DIR}/${folder}
    COMPONENT library)
endforeach()

install(FILES ${LAMBENT_PORTS_DIR}/lookup.hlsl ${LAMBENT_PORTS_DIR}/lookup.wgsl
  ${LAMBENT_PORTS_DIR}/lookup_webgl.glsl DESTINATION ${LAMBENT_SHADER_DIR} COMPONENT library)

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
