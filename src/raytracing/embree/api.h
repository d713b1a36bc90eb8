// SPDX-License-Identifier: Apache-2.0
// The part of Embree that differs between versions 3 and 4.
#pragma once

#if LAMBENT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lambent::embree {

inline void intersect(RTCScene scene, RTCRayHit& ray_hit) {
#if LAMBENT_EMBREE_MAJOR >= 4
  rtcIntersect1(scene, &ray_hit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray_hit);
#endif
}

inline void occluded(RTCScene scene, RTCRay& ray) {
#if LAMBENT_EMBREE_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace lambent::embree
