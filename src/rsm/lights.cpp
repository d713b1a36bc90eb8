// SPDX-License-Identifier: Apache-2.0
// Based on: Segovia et al., "Bidirectional Instant Radiosity", EGSR 2006: lights are worth what
// they bring to the camera. Here that is asked of whole blocks of texels, at few points of the
// view.
#include "rsm/lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "rsm/geometry.h"
#include "shared/color.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Texels along an edge of the blocks that share one estimate of importance.
constexpr int kBlock = 8;
// Points of the view that are asked what a block brings to them.
constexpr int kViewPoints = 128;
// Share of texels that is drawn by power alone: light that no point saw is not lost.
constexpr float kPowerShare = 0.1f;
// Keeps the random numbers of different uses apart.
constexpr uint kViewSalt = 0x56494557u, kDrawSalt = 0x44524157u, kDealSalt = 0x4445414cu;

struct ViewPoint {
  vec3 position_ws, normal_ws;
};

std::vector<ViewPoint> view_points(const RsmView& view, std::uint32_t seed) {
  std::vector<ViewPoint> points;
  const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
  RandomStream random = make_random_stream(0u, kViewSalt, seed);
  const vec2 shift = next_uniform2(random);
  for (uint i = 0; i < kViewPoints && pixels > 0; ++i) {
    const vec2 u = fract(shift + plastic_sequence(i));
    const int x = std::min(view.width - 1, static_cast<int>(u.x * static_cast<float>(view.width)));
    const int y =
        std::min(view.height - 1, static_cast<int>(u.y * static_cast<float>(view.height)));
    const std::size_t pixel = static_cast<std::size_t>(y) * view.width + x;
    if (view.normals_ws[pixel] == vec3(0.0f)) continue;
    points.push_back({view.positions_ws[pixel], view.normals_ws[pixel]});
  }
  return points;
}

/// Root mean square over the points of what a watt of a block brings, by one of its texels.
float block_importance(const ReflectiveShadowMap& map, int block_x, int block_y,
                       const std::vector<ViewPoint>& points) {
  const RsmTexel* brightest = nullptr;
  float best = 0.0f, area = 0.0f;
  for (int y = block_y * kBlock; y < std::min((block_y + 1) * kBlock, map.resolution); ++y) {
    for (int x = block_x * kBlock; x < std::min((block_x + 1) * kBlock, map.resolution); ++x) {
      const RsmTexel& texel = map.texels[static_cast<std::size_t>(y) * map.resolution + x];
      area += texel.area;
      if (luminance(texel.flux) <= best) continue;
      best = luminance(texel.flux);
      brightest = &texel;
    }
  }
  if (brightest == nullptr) return 0.0f;
  float sum = 0.0f;
  for (const ViewPoint& point : points) {
    const float term =
        bounded_geometry_term(point.position_ws, point.normal_ws, brightest->position_ws,
                              brightest->normal_ws, kSofteningPerArea * area);
    sum += term * term;
  }
  return std::sqrt(sum / static_cast<float>(std::max<std::size_t>(1, points.size())));
}

/// With which weight each texel of a map is drawn.
std::vector<float> drawing_weights(const ReflectiveShadowMap& map,
                                   const std::vector<ViewPoint>& points) {
  std::vector<float> weights(map.texels.size());
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = luminance(map.texels[i].flux);
  if (points.empty()) return weights;

  const int blocks = (map.resolution + kBlock - 1) / kBlock;
  std::vector<float> importance(static_cast<std::size_t>(blocks) * blocks);
  parallel_chunks(importance.size(), blocks, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const int block = static_cast<int>(b);
      importance[b] = block_importance(map, block % blocks, block / blocks, points);
    }
  });
  const auto importance_of = [&](std::size_t texel) {
    const std::size_t x = texel % map.resolution, y = texel / map.resolution;
    return importance[y / kBlock * blocks + x / kBlock];
  };

  // Mix with the power, each normalised to the same sum
  double power = 0.0, brought = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    power += weights[i];
    brought += static_cast<double>(weights[i]) * importance_of(i);
  }
  if (!(brought > 0.0)) return weights;
  const auto scale = static_cast<float>((1.0 - kPowerShare) * power / brought);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] *= kPowerShare + scale * importance_of(i);
  }
  return weights;
}

