// SPDX-License-Identifier: Apache-2.0
// Access to lights and emissive triangles in a device's memory, as direct_light.inl.h requires it.
// The includer defines ReceiverRef first, and target_of and lobe_of afterwards.
#ifndef LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL

#include "raytracing/emitter_sampling.h"
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/vulkan/shading_records.h"
#include "shared/color.h"

/// A scene's light tree, as it is seen from a surface with this row of visibility.
struct SeenLightTree {
  SceneArray scene;
  uint row;
};
#define LightTreeRef SeenLightTree
#define VisibilityRef SceneArray
#define LitPointRef LitPointRecord
#define DrawsRef LightDrawsArguments

#include "scene/emissive_sample.inl.h"

LightVisibilityGrid fetch_visibility_grid(SceneArray scene) {
  return scene.at[0].visibility_grid;
}
uint fetch_visibility_row(SceneArray scene, uint index) {
  return scene.at[0].visibility_rows.at[index];
}

#include "scene/light_tree/light_visibility.inl.h"

SeenLightTree light_tree_from(SceneArray scene, vec3 position_ws, vec3 normal_ws) {
  return SeenLightTree(scene, visibility_row(scene, position_ws, normal_ws));
}
uint light_tree_size(SeenLightTree tree) {
  return tree.scene.at[0].light_tree_size;
}
uint fetch_group_link(SeenLightTree tree, uint group, uint child) {
  return tree.scene.at[0].light_groups.at[group * kLightGroupSize + child].link;
}
void group_importances(SeenLightTree tree, uint group, vec3 position_ws, vec3 normal_ws,
                       PickLobe lobe, out float importances[kLightGroupSize]) {
  for (uint k = 0u; k < kLightGroupSize; ++k) {
    importances[k] = light_importance(tree.scene.at[0].light_groups.at[group * kLightGroupSize + k],
                                      position_ws, normal_ws, lobe);
  }
}
bool knows_visibility(SeenLightTree tree, uint group) {
  return tree.row != kNoVisibilityRow && group < kGroupsWithVisibility;
}
float fetch_visibility(SeenLightTree tree, uint group, uint child) {
  uint place =
      tree.row * tree.scene.at[0].visibility_grid.row_length + group * kLightGroupSize + child;
  uint four = tree.scene.at[0].visibility_weights.at[place >> 2u];
  return visibility_weight((four >> (8u * (place & 3u))) & 0xFFu);
}

#include "scene/light_tree/light_tree.inl.h"

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

#include "raytracing/direct_light.inl.h"

/// The shadow ray to a candidate.
RayRecord shadow_ray(LitPointRecord point, LightCandidate light) {
  return shadow_ray_record(point.position_ws, point.geometric_normal_ws, light);
}

#endif
