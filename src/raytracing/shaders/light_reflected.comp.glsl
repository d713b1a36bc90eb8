// SPDX-License-Identifier: Apache-2.0
// Candidates of direct light as surfaces reflect it to the viewer: shadow rays, and what they are
// worth.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/shaders/direct_light.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  LightDrawsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[args.first + i];
  PixelSurfaceRecord surface = args.surfaces.at[args.first + i];
  Frame frame = make_frame(point.normal_ws);
  vec3 to_viewer = to_local(frame, surface.to_viewer_ws);
  bool asks = point.random_index != kAsksForNoLight;
  RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
  uint slots = slot_count(args);
  uint rays = 0u;
  for (uint slot = 0u; slot < slots; ++slot) {
    RayRecord ray = no_ray();
    ReflectedPair pair = ReflectedPair(vec3(0.0f), vec3(0.0f));
    if (asks) {
      LightCandidate light = candidate_of_slot(args, point, slot, random);
      pair = unoccluded_reflection(surface.reflectance, frame, to_viewer, point, light);
      if (pair.diffuse + pair.specular != vec3(0.0f)) ray = shadow_ray(point, light);
    }
    args.pairs.at[slot * args.count + i] = pair;
    args.shadow_rays.at[slot * args.count + i] = ray;
    rays += ray.mask != 0u ? 1u : 0u;
  }
  if (rays > 0u) atomicAdd(args.ray_count.at[0], rays);
}
