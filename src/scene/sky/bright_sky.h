// SPDX-License-Identifier: Apache-2.0
// The sky's map in two parts: a dim one, which rays of coats find without much noise, and what is
// brighter (a sun, windows, soft boxes), which is sampled as a light. The reference draws from the
// whole map, by EnvironmentDistribution of scene/environment_sampling.h.
#ifndef LAMBENT_SCENE_BRIGHT_SKY_H
#define LAMBENT_SCENE_BRIGHT_SKY_H

#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Directions to the bright part of the sky from which a point's one sample is resampled. Each costs
// an evaluation of the point's lobe, but no ray.
const uint kSkyCandidates = 16u;

/// A texel's area of the map, from which directions are drawn, with all others in order.
struct BrightSkyCell {
  float cumulative;   ///< Probability of this cell and of all before it.
  float probability;  ///< Of this cell.
  uint texel;         ///< Index in the map, row by row.
};
LAMBENT_DEVICE_ARRAY(BrightSkyCellArray, BrightSkyCell, 4)

/// What a ray that leaves the scene sees of the sky.
struct SkySeen {
  vec3 dim;       ///< Radiance without the bright part, over the ray's cone [W/(m^2 sr)].
  vec3 bright;    ///< Radiance of the bright part, in the ray's own direction [W/(m^2 sr)].
  float density;  ///< With which sample_bright_sky() draws that direction [1/sr].
};

/// What of a texel's radiance is above a luminance of `limit`; its colour stays the same.
LAMBENT_FN vec3 bright_part(vec3 radiance, float limit) {
  float bright = luminance(radiance);
  return bright > limit ? radiance * (1.0f - limit / bright) : vec3(0.0f);
}

/// Solid angle of a map over its area, which is 1, at the latitude of v [sr].
LAMBENT_FN float map_solid_angle(float v) {
  return kTwoPi * kPi * sin(kPi * v);
}

LAMBENT_END
#endif
