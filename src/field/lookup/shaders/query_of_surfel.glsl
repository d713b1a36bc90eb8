// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_QUERY_OF_SURFEL_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_QUERY_OF_SURFEL_GLSL

#include "field/lookup/lookup_records.h"
#include "field/transport/surfel_math.h"
#include "shared/octahedral.h"

/// The query of the field's light on a surfel, along a ray from a probe. The twin of
/// Surfel::query_from().
QueryRecord query_of_surfel(SurfelRecord surfel, vec3 origin_ws, vec3 ray_direction) {
  vec3 normal_ws = decode_unit_vector(surfel.normal_ws);
  return QueryRecord(surfel.position_ws, normal_ws,
                     surfel_viewer(surfel.mirror_distance, normal_ws, ray_direction),
                     distance(surfel.position_ws, origin_ws));
}

#endif
