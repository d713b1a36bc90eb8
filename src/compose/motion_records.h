// SPDX-License-Identifier: Apache-2.0
// What the kernels of motion read and write.
#ifndef LAMBENT_COMPOSE_MOTION_RECORDS_H
#define LAMBENT_COMPOSE_MOTION_RECORDS_H

#include "raytracing/motion/motion_math.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

// InstanceBeforeRecord::flags
const uint kBeforeKnown = 1u;  ///< It was there, and so were its mesh's vertices.
const uint kBeforeBent = 2u;   ///< Its mesh's vertices were elsewhere.

/// As struct InstanceBefore of scene_pose.h.
struct InstanceBeforeRecord {
  mat4 world_from_object;
  Vec3Array positions;  ///< Of its mesh, object space [m], where it was bent.
  uint flags;
  uint padding;
};
LAMBENT_DEVICE_ARRAY(InstanceBeforeArray, InstanceBeforeRecord, 8)

/// As struct FrameBefore of motion.h, and the two views.
struct SceneBeforeRecord {
  InstanceBeforeArray instances;  ///< Where they are not all at rest.
  MotionViews views;
  uint at_rest;
};
LAMBENT_DEVICE_ARRAY(SceneBeforeArray, SceneBeforeRecord, 8)

/// Rays that go on where a pixel shows something see-through.
struct MotionRaysArguments {
  SceneArray scene;
  RayArray rays;  ///< Of the camera,
  HitArray hits;  ///< and what they met.
  RayArray further_rays;
  UintArray ray_count;  ///< Rays that go on, so far: one number.
  uint count;
  uint padding;
};

/// From what pixels show to its motion.
struct MotionArguments {
  SceneArray scene;
  SceneBeforeArray before;
  RayArray rays;
  HitArray hits;
  RayArray further_rays;            ///< Where has_further is 1. Of those that are traced,
  HitArray further_hits;            ///< what they met.
  PixelMotionArray motion;          ///< A pixel of the band each.
  PixelMotionArray picture_motion;  ///< The same, of the nearest sample so far.
  uint count;
  uint first_sample;  ///< 1: of the pixels' first sample.
  uint has_further;
  uint padding;
};

LAMBENT_END
#endif
