// SPDX-License-Identifier: Apache-2.0
// Access to lights and emissive triangles in a device's memory, as direct_light.inl.h requires it.
// The includer defines ReceiverRef first, and target_of and lobe_of afterwards.
#ifndef LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL

#include "raytracing/emitter_sampling.h"
#include "raytracing/shaders/light_tree.glsl"
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/vulkan/shading_records.h"
#include "shared/color.h"

#define LitPointRef LitPointRecord
#define DrawsRef LightDrawsArguments

#include "scene/emissive_sample.inl.h"

bool emitters_alone(LightDrawsArguments draws) {
  return draws.emitters_alone != 0u;
}
uint enumerated_lights(LightDrawsArguments draws) {
  return emitters_alone(draws) ? 0u : draws.scene.at[0].asked_count;
}
uint fetch_enumerated(LightDrawsArguments draws, uint slot) {
  return draws.scene.at[0].asked.at[slot];
}
LightRecord fetch_light(LightDrawsArguments draws, uint light) {
  return draws.scene.at[0].lights.at[light];
}
PickLobe bounded_lobe(LightDrawsArguments draws, vec3 position_ws, vec3 normal_ws, PickLobe lobe) {
  return bounded_lobe(light_tree_from(draws.scene, position_ws, normal_ws), position_ws, normal_ws,
                      lobe);
}
void pick_lights(LightDrawsArguments draws, vec3 position_ws, vec3 normal_ws, PickLobe lobe,
                 uint count, inout LightPicks picks) {
  pick_lights(light_tree_from(draws.scene, position_ws, normal_ws), position_ws, normal_ws, lobe,
              count, picks);
}
uint emitter_count(LightDrawsArguments draws) {
  return draws.scene.at[0].emitter_count;
}
uint tree_samples(LightDrawsArguments draws) {
  uint lights = emitters_alone(draws) ? emitter_count(draws) : draws.scene.at[0].light_tree_size;
  return lights > 0u ? draws.tree_samples : 0u;
}
uint tree_candidates(LightDrawsArguments draws) {
  return draws.candidates;
}
EmitterRecord fetch_emitter(LightDrawsArguments draws, uint emitter) {
  return draws.scene.at[0].emitters.at[emitter];
}
vec3 emitted_radiance(LightDrawsArguments draws, EmitterRecord emitter, vec2 barycentrics,
                      vec3 direction_ws) {
  return emitted_radiance(draws.scene, emitter, barycentrics, direction_ws);
}

MaterialRecord emitter_material(LightDrawsArguments draws, EmitterRecord emitter) {
  return material_of(draws.scene, emitter.instance);
}

#include "raytracing/direct_light.inl.h"

/// The shadow ray to a candidate.
RayRecord shadow_ray(LitPointRecord point, LightCandidate light) {
  return shadow_ray_record(point.position_ws, point.geometric_normal_ws, light);
}

#endif
