// SPDX-License-Identifier: Apache-2.0
// The lookup of the field for shaders of engines:
//   vec3 field_irradiance(FieldRecord field, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws)
// returns the indirect irradiance at a point [W/m^2]. The record is plain data, and comes in push
// constants or in any buffer of scalar layout. A shader defines the settings of the field that
// differ from the defaults before it includes this file. It finds by the probes' distances which
// probes a point sees.
//
// A shader that can trace rays may see probes as FieldSettings::visibility says. Before it includes
// this file, it defines LAMBENT_VISIBILITY_RAYS and
//   bool field_occluded(vec3 origin_ws, vec3 direction_ws, float distance)
// which tells whether a ray meets anything nearer than `distance` [m], by a ray query or a pipeline
// of rays. There is then a second lookup beside the first:
//   vec3 field_irradiance_by_rays(FieldRecord field, vec3 position_ws, vec3 normal_ws,
//                                 vec3 to_viewer_ws)
// Of fields of hybrid visibility few points ask for a ray; of exact visibility, each point asks for
// up to eight a volume. Of all other fields both lookups are the same.
#ifndef LAMBENT_SHADERS_FIELD_LOOKUP_GLSL
#define LAMBENT_SHADERS_FIELD_LOOKUP_GLSL

#include "field/lookup/field_record.h"
#include "field/probes/irradiance_encoding.h"

// The defaults of FieldSettings
#ifndef LAMBENT_IRRADIANCE_TEXELS
#define LAMBENT_IRRADIANCE_TEXELS 4
#endif
#ifndef LAMBENT_DISTANCE_TEXELS
#define LAMBENT_DISTANCE_TEXELS 14
#endif
#if LAMBENT_IRRADIANCE_TEXELS < 2 || LAMBENT_IRRADIANCE_TEXELS > 16 || \
    LAMBENT_IRRADIANCE_TEXELS % 2 != 0
#error "LAMBENT_IRRADIANCE_TEXELS is not an even number from 2 to 16"
#endif
#if LAMBENT_DISTANCE_TEXELS < 4 || LAMBENT_DISTANCE_TEXELS > 32
#error "LAMBENT_DISTANCE_TEXELS is not between 4 and 32"
#endif
#ifndef LAMBENT_IRRADIANCE_FORMAT
#define LAMBENT_IRRADIANCE_FORMAT kRgb9e5
#endif
#ifndef LAMBENT_DISTANCE_FORMAT
#define LAMBENT_DISTANCE_FORMAT kRg16f
#endif

// These constants replace our kernels' specialisation constants, whose ids belong to the engine
// here
#define LAMBENT_FIELD_PROBES_SHADERS_TILES_GLSL
const int kIrradianceTexels = LAMBENT_IRRADIANCE_TEXELS;
const int kDistanceTexels = LAMBENT_DISTANCE_TEXELS;
const uint kIrradianceFormat = LAMBENT_IRRADIANCE_FORMAT;
const uint kDistanceFormat = LAMBENT_DISTANCE_FORMAT;

// The field that is looked up takes the place of our kernels' arguments
FieldRecord lambent_field;
#define args lambent_field
#include "field/probes/shaders/store.glsl"
#undef args
#include "field/correction/shaders/corrections.glsl"

float fetch_correction(ProbeGrid grid, int volume, vec3 position_ws, vec3 normal_ws) {
  return correction_of(lambent_field.corrections, grid, volume, position_ws, normal_ws);
}

#include "field/lookup/lookup.inl.h"

vec3 field_irradiance(FieldRecord field, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws) {
  lambent_field = field;
  return lookup_irradiance(field.volumes, position_ws, normal_ws, to_viewer_ws, infinity());
}

#ifdef LAMBENT_VISIBILITY_RAYS
uvec2 fetch_cell_visibility(int lowest) {
  return uvec2(lambent_field.cell_visibility.at[2 * lowest],
               lambent_field.cell_visibility.at[2 * lowest + 1]);
}

#include "field/lookup/shaders/lookup_by_rays.glsl"

vec3 field_irradiance_by_rays(FieldRecord field, vec3 position_ws, vec3 normal_ws,
                              vec3 to_viewer_ws) {
  if (field.visibility == kVisibilityMoments) {
    return field_irradiance(field, position_ws, normal_ws, to_viewer_ws);
  }
  lambent_field = field;
  return lookup_irradiance_by_rays(field.volumes, position_ws, normal_ws, to_viewer_ws,
                                   field.visibility == kVisibilityExact);
}
#endif

#endif
