// SPDX-License-Identifier: Apache-2.0
// Shadow rays to texels that are drawn in proportion to what they bring.
#ifndef LAMBENT_RSM_VISIBILITY_RAYS_H
#define LAMBENT_RSM_VISIBILITY_RAYS_H

#include "raytracing/shadow_rays.h"
#include "rsm/geometry_term.h"
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

LAMBENT_END
#endif
