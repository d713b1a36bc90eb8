# SPDX-License-Identifier: Apache-2.0
# The ports of the field's lookup to other shading languages, complete in LAMBENT_PORTS_DIR: where a port says
# @LAMBENT_CONSTANTS@, it gets those constants of the lookup's headers that it names, in its own language.
set(LAMBENT_PORTS_DIR ${PROJECT_BINARY_DIR}/ports)
set(lambent_lookup_headers
  field/lookup/lookup.h field/probes/irradiance_encoding.h field/probes/probe_grid.h shared/packing.h)
list(TRANSFORM lambent_lookup_headers PREPEND ${PROJECT_SOURCE_DIR}/src/)

# lambent_port(<file name> <declaration of a constant, where \\1 is its type, \\2 its name, \\3 its value>)
function(lambent_port name declaration)
  set(port ${PROJECT_SOURCE_DIR}/src/field/lookup/ports/${name})
  file(READ ${port} text)
  set(constants)
  foreach(header IN LISTS lambent_lookup_headers)
    set(pattern "^const ([a-z]+) (k[A-Za-z0-9]+) = ([^;]+).*$")
    file(STRINGS ${header} lines REGEX "${pattern}")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "${pattern}" "\\2" constant "${line}")
      if(text MATCHES "[^A-Za-z0-9]${constant}[^A-Za-z0-9]")
        string(REGEX REPLACE "${pattern}" "${declaration}" line "${line}")
        string(APPEND constants "${line};\n")
      endif()
    endforeach()
  endforeach()
  string(STRIP "${constants}" LAMBENT_CONSTANTS)
  configure_file(${port} ${LAMBENT_PORTS_DIR}/${name} @ONLY)
endfunction()

# Changed headers write the ports again
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lambent_lookup_headers})
lambent_port(lookup.hlsl "static const \\1 \\2 = \\3")
lambent_port(lookup.wgsl "const \\2 = \\3")
lambent_port(lookup_webgl.glsl "const \\1 \\2 = \\3")
