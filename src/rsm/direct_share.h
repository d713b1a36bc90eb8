// SPDX-License-Identifier: Apache-2.0
// Based on: Heitz, Hill and McGuire, "Combining Analytic Direct Illumination and Stochastic
// Shadows", I3D 2018. Lights are shared out to sub-images: each pixel traces shadow rays to its
// brightest light and to a few others. The unoccluded light of all others, which needs no rays, is
// multiplied by the share that arrives around the pixel: arrived light over sent (unoccluded)
// light.
#ifndef LAMBENT_RSM_DIRECT_SHARE_H
#define LAMBENT_RSM_DIRECT_SHARE_H

#include "shared/brdf.h"
#include "shared/color.h"
#include "shared/cross_bilateral.h"

LAMBENT_BEGIN

// Weight of a pixel of another surface, compared to 1 for the own surface: such pixels count only
// where none of the lights that the surface's own pixels test reaches the surface.
const float kOtherSurfaceWeight = 1e-4f;

/// A light that the pixels of a sub-map test.
struct AssignedLight {
  uint light;    ///< Index of the light in the scene.
  float weight;  ///< Number of sub-maps over those that test it, so that the mean over all sub-maps
                 ///< counts each light once.
};
LAMBENT_DEVICE_ARRAY(DealtLightArray, AssignedLight, 4)

/// Light that was tested, by color: arriving light, and unoccluded light. Both as reflected to the
/// viewer, diffuse light without albedo.
struct LightShare {
  vec3 arrived;
  vec3 sent;
};
LAMBENT_DEVICE_ARRAY(LightShareArray, LightShare, 4)

/// Arriving over unoccluded light in one channel; where no light is sent, nothing is occluded.
LAMBENT_FN float arriving_share(float arrived, float sent) {
  return sent > 0.0f ? arrived / sent : 1.0f;
}

/// Arriving over unoccluded light.
LAMBENT_FN vec3 arriving_share(LightShare light) {
  return vec3(arriving_share(light.arrived.x, light.sent.x),
              arriving_share(light.arrived.y, light.sent.y),
              arriving_share(light.arrived.z, light.sent.z));
}

// BrightestLight::light where no light reaches the pixel.
const uint kNoLight = 0xFFFFFFFFu;

/// The light that is brightest at a pixel. A highlight, or the light of a lamp close by, is
/// narrower than the period in which lights are shared out, and shadows of the brightest light are
/// the ones that are noticed.
struct BrightestLight {
  uint light;  ///< Index of the light in the scene.
  float level;
  ReflectedPair sent;
};

LAMBENT_FN BrightestLight no_brightest_light() {
  BrightestLight none = {kNoLight, 0.0f, {vec3(0.0f), vec3(0.0f)}};
  return none;
}

/// Adds a light to the sum of others; or replaces the brightest so far by it and adds that one.
LAMBENT_FN void add_to_others(LAMBENT_INOUT(BrightestLight) brightest, uint light,
                              ReflectedPair sent, LAMBENT_INOUT(ReflectedPair) others) {
  float level = luminance(sent.diffuse + sent.specular);
  if (level > brightest.level) {
    ReflectedPair before = brightest.sent;
    brightest.light = light;
    brightest.level = level;
    brightest.sent = sent;
    sent = before;
  }
  others.diffuse += sent.diffuse;
  others.specular += sent.specular;
}

/// Sum of a pixel's brightest light, which was tested, and of the arriving share of all others.
LAMBENT_FN ReflectedPair with_brightest(ReflectedPair brightest, ReflectedPair others,
                                        vec3 arrives) {
  ReflectedPair sum = {brightest.diffuse + arrives * others.diffuse,
                       brightest.specular + arrives * others.specular};
  return sum;
}

/// Weight of a tap of a blur as wide as `period`: where that is even, the outermost two have half.
LAMBENT_FN float period_weight(int dist, int period) {
  return 2 * dist == period ? 0.5f : 1.0f;
}

// Least weight at which a pixel of the view shows the surface of a sample, compared to 1 for the
// sample's own pixel; where none does, the surrounding pixels are used.
const float kShowsSurface = 0.05f;

LAMBENT_END
#endif
