// SPDX-License-Identifier: Apache-2.0
// Texels brought together: what lies close on one surface lights what is far as one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/rsm.h"

namespace lambent {

/// Several texels as one: their summed flux and area, at the middle of their flux.
struct Cluster {
  RsmTexel texel;
  std::uint32_t place = 0;  ///< In the map, of the brightest of them.
  float weight = 0.0f;      ///< How much it matters to the picture; see lights.cpp.
  float brought = 0.0f;     ///< To the view by all of them; see lights.cpp.
};

/// The lit texels of a map by blocks of a few texels; where a block shows several surfaces, a
/// cluster for each. Row after row of blocks.
std::vector<Cluster> cluster_blocks(const ReflectiveShadowMap& map);

/// Brings clusters together until there are `count`, of about the same weight, each as compact as
/// can be in position and normal. Clusters that outweigh a share appear several times, each time
/// with its part of the light: there are `count` in any case, unless there is no weight at all.
/// Neighbours in the result are neighbours in the scene. `overlap`: they are of several maps, and
/// may show the same pieces of surfaces.
std::vector<Cluster> merge_clusters(std::vector<Cluster> clusters, std::uint32_t count,
                                    bool overlap = false);

}  // namespace lambent
