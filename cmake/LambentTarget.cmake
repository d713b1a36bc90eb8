# SPDX-License-Identifier: Apache-2.0
# What every target of ours is compiled with.

# With `ALONE` each source is a translation unit, whatever LAMBENT_UNITY says.
function(lambent_compile_options target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "ALONE" "" "")
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  # The same bits from every compiler and machine: no silent fusing of products and sums.
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor -ffp-contract=off)
  if(LAMBENT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LAMBENT_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LAMBENT_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${LAMBENT_SANITIZE})
  endif()
  if(LAMBENT_PRECOMPILE)
    # What ccache asks for, to keep what was compiled with precompiled headers
    target_compile_options(${target} PRIVATE $<IF:$<CXX_COMPILER_ID:GNU>,-fpch-preprocess,SHELL:-Xclang -fno-pch-timestamp>)
  endif()
  if(LAMBENT_UNITY AND NOT arg_ALONE)
    # Called when all folders have added their sources
    cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY \"${PROJECT_SOURCE_DIR}\" CALL lambent_unite ${target})")
  endif()
endfunction()

# For what spends its time in the library, or waits for others
set(LAMBENT_OPTIMISED_LESS)
if(LAMBENT_TEST_BUILD)
  set(LAMBENT_OPTIMISED_LESS -O1)
endif()

# Sources of a folder become one translation unit, or several where they are more than this. More would save little
# parsing, and leave cores without work at the end of a build.
set(LAMBENT_UNITY_SIZE 16 CACHE STRING "Sources of a translation unit, at most, with LAMBENT_UNITY")
mark_as_advanced(LAMBENT_UNITY_SIZE)

# lambent_unite(<target> [<source>...]): all of its sources, if none are named. What differs in flags stays alone: CMake
# leaves out sources with options or definitions of their own.
function(lambent_unite target)
  set(sources ${ARGN})
  if(NOT sources)
    get_target_property(sources ${target} SOURCES)
  endif()
  get_target_property(folder ${target} SOURCE_DIR)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} NORMALIZE)
    cmake_path(GET source PARENT_PATH unit)
    cmake_path(RELATIVE_PATH unit BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER ${unit} unit)
    math(EXPR part "0${count_${unit}} / ${LAMBENT_UNITY_SIZE}")
    math(EXPR count_${unit} "0${count_${unit}} + 1")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${unit}_${part})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes the sources for headers, whose classes must not have members of types without linkage
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# Headers that most files of a target include, compiled once, where LAMBENT_PRECOMPILE says so. Builds without show what
# a file forgets to include. With `CLANG` for that compiler alone: through precompiled headers GCC 12 warns of its own
# library.
function(lambent_precompile target)
  cmake_parse_arguments(PARSE_ARGV 1 argument "CLANG" "" "")
  if(LAMBENT_PRECOMPILE AND (NOT argument_CLANG OR CMAKE_CXX_COMPILER_ID MATCHES Clang))
    target_precompile_headers(${target} PRIVATE ${argument_UNPARSED_ARGUMENTS})
  endif()
endfunction()

# Sources of the library whose loops should become vector instructions and whose square roots need not set errno, each
# compiled with the OPTIONS given after that word, too. They read no precompiled header: it is made without these flags,
# and compilers refuse it. Sanitizers have no use for vectors. But these loops take most of a program's time, and are
# optimised even where nothing else is.
function(lambent_vector_sources)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "OPTIONS")
  set(optimization -O3)
  if(LAMBENT_SANITIZE)
    set(optimization -O1)
  endif()
  set_source_files_properties(${arg_UNPARSED_ARGUMENTS} TARGET_DIRECTORY lambent PROPERTIES
    SKIP_PRECOMPILE_HEADERS ON
    COMPILE_OPTIONS "${optimization};-fno-math-errno;-fno-trapping-math;${arg_OPTIONS}")
endfunction()
