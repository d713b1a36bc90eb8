// SPDX-License-Identifier: Apache-2.0
// The light tree in a device's memory, as light_tree.inl.h requires it.
#ifndef LAMBENT_RAYTRACING_SHADERS_LIGHT_TREE_GLSL
#define LAMBENT_RAYTRACING_SHADERS_LIGHT_TREE_GLSL

#include "raytracing/vulkan/scene_records.h"
#include "scene/light_tree/light_tree_math.h"
#include "scene/light_tree/light_visibility_math.h"

/// A scene's light tree, as it is seen from a surface with this row of visibility.
struct SeenLightTree {
  SceneArray scene;
  uint row;
};
#define LightTreeRef SeenLightTree
#define VisibilityRef SceneArray

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

#endif
