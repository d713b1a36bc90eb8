// SPDX-License-Identifier: Apache-2.0
// The light tree in a device's memory, as unoccluded_light.inl.h requires it.
#ifndef LAMBENT_RAYTRACING_SHADERS_UNOCCLUDED_LIGHT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_UNOCCLUDED_LIGHT_GLSL

#include "raytracing/vulkan/scene_records.h"
#include "scene/light_tree/unoccluded_math.h"
#include "shared/color.h"

#define LitTreeRef SceneArray

uint light_tree_size(SceneArray scene) {
  return scene.at[0].light_tree_size;
}
LightTreeNode fetch_node(SceneArray scene, uint node) {
  return scene.at[0].light_tree.at[node];
}
uint emitter_count(SceneArray scene) {
  return scene.at[0].emitter_count;
}
EmitterRecord fetch_emitter(SceneArray scene, uint emitter) {
  return scene.at[0].emitters.at[emitter];
}
LightRecord fetch_light(SceneArray scene, uint light) {
  return scene.at[0].lights.at[light];
}

#include "scene/light_tree/unoccluded_light.inl.h"

#endif
