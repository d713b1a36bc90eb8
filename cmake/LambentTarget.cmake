# SPDX-License-Identifier: Apache-2.0
# What every target of ours is compiled with.

function(lambent_compile_options target)
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
# and compilers refuse it. Sanitizers have no use for vectors.
function(lambent_vector_sources)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "OPTIONS")
  set(optimization -O3)
  if(LAMBENT_SANITIZE)
    set(optimization)
  endif()
  set_source_files_properties(${arg_UNPARSED_ARGUMENTS} TARGET_DIRECTORY lambent PROPERTIES
    SKIP_PRECOMPILE_HEADERS ON
    COMPILE_OPTIONS "${optimization};-fno-math-errno;-fno-trapping-math;${arg_OPTIONS}")
endfunction()
