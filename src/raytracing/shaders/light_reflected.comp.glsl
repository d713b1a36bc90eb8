// SPDX-License-Identifier: Apache-2.0
// Draws candidates of direct light as surfaces reflect it to the viewer: their shadow rays, and
// their unoccluded light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/vulkan/shading_records.h"
#include "scene/light_tree/pick_lobe.h"
#include "shared/phase.h"
#include "shared/sampling.h"

/// What light is drawn for: reflection at a point.
struct ReflectingReceiver {
  LitPointRecord point;
  Reflectance reflectance;
  Frame frame;
  vec3 to_viewer;  ///< Unit, in the frame.
  CoatShares shares;
  float density_scale;
};
#define ReceiverRef ReflectingReceiver

#include "raytracing/shaders/direct_light.glsl"

ReflectedPair reflection(ReflectingReceiver to, LightCandidate light) {
  return sampled_reflection(to.reflectance, to.frame, to.to_viewer, to.point, light, to.shares,
                            to.density_scale);
}

float target_of(ReflectingReceiver receiver, LightCandidate light) {
  ReflectedPair pair = reflection(receiver, light);
  return luminance(pair.diffuse + pair.specular);
}
PickLobe lobe_of(ReflectingReceiver receiver) {
  return pick_lobe(receiver.reflectance, receiver.frame, receiver.to_viewer);
}

#include "raytracing/shaders/draws_media.glsl"
#include "raytracing/shaders/sky.glsl"
#include "raytracing/sky/sky_light.inl.h"

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
  ReflectingReceiver receiver =
      ReflectingReceiver(point, surface.reflectance, frame, to_local(frame, surface.to_viewer_ws),
                         surface.coat_shares,
                         emitter_density_scale(args.tree_samples, surface.fluence));
  bool asks = point.random_index != kNoDirectLight;
  RandomStream random = make_random_stream(point.random_index, args.salt, args.seed);
  uint slots = slot_count(args);
  LightPicks picks;
  uint rays = 0u;
  for (uint slot = 0u; slot < slots; ++slot) {
    RayRecord ray = no_ray();
    ReflectedPair pair = ReflectedPair(vec3(0.0f), vec3(0.0f));
    if (asks) {
      LightCandidate light = candidate_of_slot(args, receiver, slot, picks, random);
      pair = reflection(receiver, light);
      float passed = transmittance(args, point.position_ws, light.to_light, light.distance);
      pair.diffuse *= passed;
      pair.specular *= passed;
      if (pair.diffuse + pair.specular != vec3(0.0f)) ray = shadow_ray(point, light);
    }
    args.pairs.at[slot * args.count + i] = pair;
    args.shadow_rays.at[slot * args.count + i] = ray;
    rays += ray.mask != 0u ? 1u : 0u;
  }
  if (args.sky_slots != 0u) {
    RayRecord ray = no_ray();
    ReflectedPair pair = ReflectedPair(vec3(0.0f), vec3(0.0f));
    if (asks) {
      SkyReflector coats = SkyReflector(surface.reflectance, frame, receiver.to_viewer,
                                        point.geometric_normal_ws, surface.coat_shares);
      SkyCandidate sky = sample_reflected_sky(args.scene.at[0].environment, coats, random);
      // Reflections see no fog, whether rays or samples find the sky
      pair = ReflectedPair(sky.light.clearcoat, sky.light.coat);
      if (pair.diffuse + pair.specular != vec3(0.0f)) {
        ray = shadow_ray(point, LightCandidate(sky.direction_ws, infinity(), vec3(1.0f), 0.0f));
      }
    }
    args.pairs.at[slots * args.count + i] = pair;
    args.shadow_rays.at[slots * args.count + i] = ray;
    rays += ray.mask != 0u ? 1u : 0u;
  }
  if (rays > 0u) atomicAdd(args.ray_count.at[0], rays);
}
