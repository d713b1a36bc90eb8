// SPDX-License-Identifier: Apache-2.0
// Based on: Segovia et al., "Bidirectional Instant Radiosity", EGSR 2006: lights are weighted by
// their contribution to the camera. Here, that of whole blocks of texels is measured at a few
// points of the view.
#include "rsm/maps/lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "rsm/gather.h"
#include "shared/color.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

constexpr std::size_t kClustersPerTask = 256;
// A cluster's weight is its power times this power of the sum of squares of a watt's light at the
// points. Sampling would call for 1/2; clusters that contribute much need a little less, as their
// error falls with their size.
constexpr float kBroughtExponent = 0.4f;
// Clusters are scaled by at most this factor to the light of their texels. Those of several maps,
// which may hold light of a wall's far side, are scaled down as far as needed.
constexpr float kMaxScale = 2.0f;
// Share of power alone in the weights, so that light which reaches none of the points is not left
// to a few huge clusters.
constexpr float kPowerShare = 0.1f;
// Makes these random numbers independent of others.
constexpr uint kDealSalt = 0x4445414cu;

/// The light of a watt of each cluster at the points; all 1 where there are no points.
std::vector<TermSums> brought_to(const ViewPoints& points, const std::vector<Cluster>& clusters) {
  std::vector<TermSums> sums(clusters.size(), TermSums{1.0f, 1.0f});
  if (points.count == 0) return sums;
  parallel_chunks(clusters.size(), kClustersPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<RsmTexel> texels;
    for (std::size_t i = begin; i < end; ++i) texels.push_back(clusters[i].texel);
    sum_terms(points.planes(), points.capacity, texels, &sums[begin]);
  });
  return sums;
}

/// Sets the clusters' weights and their light at the points.
void weigh(std::span<const TermSums> sums, std::vector<Cluster>& clusters) {
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    Cluster& cluster = clusters[i];
    const vec3& flux = cluster.texel.flux;
    cluster.weight =
        std::max({flux.x, flux.y, flux.z}) * std::pow(sums[i].squares, kBroughtExponent);
    cluster.brought = luminance(flux) * sums[i].terms;
  }

  // Mix with power alone, scaled to the same sum
  double power = 0.0, brought = 0.0;
  for (const Cluster& cluster : clusters) {
    const vec3& flux = cluster.texel.flux;
    power += std::max({flux.x, flux.y, flux.z});
    brought += cluster.weight;
  }
  if (!(power > 0.0)) return;
  const double share = brought > 0.0 ? kPowerShare * brought / power : 1.0;
  for (Cluster& cluster : clusters) {
    const vec3& flux = cluster.texel.flux;
    cluster.weight += static_cast<float>(share * std::max({flux.x, flux.y, flux.z}));
  }
}

}  // namespace

ViewPoints::ViewPoints(int most) : floats(static_cast<std::size_t>(6 * most)), capacity(most) {}

void ViewPoints::add(const vec3& position_ws, const vec3& normal_ws) {
  for (int c = 0; c < 3; ++c) {
    floats[(kPositionPlane + c) * capacity + count] = position_ws[c];
    floats[(kNormalPlane + c) * capacity + count] = normal_ws[c];
  }
  ++count;
}

ViewPoints view_points(const RsmView& view, std::uint32_t seed) {
  ViewPoints points(kViewPoints);
  RandomStream random = make_random_stream(0u, kViewSalt, seed);
  const vec2 shift = next_uniform2(random);
  for (uint i = 0; i < kViewPointDraws && points.count < points.capacity; ++i) {
    const ivec2 at = view_point_pixel(i, shift, {view.width, view.height});
    const std::size_t pixel = static_cast<std::size_t>(at.y) * view.width + at.x;
    if (view.normals_ws[pixel] == vec3(0.0f)) continue;
    points.add(view.positions_ws[pixel], view.normals_ws[pixel]);
  }
  return points;
}