/// A texel that stands for `share` of itself: above 1, for others, too. One of `subs` sub-maps
/// holds that share of the light and must stand for all of it; the light is spread no wider for
/// that, as the blurs bring all sub-maps together.
RsmTexel stand_for(RsmTexel texel, float share, std::uint32_t subs, float softening) {
  texel.flux *= share * static_cast<float>(subs);
  texel.area *= std::max(1.0f, share);
  texel.softening *= std::max(1.0f, share) * softening;
  return texel;
}

/// Chosen texels of a map, in the order of the curve, with what each stands for.
struct Choice {
  std::uint32_t texel;
  float share;
};

std::vector<Choice> choose_all(const ReflectiveShadowMap& map,
                               const std::vector<std::uint32_t>& order) {
  std::vector<Choice> chosen;
  for (const std::uint32_t texel : order) {
    if (map.texels[texel].flux != vec3(0.0f)) chosen.push_back({texel, 1.0f});
  }
  return chosen;
}

/// Draws systematically along the curve: neighbouring choices are neighbours in the map.
std::vector<Choice> draw(const std::vector<float>& weights, const std::vector<std::uint32_t>& order,
                         std::uint32_t count, RandomStream random) {
  std::vector<Choice> chosen;
  double total = 0.0;
  for (const float weight : weights) total += weight;
  if (!(total > 0.0)) return chosen;
  const double step = total / count;
  double sum = 0.0;
  double next = step * next_uniform(random);
  for (const std::uint32_t texel : order) {
    sum += weights[texel];
    if (sum < next) continue;
    const auto share = static_cast<float>(step / weights[texel]);
    // A texel that is worth several draws stands for all of them
    for (; next < sum && chosen.size() < count; next += step) chosen.push_back({texel, share});
  }
  return chosen;
}

}  // namespace

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

RsmLights choose_lights(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                        const RsmSettings& settings) {
  const auto subs = static_cast<std::uint32_t>(settings.sub_maps * settings.sub_maps);
  const std::uint32_t count =
      (static_cast<std::uint32_t>(settings.texels) + subs - 1) / subs * subs;
  const std::vector<ViewPoint> points =
      settings.view_importance ? view_points(view, settings.seed) : std::vector<ViewPoint>();

  RsmLights lights;
  std::vector<std::vector<std::uint32_t>> dealt(subs);
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const ReflectiveShadowMap& map = maps[m];
    const auto first = static_cast<std::uint32_t>(lights.rendered.size());
    lights.rendered.insert(lights.rendered.end(), map.texels.begin(), map.texels.end());
    const std::vector<std::uint32_t> order = morton_order(map.resolution);
    const auto salt = static_cast<uint>(m);
    const std::vector<Choice> chosen =
        settings.texels == 0 ? choose_all(map, order)
                             : draw(drawing_weights(map, points), order, count,
                                    make_random_stream(salt, kDrawSalt, settings.seed));

    // Deal each run of neighbours to all sub-maps: in order, or in one of its own
    std::vector<std::uint32_t> deal(subs);
    std::iota(deal.begin(), deal.end(), 0u);
    RandomStream random = make_random_stream(salt, kDealSalt, settings.seed);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (settings.shuffle && k % subs == 0) {
        for (std::uint32_t left = subs; left > 1; --left) {
          const auto other =
              static_cast<std::uint32_t>(next_uniform(random) * static_cast<float>(left));
          std::swap(deal[left - 1], deal[std::min(other, left - 1)]);
        }
      }
      const std::uint32_t place = first + chosen[k].texel;
      lights.rendered[place] =
          stand_for(map.texels[chosen[k].texel], chosen[k].share, subs, settings.softening);
      dealt[deal[k % subs]].push_back(place);
    }
  }

  // Sub-maps are asked in step: fill up those that got one less with a texel that brings nothing
  std::size_t longest = 0;
  for (const std::vector<std::uint32_t>& sub_map : dealt) {
    longest = std::max(longest, sub_map.size());
  }
  const auto dark = static_cast<std::uint32_t>(lights.rendered.size());
  lights.rendered.push_back({});
  lights.rendered.back().softening = 1.0f;
  for (std::vector<std::uint32_t>& sub_map : dealt) sub_map.resize(longest, dark);

  lights.starts.push_back(0);
  for (const std::vector<std::uint32_t>& sub_map : dealt) {
    lights.places.insert(lights.places.end(), sub_map.begin(), sub_map.end());
    lights.starts.push_back(static_cast<std::uint32_t>(lights.places.size()));
  }
  for (const std::uint32_t place : lights.places) {
    lights.restructured.push_back(lights.rendered[place]);
  }
  return lights;
}

}  // namespace lambent
