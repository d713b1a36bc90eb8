// SPDX-License-Identifier: Apache-2.0
// The conversion of a shaded hit to a surfel.
#ifndef LAMBENT_FIELD_TRANSPORT_SURFEL_MATH_H
#define LAMBENT_FIELD_TRANSPORT_SURFEL_MATH_H

#include "raytracing/shaded_hit.h"
#include "shared/octahedral.h"

LAMBENT_BEGIN

// What a surfel's ray hit. The numbers are those of SurfelKind.
const uint kSurfelSurface = 0u;
const uint kSurfelSky = 1u;
const uint kSurfelSolidSide = 2u;

/// A surfel, like struct Surfel.
struct SurfelRecord {
  vec3 position_ws;
  uint material;
  vec3 albedo_over_pi;
  uint normal_ws;
  vec3 light;
  uint geometric_normal_ws;
  uint kind;
  float gi_share;
  float mirror_distance;
};

/// The surfel of a ray that ended at a point, with the shaded `hit`. `irradiance` is the direct
/// light at the point.
LAMBENT_FN SurfelRecord surfel_record(vec3 position_ws, vec3 normal_ws, vec3 geometric_normal_ws,
                                      ShadedHitRecord hit, vec3 irradiance) {
  bool sky = (hit.flags & kSurfaceMissed) != 0u;
  bool counts = (hit.flags & kSurfaceDiscounted) == 0u;
  SurfelRecord surfel;
  surfel.position_ws = position_ws;
  surfel.material = hit.material;
  surfel.albedo_over_pi = hit.albedo_over_pi;
  surfel.normal_ws = encode_unit_vector(normal_ws);
  surfel.light = sky ? hit.radiance : irradiance;
  surfel.geometric_normal_ws = encode_unit_vector(geometric_normal_ws);
  surfel.kind = sky ? kSurfelSky : counts ? kSurfelSurface : kSurfelSolidSide;
  surfel.gi_share = hit.gi_share;
  surfel.mirror_distance = hit.mirror_distance;
  return surfel;
}

/// The distance that a probe's ray counts as [m], to what it hit first. `length` is that from the
/// probe to the surfel.
LAMBENT_FN float first_hit_distance(float mirror_distance, float length) {
  return mirror_distance > 0.0f ? mirror_distance : length;
}

/// The direction from a surfel to the viewer of its lookup: against the probe's ray. Where a mirror
/// shows the surfel, its viewer is not stored, and the direction is the normal. The air along the
/// normal is then assumed to be free, as far as the surfel is from the probe.
LAMBENT_FN vec3 surfel_viewer(float mirror_distance, vec3 normal_ws, vec3 ray_direction) {
  return mirror_distance > 0.0f ? normal_ws : -ray_direction;
}

/// The radiance that a surfel sends along its ray. If `reflects`, a surface sends the light that
/// arrives, times its reflectance, and else nothing; the sky sends its radiance unchanged. The
/// fourth channel is 1 for rays that count, else 0.
LAMBENT_FN vec4 sent_radiance(uint kind, vec3 albedo_over_pi, vec3 arrives, bool reflects) {
  vec3 reflectance = kind == kSurfelSky ? vec3(1.0f) : reflects ? albedo_over_pi : vec3(0.0f);
  return vec4(reflectance * arrives, kind == kSurfelSolidSide ? 0.0f : 1.0f);
}

LAMBENT_END
#endif
