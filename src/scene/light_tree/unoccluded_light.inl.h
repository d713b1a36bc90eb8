// SPDX-License-Identifier: Apache-2.0
// The unoccluded light of all lights of a light tree at a point, in the common subset of C++ and
// GLSL. The includer provides the type
//   LitTreeRef  a tree
// and
//   uint light_tree_size(LitTreeRef tree)    its nodes; the first one is the root
//   LightTreeNode fetch_node(LitTreeRef tree, uint node)
//   uint emitter_count(LitTreeRef tree)      of emissive triangles and pieces of them, which come
//                                              first among the lights of leaves
//   EmitterRecord fetch_emitter(LitTreeRef tree, uint emitter)
//   LightRecord fetch_light(LitTreeRef tree, uint light)

/// Radiance of a white Lambert surface with this unit normal under the light of a leaf [W/(m^2
/// sr)].
LAMBENT_FN vec3 light_of_leaf(LitTreeRef tree, LightTreeNode leaf, vec3 position_ws,
                              vec3 normal_ws) {
  uint light = leaf.link & ~kLightTreeLeaf;
  uint emitters = emitter_count(tree);
  if (light < emitters) {
    EmitterRecord emitter = fetch_emitter(tree, light);
    return leaf.tint * (leaf.intensity / emitter.area) *
           triangle_form_factor(emitter.corner_ws - position_ws, emitter.edge1_ws, emitter.edge2_ws,
                                normal_ws);
  }
  PunctualSample arrived = sample_punctual(fetch_light(tree, light - emitters), position_ws);
  return arrived.irradiance * kInvPi * max(dot(arrived.to_light, normal_ws), 0.0f);
}

// Capacity of the stack of nodes, above the depth of trees that occur. Where it is full, clusters
// are not opened.
const int kMostWaitingNodes = 48;

/// Radiance of a white Lambert surface with this unit normal [W/(m^2 sr)], without noise and
/// continuous. Distant clusters count as one light: Barnes and Hut, "A Hierarchical O(N log N)
/// Force-Calculation Algorithm", Nature 324, 1986.
LAMBENT_FN vec3 unoccluded_light(LitTreeRef tree, vec3 position_ws, vec3 normal_ws) {
  if (light_tree_size(tree) == 0u) return vec3(0.0f);
  uint waiting[kMostWaitingNodes];
  float shares[kMostWaitingNodes];
  int count = 1;
  waiting[0] = 0u;
  shares[0] = 1.0f;
  vec3 sum = vec3(0.0f);
  while (count > 0) {
    --count;
    LightTreeNode node = fetch_node(tree, waiting[count]);
    float share = shares[count];
    // Skip clusters that are entirely below the horizon
    vec3 offset = node.center_ws - position_ws;
    if (dot(normal_ws, offset) + dot(abs(normal_ws), node.half_size) <= 0.0f) continue;
    float opened = 1.0f;
    if (node.half_size != vec3(0.0f)) {
      opened = count + 2 <= kMostWaitingNodes ? opened_share(node, position_ws) : 0.0f;
    }
    if (opened < 1.0f) {
      sum += share * (1.0f - opened) * light_of_cluster(node, position_ws, normal_ws) * node.tint;
    }
    if (opened <= 0.0f) continue;
    if ((node.link & kLightTreeLeaf) != 0u) {
      sum += share * opened * light_of_leaf(tree, node, position_ws, normal_ws);
      continue;
    }
    waiting[count] = node.link + 1u;
    waiting[count + 1] = node.link;
    shares[count] = share * opened;
    shares[count + 1] = share * opened;
    count += 2;
  }
  return sum;
}
