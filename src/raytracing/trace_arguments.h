// SPDX-License-Identifier: Apache-2.0
// What the two ray tracing pipelines are told.
#ifndef LAMBENT_RAYTRACING_TRACE_ARGUMENTS_H
#define LAMBENT_RAYTRACING_TRACE_ARGUMENTS_H

#include "raytracing/ray_records.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

struct TraceArguments {
  uvec2 structure;     ///< Address of the acceleration structure, low word first.
  RayArray rays;       ///< `count` of them.
  HitArray hits;       ///< Of closest hits: one a ray.
  UintArray occluded;  ///< Of occlusion: a word a ray, 1 or 0.
  SceneArray scene;    ///< Of what is see-through.
  uint count;
};

/// Rays go on for ever; device rays are asked no farther than this [m].
const float kFarthestOfDevices = 3.0e38f;

LAMBENT_END
#endif