std::vector<Cluster> choose_clusters(std::vector<Cluster> clusters, std::span<const TermSums> sums,
                                     const ViewPoints& points, const RsmSettings& settings,
                                     bool overlap) {
  weigh(sums, clusters);
  const auto subs = static_cast<std::uint32_t>(settings.sub_maps * settings.sub_maps);
  clusters = merge_clusters(std::move(clusters),
                            (static_cast<std::uint32_t>(settings.texels) + subs - 1) / subs * subs,
                            overlap);

  // One normal and one position do not give quite the light of many: scale each cluster to match
  const std::vector<TermSums> now = brought_to(points, clusters);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    RsmTexel& texel = clusters[i].texel;
    const float brings = luminance(texel.flux) * now[i].terms;
    if (!(brings > 0.0f) || points.count == 0) continue;
    const float least = overlap ? 0.0f : 1.0f / kMaxScale;
    const float scale = std::clamp(clusters[i].brought / brings, least, kMaxScale);
    texel.flux *= scale;
  }
  return clusters;
}

std::vector<std::uint32_t> morton_order(int resolution) {
  const auto size = static_cast<std::uint32_t>(resolution);
  const std::uint32_t edge = std::bit_ceil(size);
  const auto every_second_bit = [](std::uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1u)) & 0x33333333u;
    v = (v | (v >> 2u)) & 0x0F0F0F0Fu;
    v = (v | (v >> 4u)) & 0x00FF00FFu;
    return (v | (v >> 8u)) & 0x0000FFFFu;
  };
  std::vector<std::uint32_t> order;
  order.reserve(static_cast<std::size_t>(size) * size);
  for (std::uint32_t code = 0; code < edge * edge; ++code) {
    const std::uint32_t x = every_second_bit(code), y = every_second_bit(code >> 1u);
    if (x < size && y < size) order.push_back(y * size + x);
  }
  return order;
}

namespace {

void shuffle(std::vector<std::uint32_t>& deal, RandomStream& random) {
  for (auto left = static_cast<std::uint32_t>(deal.size()); left > 1; --left) {
    const auto other = static_cast<std::uint32_t>(next_uniform(random) * static_cast<float>(left));
    std::swap(deal[left - 1], deal[std::min(other, left - 1)]);
  }
}

}  // namespace

RsmLights deal_lights(std::span<const ChosenOfMap> maps, const RsmSettings& settings) {
  const auto subs = static_cast<std::uint32_t>(settings.sub_maps * settings.sub_maps);
  struct Dealt {
    RsmTexel texel;
    std::uint32_t place;
  };
  std::vector<std::vector<Dealt>> dealt(subs);
  std::uint32_t first = 0;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    // Deal each run of neighbours to all sub-maps: in order, or in an order of the run's own
    const std::vector<Cluster>& chosen = maps[m].chosen;
    std::vector<std::uint32_t> deal(subs);
    std::iota(deal.begin(), deal.end(), 0u);
    RandomStream random = make_random_stream(static_cast<uint>(m), kDealSalt, settings.seed);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (settings.shuffle && k % subs == 0) shuffle(deal, random);
      // One sub-map holds one of `subs` shares of the light and must represent all of it. The
      // softening does not grow for that, as the blurs combine all sub-maps
      Dealt light = {chosen[k].texel, first + chosen[k].place};
      light.texel.flux *= static_cast<float>(subs);
      light.texel.softening *= settings.softening;
      dealt[deal[k % subs]].push_back(light);
    }
    first += maps[m].texels;
  }

  // Sub-maps are read in step: fill up those with one texel less by a texel without light
  std::size_t longest = 0;
  for (const std::vector<Dealt>& sub_map : dealt) longest = std::max(longest, sub_map.size());
  Dealt dark = {{}, first};
  dark.texel.softening = 1.0f;
  for (std::vector<Dealt>& sub_map : dealt) sub_map.resize(longest, dark);

  // A gather sums the vectors to every few texels of a sub-map. Rotate these, so that blurs combine
  // the vectors to different texels in each sub-map
  for (std::size_t s = 0; s < dealt.size(); ++s) {
    for (std::size_t k = 0; k + kTexelsPerDirection <= longest; k += kTexelsPerDirection) {
      const auto begin = dealt[s].begin() + static_cast<std::ptrdiff_t>(k);
      std::rotate(begin, begin + static_cast<std::ptrdiff_t>(s % kTexelsPerDirection),
                  begin + kTexelsPerDirection);
    }
  }

  RsmLights lights;
  lights.starts.push_back(0);
  for (const std::vector<Dealt>& sub_map : dealt) {
    for (const Dealt& light : sub_map) {
      lights.places.push_back(light.place);
      lights.restructured.push_back(light.texel);
    }
    lights.starts.push_back(static_cast<std::uint32_t>(lights.places.size()));
  }
  return lights;
}

