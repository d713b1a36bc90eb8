// SPDX-License-Identifier: Apache-2.0
// Which texels of the maps light the picture, and how they are dealt to sub-maps.
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

/// The texels that are gathered, twice: where they were rendered, and restructured.
struct RsmLights {
  /// RsmLayout::full: all texels of all maps, one map after the other, where they were rendered,
  /// and at the end one that brings nothing. Those that stand for a cluster hold the light of all
  /// of it. Other layouts do not read it, and it is empty.
  std::vector<RsmTexel> rendered;
  /// The chosen ones, sub-map after sub-map, each contiguous and all of one length.
  std::vector<RsmTexel> restructured;
  /// Of each of `restructured`: where in `rendered` it came from.
  std::vector<std::uint32_t> places;
  /// Where in `restructured` each sub-map starts, and the end: sub_maps^2 + 1 entries.
  std::vector<std::uint32_t> starts;

  std::uint32_t count(int sub_map) const { return starts[sub_map + 1] - starts[sub_map]; }
};

/// Gives a map by its index. Maps are asked for once each, in their order, and are not read any
/// more when the next is asked for: they may all share one map's memory.
using FetchMap = std::function<const ReflectiveShadowMap&(std::size_t)>;

/// Brings the texels of each map together in settings.texels clusters (rounded up to fill all
/// sub-maps alike), more of them where they matter to the view, if that is asked for: no light is
/// lost. With settings.merge_maps, those of all maps together. All texels, as they are, where
/// settings.texels is 0. Each lands in exactly one sub-map, and every sub-map alone stands for all
/// light.
RsmLights choose_lights(std::size_t maps, const FetchMap& fetch, const RsmView& view,
                        const RsmSettings& settings);
/// The same of maps that are all there.
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
/// points (`sums`; all 1 where there are no points). `overlap` as of merge_clusters.
std::vector<Cluster> choose_clusters(std::vector<Cluster> clusters, std::span<const TermSums> sums,
                                     const ViewPoints& points, const RsmSettings& settings,
                                     bool overlap = false);

/// What was chosen of a map, and how many texels it has.
struct ChosenOfMap {
  std::vector<Cluster> chosen;
  std::uint32_t texels = 0;
};

/// Whether the texels of so many maps are brought together across maps.
inline bool merges_maps(const RsmSettings& settings, std::size_t maps) {
  return settings.merge_maps && settings.texels > 0 && maps > 1;
}

/// Brings what was chosen of each map together once more, in settings.texels clusters of all maps:
/// surfaces that several lights reach send all of their light from the same clusters.
ChosenOfMap merge_maps(std::span<const ChosenOfMap> maps, const ViewPoints& points,
                       const RsmSettings& settings);

/// Deals what was chosen to sub-maps. `rendered` stays empty.
RsmLights deal_lights(std::span<const ChosenOfMap> maps, const RsmSettings& settings);

/// All texels that are lit, as they are, neighbours after each other.
std::vector<Cluster> all_texels(const ReflectiveShadowMap& map);

/// Makes `rendered` of all texels of all maps.
void place_rendered(std::vector<RsmTexel> texels, RsmLights& lights);

/// The order in which a curve that keeps neighbours together (Morton 1966) visits the texels of a
/// square map of any size.
std::vector<std::uint32_t> morton_order(int resolution);

}  // namespace lambent
