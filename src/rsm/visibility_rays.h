// SPDX-License-Identifier: Apache-2.0
// Shadow rays to texels that are drawn in proportion to what they bring.
#ifndef LAMBENT_RSM_VISIBILITY_RAYS_H
#define LAMBENT_RSM_VISIBILITY_RAYS_H

#include "raytracing/ray_records.h"
#include "rsm/geometry.h"
#include "rsm/records.h"
#include "shared/color.h"
#include "shared/rays.h"

LAMBENT_BEGIN

/// Keeps these random numbers apart from those of other passes.
const uint kVisibilitySalt = 0x56495349u;

/// What a texel brings a point, in luminance.
LAMBENT_FN float texel_worth(vec3 position_ws, vec3 normal_ws, RsmTexelRecord texel) {
  return luminance(texel.flux) * bounded_geometry_term(position_ws, normal_ws, texel.position_ws,
                                                       texel.normal_ws, texel.softening);
}

/// Draw `index` of `count`, stratified, from a sum of worths: the texel at which the sum so far
/// first exceeds this. `shift` is uniform in [0, 1).
LAMBENT_FN float drawn_worth(float total, int index, float shift, int count) {
  return total * (float(index) + shift) / float(count);
}

/// The ray from a point to a texel.
LAMBENT_FN RayRecord ray_to_texel(vec3 position_ws, vec3 normal_ws, vec3 texel_ws, uint mask) {
  vec3 origin = offset_ray_origin(position_ws, normal_ws);
  vec3 way = texel_ws - origin;
  float dist = length(way);
  vec3 direction = dist > 0.0f ? way / dist : vec3(0.0f, 0.0f, 1.0f);
  RayRecord ray = {origin, 0.0f, direction, dist * (1.0f - kShadowRayShortening), mask};
  return ray;
}

LAMBENT_END
#endif