std::vector<Cluster> all_texels(const ReflectiveShadowMap& map) {
  std::vector<Cluster> chosen;
  for (const std::uint32_t i : morton_order(map.resolution)) {
    if (map.texels[i].flux != vec3(0.0f)) chosen.push_back({map.texels[i], i, 0.0f, 0.0f});
  }
  return chosen;
}

void place_rendered(std::vector<RsmTexel> texels, RsmLights& lights) {
  lights.rendered = std::move(texels);
  lights.rendered.emplace_back().softening = 1.0f;
  for (std::size_t k = 0; k < lights.places.size(); ++k) {
    lights.rendered[lights.places[k]] = lights.restructured[k];
  }
}

ChosenOfMap merge_maps(std::span<const ChosenOfMap> maps, const ViewPoints& points,
                       const RsmSettings& settings) {
  ChosenOfMap all;
  for (const ChosenOfMap& map : maps) {
    // A cluster that outweighed its share was divided among neighbours: join its parts again
    const std::size_t first = all.chosen.size();
    for (const Cluster& cluster : map.chosen) {
      const std::uint32_t place = all.texels + cluster.place;
      if (all.chosen.size() > first && all.chosen.back().place == place) {
        all.chosen.back().texel.flux += cluster.texel.flux;
      } else {
        all.chosen.push_back(cluster);
        all.chosen.back().place = place;
      }
    }
    all.texels += map.texels;
  }
  const std::vector<TermSums> sums = brought_to(points, all.chosen);
  all.chosen = choose_clusters(std::move(all.chosen), sums, points, settings, true);
  return all;
}

RsmLights choose_lights(std::size_t maps, const FetchMap& fetch, const RsmView& view,
                        const RsmSettings& settings) {
  const ViewPoints points =
      settings.view_importance ? view_points(view, settings.seed) : ViewPoints(0);
  const bool full = settings.layout == RsmLayout::full;
  std::vector<ChosenOfMap> chosen;
  std::vector<RsmTexel> rendered;
  for (std::size_t m = 0; m < maps; ++m) {
    const ReflectiveShadowMap& map = fetch(m);
    ChosenOfMap of_map;
    of_map.texels = static_cast<std::uint32_t>(map.texels.size());
    if (settings.texels == 0) {
      of_map.chosen = all_texels(map);
    } else {
      std::vector<Cluster> clusters = cluster_blocks(map);
      const std::vector<TermSums> sums = brought_to(points, clusters);
      of_map.chosen = choose_clusters(std::move(clusters), sums, points, settings);
    }
    chosen.push_back(std::move(of_map));
    if (full) rendered.insert(rendered.end(), map.texels.begin(), map.texels.end());
  }
  if (merges_maps(settings, maps)) chosen = {merge_maps(chosen, points, settings)};
  RsmLights lights = deal_lights(chosen, settings);
  if (full) place_rendered(std::move(rendered), lights);
  return lights;
}

RsmLights choose_lights(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                        const RsmSettings& settings) {
  const auto fetch = [&](std::size_t m) -> const ReflectiveShadowMap& { return maps[m]; };
  return choose_lights(maps.size(), fetch, view, settings);
}

}  // namespace lambent
