// SPDX-License-Identifier: Apache-2.0
#include "rsm/direct_lights.h"

#include <algorithm>
#include <numeric>

#include "shared/random.h"

namespace lambent {
namespace {

// Makes these random numbers independent of others.
constexpr uint kLightSalt = 0x4c494748u;

/// The numbers 0 to count - 1 in random order.
std::vector<std::uint32_t> shuffled(std::size_t count, std::uint32_t index, std::uint32_t seed) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  RandomStream random = make_random_stream(index, kLightSalt, seed);
  for (std::size_t left = count; left > 1; --left) {
    const auto other = static_cast<std::size_t>(next_uniform(random) * static_cast<float>(left));
    std::swap(order[left - 1], order[std::min(other, left - 1)]);
  }
  return order;
}

}  // namespace

DealtLights deal_direct_lights(std::size_t lights, const RsmSettings& settings) {
  const auto subs = static_cast<std::size_t>(settings.sub_maps) * settings.sub_maps;
  const auto wanted = static_cast<std::size_t>(settings.direct_lights);
  DealtLights result;
  result.lights = lights;
  result.per_sub_map =
      wanted == 0 ? lights : std::min(lights, std::max(wanted, (lights + subs - 1) / subs));

  // Deal round after round of all lights: numbers of sub-maps that test a light differ by at most 1
  std::vector<std::uint32_t> asked(lights, 0);
  const std::vector<std::uint32_t> order = shuffled(lights, 0, settings.seed);
  const std::vector<std::uint32_t> turn = shuffled(subs, 1, settings.seed);
  for (std::size_t s = 0; s < subs; ++s) {
    for (std::size_t k = 0; k < result.per_sub_map; ++k) {
      const std::uint32_t light = order[(turn[s] * result.per_sub_map + k) % lights];
      result.dealt.push_back({light, 0.0f});
      ++asked[light];
    }
    std::sort(result.dealt.end() - static_cast<std::ptrdiff_t>(result.per_sub_map),
              result.dealt.end(),
              [](const AssignedLight& a, const AssignedLight& b) { return a.light < b.light; });
  }
  for (AssignedLight& dealt : result.dealt) {
    dealt.weight = static_cast<float>(subs) / static_cast<float>(asked[dealt.light]);
  }
  return result;
}

int share_period(const DealtLights& lights, const RsmSettings& settings) {
  return lights.shared() && settings.final_blur ? settings.sub_images : 1;
}

}  // namespace lambent
