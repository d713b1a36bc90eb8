// SPDX-License-Identifier: Apache-2.0
// Which texels of the maps light the picture, and how they are dealt to sub-maps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cross_bilateral.h"
#include "lambent/rsm.h"
#include "rsm/maps/choice.h"
#include "rsm/maps/clusters.h"

namespace lambent {

/// The texels that are gathered, twice: where they were rendered, and restructured.
struct RsmLights {
  /// All texels of all maps, one map after the other, where they were rendered, and at the end one
  /// that brings nothing. Those that stand for a cluster hold the light of all of it.
  std::vector<RsmTexel> rendered;
  /// The chosen ones, sub-map after sub-map, each contiguous and all of one length.
  std::vector<RsmTexel> restructured;
  /// Of each of `restructured`: where in `rendered` it came from.
  std::vector<std::uint32_t> places;
  /// Where in `restructured` each sub-map starts, and the end: sub_maps^2 + 1 entries.
  std::vector<std::uint32_t> starts;

  std::uint32_t count(int sub_map) const { return starts[sub_map + 1] - starts[sub_map]; }
};

/// Brings the texels of each map together in settings.texels clusters (rounded up to fill all
/// sub-maps alike), more of them where they matter to the view, if that is asked for: no light is
/// lost. All texels, as they are, where settings.texels is 0. Each lands in exactly one sub-map,
/// and every sub-map alone stands for all light.
RsmLights choose_lights(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                        const RsmSettings& settings);

/// Points of the view, as planes; those beyond the last see nothing.
struct ViewPoints {
  explicit ViewPoints(int most);
  void add(const glm::vec3& position_ws, const glm::vec3& normal_ws);
  ConstPlanes planes() const { return {floats.data(), capacity}; }

  std::vector<float> floats;
  int capacity, count = 0;
};

/// kViewPoints of them that are asked what clusters bring them.
ViewPoints view_points(const RsmView& view, std::uint32_t seed);

// The steps of choose_lights, for those that have made the ones before elsewhere.

/// Brings the clusters of a map's blocks together in settings.texels, by what each brings to the
/// points (`sums`; all 1 where there are no points).
std::vector<Cluster> choose_clusters(std::vector<Cluster> clusters, std::span<const TermSums> sums,
                                     const ViewPoints& points, const RsmSettings& settings);

/// What was chosen of a map, and how many texels it has.
struct ChosenOfMap {
  std::vector<Cluster> chosen;
  std::uint32_t texels = 0;
};

/// Deals what was chosen to sub-maps. `rendered` stays empty.
RsmLights deal_lights(std::span<const ChosenOfMap> maps, const RsmSettings& settings);

/// All texels that are lit, as they are, neighbours after each other.
std::vector<Cluster> all_texels(const ReflectiveShadowMap& map);

/// Fills in `rendered`.
void place_rendered(std::span<const ReflectiveShadowMap> maps, RsmLights& lights);

/// The order in which a curve that keeps neighbours together (Morton 1966) visits the texels of a
/// square map of any size.
std::vector<std::uint32_t> morton_order(int resolution);

}  // namespace lambent
