// SPDX-License-Identifier: Apache-2.0
// The arguments of the ray tracing pipelines.
#ifndef LAMBENT_RAYTRACING_VULKAN_TRACE_ARGUMENTS_H
#define LAMBENT_RAYTRACING_VULKAN_TRACE_ARGUMENTS_H

#include "raytracing/ray_records.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

struct TraceArguments {
  uvec2 structure;     ///< Address of the acceleration structure, low word first.
  RayArray rays;       ///< `count` rays.
  HitArray hits;       ///< Closest hits: one a ray. Transmittance: see `to_hits`.
  UintArray occluded;  ///< Occlusion: a word a ray, 1 or 0.
  Vec3Array through;   ///< Transmittance: a share a ray.
  SceneArray scene;    ///< Read where surfaces are transparent.
  uint count;
  uint to_hits;  ///< Transmittance: 1: rays end at `hits`.
};

/// Arguments of engine_closest and engine_occlusion, which find in an engine's acceleration
/// structure the closest hits of rays, and whether rays hit anything.
struct EngineTraceArguments {
  uvec2 structure;  ///< Its address, low word first.
  RayArray rays;
  HitArray hits;       ///< Results of engine_closest.
  UintArray occluded;  ///< Results of engine_occlusion, one word a ray: 1 where it hits something.
  uint count;
  uint mask;  ///< Mask of the rays of engine_occlusion, in place of their own masks.
};

/// A ray in search of its closest hit.
struct ClosestPayload {
  HitRecord hit;  ///< A miss until the search has ended.
  uint mask;      ///< The ray's.
  float passed;   ///< Blended surfaces up to here let the ray through [m].
  // The see-through triangle that stopped the ray last, and its covered_share(); after the search
  // the share is that of the hit.
  uint instance;
  uint triangle;
  float share;
};

/// The light along a ray, as far as the ray has been traced.
struct TransmittancePayload {
  vec3 through;         ///< Share that passes the surfaces so far.
  vec3 optical_depth;   ///< Sum over the volumes on the path.
  uint crosses;         ///< 1: see crosses_glass().
  uint stops_at_bends;  ///< 1: see stops_at_bends().
  uint stopped;         ///< 1: an opaque surface stops it.
};

/// Rays may be infinite; on devices they are traced no farther than this [m].
const float kFarthestOfDevices = 3.0e38f;

LAMBENT_END
#endif
