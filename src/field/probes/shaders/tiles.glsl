// SPDX-License-Identifier: Apache-2.0
// What all fields of the same settings have in common; kernels are made for it.
#ifndef LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL
#define LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL

layout(constant_id = 0) const int kIrradianceTexels = 4;  // along an edge
layout(constant_id = 1) const int kDistanceTexels = 14;
layout(constant_id = 2) const uint kIrradianceFormat = 0u;
layout(constant_id = 3) const uint kDistanceFormat = 0u;
layout(constant_id = 4) const int kVolumes = 1;
layout(constant_id = 5) const int kLookups = 1;  // that a surfel may have

#endif
