# SPDX-License-Identifier: Apache-2.0
# Shaders, compiled to SPIR-V when the library is built and embedded in it.

find_program(LAMBENT_GLSLC glslc)

# lambent_shaders(<target> <file>...): NAME.STAGE.glsl, in the current folder or below, becomes
# `lambent::vulkan::Spirv lambent::shaders::NAME_STAGE()`, declared in the header "shaders/NAME_STAGE.h".
# Shaders include files from src/ and include/, those of tests also from tests/. With LAMBENT_SPIRV_DIR, the modules
# are taken from there, as an earlier build left them in build/.../spirv: for machines without a shader compiler.
function(lambent_shaders target)
  set(folder ${PROJECT_BINARY_DIR}/spirv)
  file(MAKE_DIRECTORY ${folder}/shaders)
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME)
    if(NOT name MATCHES "^([a-z0-9_]+)\\.(comp|rgen|rchit|rahit|rmiss)\\.glsl$")
      message(FATAL_ERROR "${file} is not named NAME.STAGE.glsl")
    endif()
    set(shader ${CMAKE_MATCH_1}_${CMAKE_MATCH_2})
    set(stage ${CMAKE_MATCH_2})
    set(module ${folder}/${shader}.inc)
    if(LAMBENT_SPIRV_DIR)
      configure_file(${LAMBENT_SPIRV_DIR}/${shader}.inc ${module} COPYONLY)
    else()
      # Ray stages go by names of their own to the compiler
      string(REPLACE "comp" "compute" stage ${stage})
      add_custom_command(OUTPUT ${module} DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file} DEPFILE ${module}.d VERBATIM
        COMMAND ${LAMBENT_GLSLC} -x glsl -fshader-stage=${stage} --target-env=vulkan1.2 -O -Werror -mfmt=num
          -I ${PROJECT_SOURCE_DIR}/src -I ${PROJECT_SOURCE_DIR}/include -I ${PROJECT_SOURCE_DIR}/tests -MD -MF ${module}.d -o ${module} ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    endif()
    # Folders add shaders to a target of another folder, which sees no rules of theirs but through a target
    add_custom_target(${shader}_spirv DEPENDS ${module})
    add_dependencies(${target} ${shader}_spirv)
    file(CONFIGURE OUTPUT ${folder}/shaders/${shader}.h @ONLY CONTENT
"// Generated from @file@.
#pragma once
#include <cstdint>
#include <span>
namespace lambent::shaders {
std::span<const std::uint32_t> @shader@();
}
")
    file(CONFIGURE OUTPUT ${folder}/${shader}.cpp @ONLY CONTENT
"// Generated from @file@.
#include \"shaders/@shader@.h\"
namespace lambent::shaders {
std::span<const std::uint32_t> @shader@() {
  static constexpr std::uint32_t kWords[] = {
#include \"@module@\"
  };
  return kWords;
}
}  // namespace lambent::shaders
")
    set_source_files_properties(${folder}/${shader}.cpp TARGET_DIRECTORY ${target} PROPERTIES OBJECT_DEPENDS ${module})
    target_sources(${target} PRIVATE ${folder}/${shader}.cpp)
  endforeach()
  target_include_directories(${target} PRIVATE $<BUILD_INTERFACE:${folder}>)
endfunction()

# lambent_folder_shaders(<target>): every shader with a stage in the current folder's shaders/.
function(lambent_folder_shaders target)
  file(GLOB files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}
    ${CMAKE_CURRENT_SOURCE_DIR}/shaders/*.*.glsl)
  lambent_shaders(${target} ${files})
endfunction()
