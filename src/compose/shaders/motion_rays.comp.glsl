// SPDX-License-Identifier: Apache-2.0
// Makes the rays that go on behind blended surfaces, which have no motion vectors of their own.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/motion/motion_records.h"
#include "scene/coverage.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  MotionRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  RayRecord ray = args.rays.at[i];
  HitRecord hit = args.hits.at[i];
  ray.mask = 0u;
  if (!missed(hit)) {
    SceneRecord scene = args.scene.at[0];
    uint mesh = scene.instances.at[hit.instance].mesh;
    uint mode = scene.materials.at[scene.meshes.at[mesh].material].alpha_mode;
    if (mode == kAlphaBlend) {
      ray.mask = kRayOfMotion;
      atomicAdd(args.ray_count.at[0], 1u);
    }
  }
  args.further_rays.at[i] = ray;
}
