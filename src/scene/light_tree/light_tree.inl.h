// SPDX-License-Identifier: Apache-2.0
// Picks lights from a light tree, in the common subset of C++ and GLSL. The includer provides the
// type
//   LightTreeRef  a tree
// and
//   uint light_tree_size(LightTreeRef tree)    0: there are no lights
//   uint fetch_group_link(LightTreeRef tree, uint group, uint child)
//   void group_importances(LightTreeRef tree, uint group, vec3 position_ws, vec3 normal_ws,
//                          PickLobe lobe, out float importances[kLightGroupSize])
//                                              group 0 is the root's
//   bool knows_visibility(LightTreeRef tree, uint group)
//   float fetch_visibility(LightTreeRef tree, uint group, uint child)
//                                              weight of a node; called where knows_visibility()
// where importances are those of light_importance.

/// The importances of a group's nodes times the weights of their visibility.
LAMBENT_FN NodeImportances weighted_importances(LightTreeRef tree, uint group, vec3 position_ws,
                                                vec3 normal_ws, PickLobe lobe) {
  NodeImportances importances;
  group_importances(tree, group, position_ws, normal_ws, lobe, importances.of);
  if (knows_visibility(tree, group)) {
    for (uint k = 0u; k < kLightGroupSize; ++k) {
      importances.of[k] *= fetch_visibility(tree, group, k);
    }
  }
  return importances;
}

/// Fluence rate at a point, which is irradiance from all around, of all lights of the tree as if
/// nothing were in the way [W/m^2], luminance. From the clusters at the root, as importances bound
/// them: within them up to about 3 times as much.
LAMBENT_FN float fluence(LightTreeRef tree, vec3 position_ws) {
  if (light_tree_size(tree) == 0u) return 0.0f;
  NodeImportances importances;
  group_importances(tree, 0u, position_ws, vec3(0.0f), no_pick_lobe(), importances.of);
  float sum = 0.0f;
  for (uint k = 0u; k < kLightGroupSize; ++k) sum += importances.of[k];
  return sum;
}

/// Scales the specular part of a lobe down so that at the root it gets at most half of all picks.
/// Highlights that are brighter by orders of magnitude would leave no picks for diffuse light.
LAMBENT_FN PickLobe bounded_lobe(LightTreeRef tree, vec3 position_ws, vec3 normal_ws,
                                 PickLobe lobe) {
  if (lobe.specular <= 0.0f || light_tree_size(tree) == 0u) return lobe;
  PickLobe evenly = lobe;
  evenly.specular = 0.0f;
  NodeImportances even = weighted_importances(tree, 0u, position_ws, normal_ws, evenly);
  NodeImportances both = weighted_importances(tree, 0u, position_ws, normal_ws, lobe);
  float even_sum = 0.0f;
  float specular_sum = 0.0f;
  for (uint k = 0u; k < kLightGroupSize; ++k) {
    even_sum += even.of[k];
    specular_sum += max(both.of[k] - even.of[k], 0.0f);
  }
  if (specular_sum > even_sum) lobe.specular *= even_sum / specular_sum;
  return lobe;
}

/// Picks lights for a point with this unit normal among those below a link of the tree, by their
/// importance for the reflection `lobe`, which is a result of bounded_lobe(). The first `count` of
/// `picks` hold uniform numbers in `rest`, in increasing order: picks that reach the same group are
/// then consecutive, and evaluate it once for all of them.
LAMBENT_FN void pick_below(LightTreeRef tree, uint link, vec3 position_ws, vec3 normal_ws,
                           PickLobe lobe, uint count, LAMBENT_INOUT(LightPicks) picks) {
  for (uint i = 0u; i < count; ++i) {
    picks.at[i].light = link;
    picks.at[i].probability = 1.0f;
    picks.at[i].visibility = 1.0f;
  }
  uint first = 0u;
  while (first < count) {
    uint group = picks.at[first].light;
    if ((group & kLightTreeLeaf) != 0u) {
      picks.at[first].light = group & ~kLightTreeLeaf;
      ++first;
      continue;
    }
    NodeImportances importances = weighted_importances(tree, group, position_ws, normal_ws, lobe);
    // Compute the cumulative importances
    float ends[kLightGroupSize];
    float sum = 0.0f;
    for (uint k = 0u; k < kLightGroupSize; ++k) {
      sum += importances.of[k];
      ends[k] = sum;
    }
    for (uint i = first; i < count && picks.at[i].light == group; ++i) {
      if (!(sum > 0.0f)) {
        picks.at[i].probability = 0.0f;
        picks.at[i].light = kLightTreeLeaf;
        continue;
      }
      float place = picks.at[i].rest * sum;
      uint child = 0u;
      for (uint k = 0u; k < kLightGroupSize; ++k) child += place >= ends[k] ? 1u : 0u;
      // Rounding may put the number at the end of all intervals; take the last child with an
      // importance
      if (child == kLightGroupSize) {
        --child;
        while (child > 0u && ends[child - 1u] >= sum) --child;
      }
      float begin = child > 0u ? ends[child - 1u] : 0.0f;
      float importance = importances.of[child];
      picks.at[i].rest = clamp((place - begin) / importance, 0.0f, kLargestUniform);
      picks.at[i].probability *= importance / sum;
      picks.at[i].light = fetch_group_link(tree, group, child);
      if (knows_visibility(tree, group)) {
        picks.at[i].visibility = fetch_visibility(tree, group, child);
      }
    }
  }
}

/// Picks lights among all of the tree, as pick_below() does.
LAMBENT_FN void pick_lights(LightTreeRef tree, vec3 position_ws, vec3 normal_ws, PickLobe lobe,
                            uint count, LAMBENT_INOUT(LightPicks) picks) {
  if (light_tree_size(tree) > 0u) {
    pick_below(tree, 0u, position_ws, normal_ws, lobe, count, picks);
    return;
  }
  for (uint i = 0u; i < count; ++i) {
    picks.at[i].light = kLightTreeLeaf;
    picks.at[i].probability = 0.0f;
    picks.at[i].visibility = 1.0f;
  }
}
