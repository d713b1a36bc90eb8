// SPDX-License-Identifier: Apache-2.0
// Computes motion vectors: where the surfaces that pixels show were in the previous frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/motion/motion_records.h"
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/surface_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  MotionArguments args;
};

// What motion.inl.h requires of its includer.
#define SceneBeforeRef SceneBeforeArray

bool was_there(SceneBeforeArray before, uint instance) {
  return before.at[0].at_rest != 0u ||
         (before.at[0].instances.at[instance].flags & kBeforeKnown) != 0u;
}
mat4 transform_before(SceneBeforeArray before, uint instance, InstanceRecord now) {
  if (before.at[0].at_rest != 0u) return now.world_from_object;
  return before.at[0].instances.at[instance].world_from_object;
}
vec3 fetch_position_before(SceneBeforeArray before, uint instance, MeshRecord now, uint vertex) {
  if (before.at[0].at_rest == 0u) {
    InstanceBeforeRecord record = before.at[0].instances.at[instance];
    if ((record.flags & kPreviouslyDeformed) != 0u) return record.positions.at[vertex];
  }
  return now.positions.at[vertex];
}

#include "compose/motion/motion.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  HitRecord hit = args.hits.at[i];
  if (args.has_further != 0u && args.further_rays.at[i].mask != 0u) hit = args.further_hits.at[i];
  MotionViews views = args.before.at[0].views;
  PixelMotion motion;
  if (missed(hit)) {
    motion = sky_motion(views, args.rays.at[i].direction_ws);
  } else {
    motion = surface_motion(args.scene, args.before, views, hit.instance, hit.triangle,
                            hit.barycentrics);
  }
  args.motion.at[i] = motion;
  bool first = args.first_sample != 0u;
  if (!first) motion = nearer_motion(args.picture_motion.at[i], motion);
  args.picture_motion.at[i] = motion;
}
