// SPDX-License-Identifier: Apache-2.0
// The part of Embree that differs between versions 3 and 4.
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

/// Filters are handed the context, which has been started.
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

/// Rays that are traced together; those that start and go about alike gain most.
inline constexpr unsigned kPacket = 16;

inline void intersect(RTCScene scene, Context& context, const int* valid, RTCRayHit16& ray_hits) {
#if LAMBENT_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcIntersect16(valid, scene, &ray_hits, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &ray_hits);
#endif
}

inline void occluded(RTCScene scene, Context& context, const int* valid, RTCRay16& rays) {
#if LAMBENT_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcOccluded16(valid, scene, &rays, &arguments);
#else
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
#endif
}

}  // namespace lambent::embree
