// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_SHARED_RAYS_H
#define LAMBENT_SHARED_RAYS_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Shadow rays to points on surfaces end this share of their length short of them, so that the
/// source does not shadow itself.
const float kShadowRayShortening = 1e-4f;

/// The distance along a ray to just before its hit: any hit up to there is in front of it.
LAMBENT_FN float before_hit(float distance) {
  return distance * (1.0f - kShadowRayShortening);
}

/// Coordinates below kRayOffsetOrigin [m] are offset by kRayOffsetFloatScale [m], larger ones by
/// kRayOffsetIntScale units in the last place, each times the normal's coordinate.
const float kRayOffsetOrigin = 1.0f / 32.0f;
const float kRayOffsetFloatScale = 1.0f / 65536.0f;
const float kRayOffsetIntScale = 256.0f;

/// One coordinate of offset_ray_origin.
LAMBENT_FN float offset_ray_component(float p, float n) {
  int units = int(kRayOffsetIntScale * n);
  float far = intBitsToFloat(floatBitsToInt(p) + (p < 0.0f ? -units : units));
  return abs(p) < kRayOffsetOrigin ? p + kRayOffsetFloatScale * n : far;
}

/// `p` moved off a surface, to the side its geometric normal points to, by just more than float
/// error. Waechter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray
/// Tracing Gems, 2019.
LAMBENT_FN vec3 offset_ray_origin(vec3 p, vec3 n) {
  return vec3(offset_ray_component(p.x, n.x), offset_ray_component(p.y, n.y),
              offset_ray_component(p.z, n.z));
}

LAMBENT_END
#endif
