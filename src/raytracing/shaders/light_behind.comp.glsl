// SPDX-License-Identifier: Apache-2.0
// Draws candidates of the light behind rough surfaces, as it comes through to the viewer: their
// shadow rays, and their unoccluded light; see Glossy::sample_lights_behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/glass/transmitter.h"
#include "raytracing/vulkan/shading_records.h"
#include "shared/phase.h"
#include "shared/sampling.h"

/// What light is drawn for: transmission at a point, whose normals face away from the viewer.
struct ThroughReceiver {
  LitPointRecord point;
  Transmitter transmitter;
  float density_scale;
};
#define ReceiverRef ThroughReceiver

#include "raytracing/shaders/direct_light.glsl"

float target_of(ThroughReceiver receiver, LightCandidate light) {
  return luminance(sampled_transmission(receiver.transmitter, light, receiver.density_scale));
}
PickLobe lobe_of(ThroughReceiver receiver) {
  return pick_lobe(receiver.transmitter);
}

#include "raytracing/shaders/draws_media.glsl"
#include "raytracing/shaders/sky.glsl"
#include "raytracing/glass/sky_behind.inl.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  LightDrawsArguments args;
};

/// Writes the light of a slot and its shadow ray, if it brings any; returns the number of rays.
uint store(uint at, LitPointRecord point, LightCandidate light, vec3 transmitted) {
  RayRecord ray = no_ray();
  if (transmitted != vec3(0.0f)) {
    // It stops where light does not go straight on: rays find what is farther
    ray = shadow_ray(point, light);
    ray.mask = kRayThroughPanes;
  }
  args.pairs.at[at] = ReflectedPair(vec3(0.0f), transmitted);
  args.shadow_rays.at[at] = ray;
  return ray.mask != 0u ? 1u : 0u;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  LitPointRecord point = args.points.at[args.first + i];
  PixelSurfaceRecord surface = args.surfaces.at[args.first + i];
  bool asks = (surface.flags & kSurfaceSamplesBehind) != 0u;
  Frame frame = make_frame(point.normal_ws);
  Transmitter transmitter =
      Transmitter(surface.transmission, surface.reflectance, frame,
                  to_local(frame, surface.to_viewer_ws), point.geometric_normal_ws);
  point.normal_ws = -point.normal_ws;
  point.geometric_normal_ws = -point.geometric_normal_ws;
  point.albedo_shape = 0u;
  point.mean_normal_length = 1.0f;
  ThroughReceiver receiver =
      ThroughReceiver(point, transmitter,
                      emitter_density_scale(args.tree_samples, surface.fluence));
  RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
  uint slots = slot_count(args);
  LightPicks picks;
  uint rays = 0u;
  for (uint slot = 0u; slot < slots; ++slot) {
    LightCandidate light = no_candidate();
    vec3 transmitted = vec3(0.0f);
    if (asks) {
      light = candidate_of_slot(args, receiver, slot, picks, random);
      transmitted = sampled_transmission(transmitter, light, receiver.density_scale);
      // Rays see no fog, and nor do samples of what they find, too
      if (light.emission_luminance <= 0.0f) {
        transmitted *= transmittance(args, point.position_ws, light.to_light, light.distance);
      }
    }
    rays += store(slot * args.count + i, point, light, transmitted);
  }
  if (args.sky_slots != 0u) {
    SkyBehind sky = SkyBehind(vec3(0.0f), vec3(0.0f));
    if (asks) sky = sample_sky_behind(args.scene.at[0].environment, transmitter, random);
    LightCandidate light = LightCandidate(sky.direction_ws, infinity(), vec3(1.0f), 0.0f);
    rays += store(slots * args.count + i, point, light, sky.light);
  }
  if (rays > 0u) atomicAdd(args.ray_count.at[0], rays);
}
