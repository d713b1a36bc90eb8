// SPDX-License-Identifier: Apache-2.0
// Specialisation constants: the settings of the field that a kernel is made for.
#ifndef LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL
#define LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL

layout(constant_id = 0) const int kIrradianceTexels = 4;  // along a tile's edge
layout(constant_id = 1) const int kDistanceTexels = 14;
layout(constant_id = 2) const uint kIrradianceFormat = 0u;
layout(constant_id = 3) const uint kDistanceFormat = 0u;
layout(constant_id = 4) const int kVolumes = 1;
layout(constant_id = 5) const int kLookups = 1;  // lookups per surfel

#endif
