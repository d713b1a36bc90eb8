// SPDX-License-Identifier: Apache-2.0
// Shadow rays to texels that are sampled in proportion to their light.
#ifndef LAMBENT_RSM_VISIBILITY_RAYS_H
#define LAMBENT_RSM_VISIBILITY_RAYS_H

#include "raytracing/shadow_rays.h"
#include "rsm/records.h"
#include "rsm/texel_light.h"
#include "shared/color.h"
#include "shared/rays.h"

LAMBENT_BEGIN

/// Makes these random numbers independent of those of other passes.
const uint kVisibilitySalt = 0x56495349u;

/// Luminance that a texel contributes at a point.
LAMBENT_FN float texel_target(vec3 position_ws, vec3 normal_ws, RsmTexelRecord texel) {
  return luminance(texel.flux) * bounded_geometry_term(position_ws, normal_ws, texel.position_ws,
                                                       texel.normal_ws, texel.softening);
}

/// Draw `index` of `count`, stratified, from the total of all texels: it selects the texel at which
/// the running sum first exceeds this value. `shift` is uniform in [0, 1).
LAMBENT_FN float drawn_worth(float total, int index, float shift, int count) {
  return total * (float(index) + shift) / float(count);
}

LAMBENT_END
#endif
