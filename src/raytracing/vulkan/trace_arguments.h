// SPDX-License-Identifier: Apache-2.0
// What the ray tracing pipelines are told.
#ifndef LAMBENT_RAYTRACING_VULKAN_TRACE_ARGUMENTS_H
#define LAMBENT_RAYTRACING_VULKAN_TRACE_ARGUMENTS_H

#include "raytracing/ray_records.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

struct TraceArguments {
  uvec2 structure;     ///< Address of the acceleration structure, low word first.
  RayArray rays;       ///< `count` of them.
  HitArray hits;       ///< Of closest hits: one a ray.
  UintArray occluded;  ///< Of occlusion: a word a ray, 1 or 0.
  Vec3Array through;   ///< Of light that passes: a share a ray.
  SceneArray scene;    ///< Of what is see-through.
  uint count;
  uint to_hits;  ///< Of light that passes: 1: rays end at their hits.
};

/// Arguments of engine_closest and engine_occlusion, which find in an engine's acceleration
/// structure the closest hits of rays, and whether rays meet anything.
struct EngineTraceArguments {
  uvec2 structure;  ///< Its address, low word first.
  RayArray rays;
  HitArray hits;       ///< Of closest hits.
  UintArray occluded;  ///< Of occlusion: a word a ray, 1 or 0.
  uint count;
  uint mask;  ///< Of occlusion: which instances rays meet, in place of their own masks.
};

/// What a ray's light has become of, as far as it is known.
struct LightOnItsWay {
  vec3 through;        ///< Share of it that passes surfaces.
  vec3 optical_depth;  ///< Of the volumes on the way.
  uint crosses;        ///< 1: see crosses_glass().
  uint stopped;        ///< 1: something lets none through.
};

/// Rays go on for ever; device rays are asked no farther than this [m].
const float kFarthestOfDevices = 3.0e38f;

LAMBENT_END
#endif
