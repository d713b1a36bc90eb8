// SPDX-License-Identifier: Apache-2.0
// Wrappers of the functions that differ between versions 3 and 4 of Embree.
#pragma once

#if LAMBENT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lambent::embree {

#if LAMBENT_EMBREE_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

inline void start(Context& context) {
#if LAMBENT_EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
}

/// Filters receive the context, which must have been started.
inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray_hit) {
#if LAMBENT_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray_hit, &arguments);
#else
  rtcIntersect1(scene, &context, &ray_hit);
#endif
}

inline void occluded(RTCScene scene, Context& context, RTCRay& ray) {
#if LAMBENT_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace lambent::embree
