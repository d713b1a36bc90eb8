// SPDX-License-Identifier: Apache-2.0
// Draws candidates of direct light as irradiance: their shadow rays, and their unoccluded light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/vulkan/shading_records.h"
#include "shared/albedo_shape.h"

/// What light is drawn for: irradiance at a point.
struct IrradianceReceiver {
  LitPointRecord point;
  SeenShape shape;
};
#define ReceiverRef IrradianceReceiver

#include "raytracing/shaders/direct_light.glsl"

float target_of(IrradianceReceiver receiver, LightCandidate light) {
  return luminance(unoccluded_irradiance(receiver.point, receiver.shape, light));
}
PickLobe lobe_of(IrradianceReceiver receiver) {
  return no_pick_lobe();
}

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  LightDrawsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[args.first + i];
  bool asks = point.random_index != kNoDirectLight;
  RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
  IrradianceReceiver receiver = IrradianceReceiver(point, seen_shape(point));
  uint slots = slot_count(args);
  LightPicks picks;
  uint rays = 0u;
  float nearest = uintBitsToFloat(kMissedDistanceBits);
  for (uint slot = 0u; slot < slots; ++slot) {
    RayRecord ray = no_ray();
    vec3 unoccluded = vec3(0.0f);
    if (asks) {
      LightCandidate light = candidate_of_slot(args, receiver, slot, picks, random);
      unoccluded = unoccluded_irradiance(point, receiver.shape, light);
      if (unoccluded != vec3(0.0f)) {
        ray = shadow_ray(point, light);
        nearest = min(nearest, light.distance);
      }
    }
    args.unoccluded_irradiance.at[slot * args.count + i] = unoccluded;
    args.shadow_rays.at[slot * args.count + i] = ray;
    rays += ray.mask != 0u ? 1u : 0u;
  }
  if (asks) args.points.at[args.first + i].light_distance = nearest;
  if (rays > 0u) atomicAdd(args.ray_count.at[0], rays);
}
