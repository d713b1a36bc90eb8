// SPDX-License-Identifier: Apache-2.0
// The lookup of the field for shaders of engines: indirect irradiance at a point [W/m^2], from
//   vec3 field_irradiance(FieldRecord field, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws)
// The record is plain data: it comes in push constants or in any buffer, of scalar layout. Settings
// of the field that are not its defaults are defined before this file is included.
#ifndef LAMBENT_SHADERS_FIELD_LOOKUP_GLSL
#define LAMBENT_SHADERS_FIELD_LOOKUP_GLSL

#include "field/lookup/field_record.h"

// As FieldSettings has them
#ifndef LAMBENT_IRRADIANCE_TEXELS
#define LAMBENT_IRRADIANCE_TEXELS 4
#endif
#ifndef LAMBENT_DISTANCE_TEXELS
#define LAMBENT_DISTANCE_TEXELS 14
#endif
#ifndef LAMBENT_IRRADIANCE_FORMAT
#define LAMBENT_IRRADIANCE_FORMAT kRgb9e5
#endif
#ifndef LAMBENT_DISTANCE_FORMAT
#define LAMBENT_DISTANCE_FORMAT kRg16f
#endif

// In place of our kernels' specialisation constants, whose numbers are the engine's own here
#define LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL
const int kIrradianceTexels = LAMBENT_IRRADIANCE_TEXELS;
const int kDistanceTexels = LAMBENT_DISTANCE_TEXELS;
const uint kIrradianceFormat = LAMBENT_IRRADIANCE_FORMAT;
const uint kDistanceFormat = LAMBENT_DISTANCE_FORMAT;

// The field that is looked up, in the place of our kernels' arguments
FieldRecord lambent_field;
#define args lambent_field
#include "field/probes/shaders/store.glsl"
#undef args
#include "field/lookup/lookup.inl.h"

vec3 field_irradiance(FieldRecord field, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws) {
  lambent_field = field;
  return lookup_irradiance(field.volumes, position_ws, normal_ws, to_viewer_ws);
}

#endif
