// SPDX-License-Identifier: Apache-2.0
// Clustering of texels: texels close together on one surface light distant points like one texel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/rsm.h"

namespace lambent {

/// Several texels as one: with their total flux and area, at the mean position weighted by flux.
struct Cluster {
  RsmTexel texel;
  std::uint32_t place = 0;  ///< Index in the map of the brightest of them.
  float weight = 0.0f;      ///< Importance for the picture; see lights.cpp.
  float brought = 0.0f;     ///< Light of all texels at the points of the view; see lights.cpp.
};

/// Clusters the lit texels of a map by blocks of a few texels; where a block shows several
/// surfaces, there is a cluster for each. Row after row of blocks.
std::vector<Cluster> cluster_blocks(const ReflectiveShadowMap& map);

/// Merges clusters until there are `count` of about the same weight, each as compact as possible in
/// position and normal. Clusters that outweigh a share appear several times, each time with its
/// part of the light: there are `count` in any case, unless the total weight is 0. Neighbours in
/// the result are neighbours in the scene. `overlap`: the clusters are of several maps, and may
/// show the same parts of surfaces.
std::vector<Cluster> merge_clusters(std::vector<Cluster> clusters, std::uint32_t count,
                                    bool overlap = false);

}  // namespace lambent
