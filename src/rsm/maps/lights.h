// SPDX-License-Identifier: Apache-2.0
// Chooses the texels of the maps that light the picture, and deals them to sub-maps.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/cross_bilateral.h"
#include "lambent/rsm.h"
#include "rsm/maps/choice.h"
#include "rsm/maps/clusters.h"

namespace lambent {

/// The texels that are gathered, in two orders: as rendered, and restructured.
struct RsmLights {
  /// RsmLayout::full: all texels of all maps, one map after the other, as rendered, and at the end
  /// one without light. Those that represent a cluster hold the light of all of it. Empty in other
  /// layouts, which do not read it.
  std::vector<RsmTexel> rendered;
  /// The chosen texels, sub-map after sub-map, each contiguous and all of one length.
  std::vector<RsmTexel> restructured;
  /// For each of `restructured`, its index in `rendered`.
  std::vector<std::uint32_t> places;
  /// The start of each sub-map in `restructured`, and the end: sub_maps^2 + 1 entries.
  std::vector<std::uint32_t> starts;

  std::uint32_t count(int sub_map) const { return starts[sub_map + 1] - starts[sub_map]; }
};

/// Returns the map of an index. It is called once for each map, in order, and a map is not read any
/// more after the next call, so that all maps may share one map's memory.
using FetchMap = std::function<const ReflectiveShadowMap&(std::size_t)>;

/// Merges the texels of each map into settings.texels clusters (rounded up to fill all sub-maps
/// equally), with more of them where they matter to the view if settings.view_importance: no light
/// is lost. With settings.merge_maps, those of all maps together. Where settings.texels is 0, all
/// texels are gathered as they are. Each lands in exactly one sub-map, and every sub-map alone
/// represents all light.
RsmLights choose_lights(std::size_t maps, const FetchMap& fetch, const RsmView& view,
                        const RsmSettings& settings);
/// The same for maps that are all in memory.
RsmLights choose_lights(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                        const RsmSettings& settings);

/// Points of the view, as planes; unused entries have no normal.
struct ViewPoints {
  explicit ViewPoints(int most);
  void add(const glm::vec3& position_ws, const glm::vec3& normal_ws);
  ConstPlanes planes() const { return {floats.data(), capacity}; }

  std::vector<float> floats;
  int capacity, count = 0;
};

/// The points, kViewPoints or fewer, at which the light of clusters is measured.
ViewPoints view_points(const RsmView& view, std::uint32_t seed);

// The steps of choose_lights(), for callers that have performed earlier steps elsewhere.

/// Merges the clusters of a map's blocks into settings.texels, by the light of each at the points
/// (`sums`; all 1 where there are no points). `overlap`: see merge_clusters().
std::vector<Cluster> choose_clusters(std::vector<Cluster> clusters, std::span<const TermSums> sums,
                                     const ViewPoints& points, const RsmSettings& settings,
                                     bool overlap = false);

/// The chosen clusters of a map, and its number of texels.
struct ChosenOfMap {
  std::vector<Cluster> chosen;
  std::uint32_t texels = 0;
};

/// Whether the texels of this many maps are merged across maps.
inline bool merges_maps(const RsmSettings& settings, std::size_t maps) {
  return settings.merge_maps && settings.texels > 0 && maps > 1;
}

/// Merges the chosen clusters of all maps once more, into settings.texels: surfaces that several
/// lights reach send all of their light from the same clusters.
ChosenOfMap merge_maps(std::span<const ChosenOfMap> maps, const ViewPoints& points,
                       const RsmSettings& settings);

/// Deals the chosen clusters to sub-maps. `rendered` stays empty.
RsmLights deal_lights(std::span<const ChosenOfMap> maps, const RsmSettings& settings);

/// All lit texels, unmerged, ordered such that neighbours follow each other.
std::vector<Cluster> all_texels(const ReflectiveShadowMap& map);

/// Fills `rendered` from all texels of all maps.
void place_rendered(std::vector<RsmTexel> texels, RsmLights& lights);

/// The texels of a square map of any size in the order of a curve that keeps neighbours together
/// (Morton 1966).
std::vector<std::uint32_t> morton_order(int resolution);

}  // namespace lambent
