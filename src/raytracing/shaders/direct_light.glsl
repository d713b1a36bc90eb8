// SPDX-License-Identifier: Apache-2.0
// Access to lights and emissive triangles in a device's memory, as direct_light.inl.h requires it.
// Samples that ask for a ray of their own have it from an earlier kernel, and its hit is read.
#ifndef LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL

#include "raytracing/emitter_sampling.h"
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/vulkan/shading_records.h"

#define EmittersRef SceneArray
#define LitPointRef LitPointRecord
#define DrawsRef LightDrawsArguments

uint emitter_count(SceneArray scene) {
  return scene.at[0].emitter_count;
}
EmitterRecord fetch_emitter(SceneArray scene, uint emitter) {
  return scene.at[0].emitters.at[emitter];
}
float fetch_cumulative(SceneArray scene, uint emitter) {
  return scene.at[0].emitter_cumulative.at[emitter];
}
float fetch_pdf_area(SceneArray scene, uint instance, uint triangle) {
  uint first = scene.at[0].instances.at[instance].first_emitter_pdf;
  return first == kEmitsNothing ? 0.0f : scene.at[0].emitter_pdfs.at[first + triangle];
}

#include "scene/emissive_sample.inl.h"

uint light_count(LightDrawsArguments draws) {
  return draws.scene.at[0].light_count;
}
LightRecord fetch_light(LightDrawsArguments draws, uint light) {
  return draws.scene.at[0].lights.at[light];
}
uint emitter_samples(LightDrawsArguments draws) {
  return emitter_count(draws.scene) > 0u ? draws.emissive_samples : 0u;
}
EmissiveSample fetch_emissive_sample(LightDrawsArguments draws, vec3 u) {
  return sample_emissive(draws.scene, draws.scene, u);
}
/// What the ray met that emitter_rays.comp.glsl wrote.
EmitterPoint find_emitter(LightDrawsArguments draws, LitPointRecord point, uint sample_index,
                          vec3 direction) {
  HitRecord hit = draws.emitter_hits.at[sample_index * draws.count + gl_GlobalInvocationID.x];
  if (missed(hit)) return no_emitter();
  return emitter_seen(
      emissive_point(draws.scene, draws.scene, hit.instance, hit.triangle, hit.barycentrics),
      point.position_ws);
}

#include "raytracing/direct_light.inl.h"

/// A ray that is not traced.
RayRecord no_ray() {
  return RayRecord(vec3(0.0f), 0.0f, vec3(0.0f, 0.0f, 1.0f), 0.0f, 0u);
}

/// The ray that asks whether a candidate reaches a point.
RayRecord shadow_ray(LitPointRecord point, LightCandidate light) {
  return shadow_ray_record(point.position_ws, point.geometric_normal_ws, light);
}

#endif
