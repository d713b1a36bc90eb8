// SPDX-License-Identifier: Apache-2.0
// What a cluster of lights may send to a point: the weights by which a light tree is descended.
// Based on: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", PACMCGIT 1(2), 2018.
#ifndef LAMBENT_SCENE_LIGHT_TREE_MATH_H
#define LAMBENT_SCENE_LIGHT_TREE_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

// LightTreeNode::link: the index of the first of two children, which are neighbours; in a group
// that of the group of its children; of a leaf the light, with this bit.
const uint kLightTreeLeaf = 0x80000000u;

// Nodes of a group: of a tree whose nodes have up to so many children, those of one node. What has
// no intensity fills the last places. They are looked at together, and on processors in the lanes
// of a vector.
const uint kLightGroupSize = 8u;

/// A cluster of lights: where they are, and where they send light to.
struct LightTreeNode {
  vec3 center_ws;      ///< Of a box around them [m].
  vec3 half_size;      ///< Half of its edges [m].
  vec3 axis_ws;        ///< Of a cone that holds the directions that they face; unit.
  float cos_spread;    ///< Of the angle between that cone's axis and side.
  float sin_spread;    ///< Its sine.
  float intensity;     ///< Sum of what they send the way that each faces [W/sr], as luminance.
  float mean_sent;     ///< Mean over all directions of what they send, over `intensity`.
  float cos_emission;  ///< Light leaves at most at this angle from where a light faces.
  uint both_sides;     ///< 1: they also send light the other way.
  uint link;           ///< Children or light, as above.
};

/// A light that was picked, and what is left of the uniform number that picked it.
struct LightPick {
  uint light;
  float probability;  ///< Of picking it; 0: none was, for none can be seen.
  float rest;         ///< Uniform again, 0 to 1.
};

// Picks that descend together.
const uint kMostPicks = 8u;

struct LightPicks {
  LightPick at[kMostPicks];
};

/// Lights closer than this count as being this far away [m^2]: inverse squares stay finite.
const float kMinSquaredClusterDistance = 1e-20f;

/// The squared distance to a cluster is taken for that to its box times that to its middle, which
/// is between the extremes, and this share of the squared half diagonal: within the box, its size
/// counts. From 0.06 to 0.25 the variance near meshes of emissive triangles is about the same;
/// with the distance to the middle and the whole diagonal it is up to 60 times that.
const float kSizeShare = 0.125f;

/// No importance is larger: sums of the eight of a group are still floats.
const float kMaxImportance = 1e37f;

/// Directions are divided by distances of at least this [m].
const float kMinClusterDistance = 1e-10f;

/// Squared length of the sum of two unit vectors below which they count as opposite.
const float kMinSquaredHalfVector = 1e-6f;

/// How a point sends on what it receives, as far as it matters for which lights are picked for it:
/// evenly, and about a mirror direction. A GGX lobe with the normal's cosine and the masking of the
/// viewer in its factor; what hides the light is left out.
struct PickLobe {
  vec3 to_viewer_ws;    ///< Unit.
  float squared_alpha;  ///< Of the lobe's width.
  /// Factor [1/sr] of the cosine of light, >= 0: radiance that the point sends on evenly over the
  /// irradiance that it receives. It is 1 where nothing but the cosine counts.
  float diffuse;
  /// Factor [1/sr] of squared_alpha / (squared_alpha + sin^2 (1 - squared_alpha))^2, where sin is
  /// the sine between the half vector and the normal, >= 0: radiance that the point sends on about
  /// the mirror direction, over the irradiance perpendicular to light. It is 0 without a lobe.
  float specular;
};

/// Of a point that sends all light on evenly.
LAMBENT_FN PickLobe no_pick_lobe() {
  PickLobe lobe = {vec3(0.0f), 1.0f, 1.0f, 0.0f};
  return lobe;
}

LAMBENT_FN float root(float x) {
  return sqrt(x);
}

#define Real float
#define LAMBENT_REAL_FN LAMBENT_FN
#include "scene/light_tree/light_importance.inl.h"
#undef Real
#undef LAMBENT_REAL_FN

/// What a cluster may send to a point with this unit normal, up to a common factor; 0 where it can
/// send nothing. A point in the air has no horizon: its normal is 0. After Conty Estevez and Kulla
/// 2018, sec. 4.1, with bounds by boxes in place of spheres: these say more about lights that are
/// close.
LAMBENT_FN float light_importance(LightTreeNode node, vec3 position_ws, vec3 normal_ws,
                                  PickLobe lobe) {
  ClusterNumbers numbers = {node.center_ws.x,  node.center_ws.y,      node.center_ws.z,
                            node.half_size.x,  node.half_size.y,      node.half_size.z,
                            node.axis_ws.x,    node.axis_ws.y,        node.axis_ws.z,
                            node.cos_spread,   node.sin_spread,       node.intensity,
                            node.cos_emission, float(node.both_sides)};
  return importance_of(numbers, position_ws, normal_ws, lobe);
}

LAMBENT_END
#endif
