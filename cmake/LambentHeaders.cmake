# SPDX-License-Identifier: Apache-2.0
# Libraries that are headers alone: taken from LAMBENT_HEADERS_DIR, where it is given, else as installed.
set(LAMBENT_HEADERS_DIR "" CACHE PATH
  "A folder with glm/, tl/, Eigen/, vulkan/ and vk_video/, for machines that have none of them installed")

function(lambent_headers target package header)
  if(LAMBENT_HEADERS_DIR)
    if(NOT EXISTS ${LAMBENT_HEADERS_DIR}/${header})
      message(FATAL_ERROR "LAMBENT_HEADERS_DIR: ${LAMBENT_HEADERS_DIR} has no ${header}")
    endif()
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} SYSTEM INTERFACE ${LAMBENT_HEADERS_DIR})
  else()
    find_package(${package} ${ARGN} REQUIRED)
  endif()
endfunction()

lambent_headers(glm::glm glm glm/glm.hpp)
lambent_headers(tl::expected tl-expected tl/expected.hpp)
lambent_headers(Eigen3::Eigen Eigen3 Eigen/Dense 3.4 NO_MODULE)
