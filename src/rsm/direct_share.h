// SPDX-License-Identifier: Apache-2.0
// Based on: Heitz, Hill and McGuire, "Combining Analytic Direct Illumination and Stochastic
// Shadows", I3D 2018. Lights are shared out to sub-images: each pixel asks the light that is
// brightest there and a few others whether their light arrives. Of the others it takes what arrives
// around it over what was sent there as the share of all their light, which it knows without rays.
#ifndef LAMBENT_RSM_DIRECT_SHARE_H
#define LAMBENT_RSM_DIRECT_SHARE_H

#include "shared/brdf.h"
#include "shared/color.h"
#include "shared/cross_bilateral.h"

LAMBENT_BEGIN

// Weight of a pixel of another surface, beside 1 of one's own: it tells what arrives only where no
// light that a surface's pixels ask is sent to it.
const float kOtherSurfaceWeight = 1e-4f;

/// A light that the pixels of a sub-map ask.
struct DealtLight {
  uint light;    ///< Index among the scene's.
  float weight;  ///< Sub-maps over those of them that ask it: on average over all, each light is
                 ///< asked once.
};
LAMBENT_DEVICE_ARRAY(DealtLightArray, DealtLight, 4)

/// Light that was asked for, by color: what arrives, and what would if nothing were in the way.
/// Both as reflected to the viewer, diffuse light without albedo.
struct LightShare {
  vec3 arrived;
  vec3 sent;
};
LAMBENT_DEVICE_ARRAY(LightShareArray, LightShare, 4)

/// One channel of what arrives over what is sent; where nothing is sent, nothing is in the way.
LAMBENT_FN float arriving_share(float arrived, float sent) {
  return sent > 0.0f ? arrived / sent : 1.0f;
}

/// What arrives over what is sent.
LAMBENT_FN vec3 arriving_share(LightShare light) {
  return vec3(arriving_share(light.arrived.x, light.sent.x),
              arriving_share(light.arrived.y, light.sent.y),
              arriving_share(light.arrived.z, light.sent.z));
}

// BrightestLight::light where no light sends anything.
const uint kNoLight = 0xFFFFFFFFu;

/// The light that sends most to a pixel: a highlight, or a lamp close by, is narrower than what
/// lights are shared out over, and the shadows of the brightest are those that are seen.
struct BrightestLight {
  uint light;  ///< Index among the scene's.
  float level;
  ReflectedPair sent;
};

LAMBENT_FN BrightestLight no_brightest_light() {
  BrightestLight none = {kNoLight, 0.0f, {vec3(0.0f), vec3(0.0f)}};
  return none;
}

/// Adds a light to the sum of others, or in place of the brightest so far, which then is added.
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

/// The light of a pixel's brightest light, which arrived, and of all others, of which a share does.
LAMBENT_FN ReflectedPair with_brightest(ReflectedPair brightest, ReflectedPair others,
                                        vec3 arrives) {
  ReflectedPair sum = {brightest.diffuse + arrives * others.diffuse,
                       brightest.specular + arrives * others.specular};
  return sum;
}

/// Weight of a tap of a blur as wide as `period`: of an even one, the outermost two share a place.
LAMBENT_FN float period_weight(int dist, int period) {
  return 2 * dist == period ? 0.5f : 1.0f;
}

// A pixel of the view is taken for the surface of a sample where its weights are at least this, of
// 1 for the pixel itself; else what is around decides.
const float kShowsSurface = 0.05f;

LAMBENT_END
#endif
