// SPDX-License-Identifier: Apache-2.0
// Data of the kernels of motion vectors.
#ifndef LAMBENT_COMPOSE_MOTION_RECORDS_H
#define LAMBENT_COMPOSE_MOTION_RECORDS_H

#include "raytracing/motion/motion_math.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

// Bits of InstanceBeforeRecord::flags
const uint kBeforeKnown = 1u;  ///< The instance existed, and its vertices' positions are known.
const uint kPreviouslyDeformed = 2u;  ///< Its mesh was deformed differently.

/// See InstanceBefore in scene_pose.h.
struct InstanceBeforeRecord {
  mat4 world_from_object;
  Vec3Array
      positions;  ///< Its mesh's previous positions, object space [m]; see kPreviouslyDeformed.
  uint flags;
  uint padding;
};
LAMBENT_DEVICE_ARRAY(InstanceBeforeArray, InstanceBeforeRecord, 8)

/// See FrameBefore in motion.h; with the two views.
struct SceneBeforeRecord {
  InstanceBeforeArray instances;  ///< Read where at_rest is 0.
  MotionViews views;
  uint at_rest;
};
LAMBENT_DEVICE_ARRAY(SceneBeforeArray, SceneBeforeRecord, 8)

/// Makes the rays that go on behind blended surfaces.
struct MotionRaysArguments {
  SceneArray scene;
  RayArray rays;  ///< The camera's rays.
  HitArray hits;  ///< Their hits.
  RayArray further_rays;
  UintArray ray_count;  ///< One number: how many rays go on, so far.
  uint count;
  uint padding;
};

/// Computes the motion vectors of pixels.
struct MotionArguments {
  SceneArray scene;
  SceneBeforeArray before;
  RayArray rays;
  HitArray hits;
  RayArray further_rays;            ///< Read where has_further is 1. A mask of 0: no ray.
  HitArray further_hits;            ///< Their hits.
  PixelMotionArray motion;          ///< One for each pixel of the band.
  PixelMotionArray picture_motion;  ///< That of the nearest sample so far.
  uint count;
  uint first_sample;  ///< 1: this is the pixels' first sample.
  uint has_further;
  uint padding;
};

LAMBENT_END
#endif
