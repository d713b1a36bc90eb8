// SPDX-License-Identifier: Apache-2.0
// Clusters of lights, from which a light tree is built: boxes, cones and intensities.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "lambent/scene.h"
#include "scene/emissive_sample.h"
#include "scene/light_tree/light_tree_math.h"
#include "scene/punctual_light.h"

namespace lambent {

/// A cone that bounds the orientations of the lights of a cluster.
struct FacingCone {
  glm::vec3 axis{0.0f, 0.0f, 1.0f};  ///< Unit.
  float cos_spread = 1.0f;    ///< Cosine of the largest angle between the axis and a light's axis.
  float cos_emission = 1.0f;  ///< Cosine of the largest angle from its axis at which a light emits.
  bool both_sides = false;    ///< Some lights emit to the other side, too.
};

/// The smallest cone around two, up to rounding. Conty Estevez and Kulla 2018, algorithm 1; the
/// axis of lights with two sides may be reversed.
FacingCone join(const FacingCone& a, const FacingCone& b);

/// A set of lights.
struct LightCluster {
  Bounds box;  ///< [m]
  FacingCone cone;
  double intensity = 0.0;         ///< [W/sr], luminance.
  glm::dvec3 intensity_rgb{0.0};  ///< [W/sr]
  double mean = 0.0;              ///< Mean over all directions [W/sr], luminance.
  bool empty = true;

  void add(const LightCluster& other);

  /// The cluster's cost: its intensity times measures of its directions and of its area, which good
  /// trees keep small. Conty Estevez and Kulla 2018, eq. 1, with areas of boxes.
  double cost() const;
};

/// `tint`: colour of its light, of luminance 1.
LightCluster cluster_of(const EmitterRecord& emitter, float intensity, const glm::vec3& tint);
LightCluster cluster_of(const LightRecord& light);

/// The tree node of a cluster; its link is not set.
LightTreeNode node_of(const LightCluster& cluster);

}  // namespace lambent
