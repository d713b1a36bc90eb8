// SPDX-License-Identifier: Apache-2.0
// Clusters of lights in a light tree, and the bounds from which their importance for a point is
// computed; importance_of() of light_importance.inl.h is the formula.
// Based on: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", PACMCGIT 1(2), 2018.
#ifndef LAMBENT_SCENE_LIGHT_TREE_MATH_H
#define LAMBENT_SCENE_LIGHT_TREE_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

// LightTreeNode::link is the index of the first of two adjacent children; for a node in a group,
// the index of the group of its children; for a leaf, the index of the light with this bit set.
const uint kLightTreeLeaf = 0x80000000u;

// Number of nodes in a group, which are the children of one node in a wide tree. Unused ones at the
// end have no intensity. A group is evaluated at once, on processors in the lanes of a vector.
const uint kLightGroupSize = 8u;

/// A cluster of lights: bounds of their places, orientations and intensities.
struct LightTreeNode {
  vec3 center_ws;    ///< Centre of a box around them [m].
  vec3 half_size;    ///< Half of its edges [m].
  vec3 axis_ws;      ///< Axis of a cone that contains their orientations; unit.
  float cos_spread;  ///< Cosine of that cone's half angle.
  float sin_spread;  ///< Sine of that cone's half angle.
  float intensity;   ///< Sum of their intensities along their axes [W/sr], luminance.
  /// Mean of their intensity over all directions, over `intensity`.
  float mean_relative_intensity;
  float cos_emission;  ///< Cosine of the largest angle from its axis at which a light emits.
  uint both_sides;     ///< 1: some also emit in the opposite direction.
  vec3 tint;           ///< Their mean colour by intensity; its luminance is 1.
  uint link;           ///< Children or light, as above.
};

/// A light that was picked, and the uniform number that picked it, rescaled.
struct LightPick {
  uint light;
  float probability;  ///< Of picking it; 0: none was picked, since none is visible.
  float rest;         ///< Uniform, 0 to 1.
  /// Weight of the visibility of the smallest of its clusters that has one, see LightVisibility;
  /// 1 where none has.
  float visibility;
};

// Number of picks that traverse the tree together.
const uint kMostPicks = 8u;

struct LightPicks {
  LightPick at[kMostPicks];
};

/// The importances of the nodes of a group.
struct NodeImportances {
  float of[kLightGroupSize];
};

/// Lights closer than this count as being this far away [m^2]: inverse squares stay finite.
const float kMinSquaredClusterDistance = 1e-20f;

/// The squared distance to a cluster is approximated by the distance to its box times the distance
/// to its centre, plus this share of the squared half diagonal, which dominates within the box.
/// From 0.06 to 0.25 the variance near meshes of emissive triangles is about the same; with the
/// distance to the centre and the whole diagonal it is up to 60 times as much.
const float kSizeShare = 0.125f;

/// Importances are clamped to this, so that the sum over a group is finite.
const float kMaxImportance = 1e37f;

/// Directions are divided by distances of at least this [m].
const float kMinClusterDistance = 1e-10f;

/// Squared length of the sum of two unit vectors below which they count as opposite.
const float kMinSquaredHalfVector = 1e-6f;

/// Approximation of a point's BRDF for picking lights: a diffuse part and a lobe about the mirror
/// direction. The factor of the GGX lobe includes the normal's cosine and the masking of the
/// viewer, but not the shadowing of the light.
struct PickLobe {
  vec3 to_viewer_ws;    ///< Unit.
  float squared_alpha;  ///< Of the lobe's width.
  /// Factor [1/sr] of the cosine of light, >= 0: diffusely reflected radiance over the irradiance.
  /// It is 1 where only the cosine counts.
  float diffuse;
  /// Factor [1/sr] of squared_alpha / (squared_alpha + sin^2 (1 - squared_alpha))^2, where sin is
  /// the sine between the half vector and the normal, >= 0: radiance reflected about the mirror
  /// direction, over the irradiance perpendicular to the light. It is 0 without a lobe.
  float specular;
};

/// The lobe of a diffuse point.
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

/// The importance of a cluster for a point with this unit normal: an approximate bound of its
/// contribution, up to a common factor; 0 where it cannot contribute. The normal is 0 for a point
/// in the air, which has no horizon. After Conty Estevez and Kulla 2018, sec. 4.1, with bounds by
/// boxes in place of spheres, which are tighter for close lights.
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
