// SPDX-License-Identifier: Apache-2.0
// Clusters of lights while a light tree is built: boxes, cones and intensities, joined.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "lambent/scene.h"
#include "scene/emissive_sample.h"
#include "scene/light_tree/light_tree_math.h"
#include "scene/punctual_light.h"

namespace lambent {

/// Where the lights of a cluster face.
struct FacingCone {
  glm::vec3 axis{0.0f, 0.0f, 1.0f};  ///< Unit.
  float cos_spread = 1.0f;           ///< Of the largest angle between the axis and a light's.
  float cos_emission = 1.0f;         ///< Of the largest angle from a light's axis that it lights.
  bool both_sides = false;           ///< Some light the other side, too.
};

/// The smallest cone around two, but for rounding. Conty Estevez and Kulla 2018, algorithm 1; the
/// axis of lights with two sides may point either way.
FacingCone join(const FacingCone& a, const FacingCone& b);

/// Lights that are near each other.
struct LightCluster {
  Bounds box;  ///< [m]
  FacingCone cone;
  double intensity = 0.0;  ///< [W/sr], luminance.
  double mean = 0.0;       ///< The same as a mean over all directions.
  bool empty = true;

  void add(const LightCluster& other);

  /// How much of the light of all directions and places around the cluster comes from it: to be
  /// small in good trees. Conty Estevez and Kulla 2018, eq. 1, with areas of boxes.
  double cost() const;
};

LightCluster cluster_of(const EmitterRecord& emitter, float intensity);
LightCluster cluster_of(const LightRecord& light);

/// The node of a cluster, without a link.
LightTreeNode node_of(const LightCluster& cluster);

}  // namespace lambent
