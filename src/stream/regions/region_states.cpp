// SPDX-License-Identifier: Apache-2.0
#include "stream/regions/region_states.h"

#include <algorithm>
#include <string>
#include <utility>

#include "stream/light/light_coding.h"
#include "stream/light/message.h"

namespace lambent::stream {

void RegionStates::follow(const LightLayout& layout) {
  cut_.follow(layout);
  for (std::size_t r = 0; r < states_.size(); ++r) {
    if (!states_[r].light.coefficients.empty()) {
      clear_unlit(cut_.regions()[r].layout, states_[r].light);
    }
  }
}

Expected<void> RegionStates::take_step(const RegionStep& step, std::uint64_t update) {
  const LightLayout& layout = cut_.regions()[step.region].layout;
  Followed& here = states_[step.region];
  if (step.age >= update) return bad_stream("region", "is older than its stream");
  if (step.is_key) {
    auto key = read_key(layout, step.coded);
    if (!key) return tl::unexpected(key.error());
    here = {step.rate, std::move(*key)};
    here.light.update = update - step.age;
    return {};
  }
  if (here.light.update == 0 || here.rate != step.rate || here.light.update != update - step.age) {
    return bad_stream("region", "follows on something that was lost");
  }
  if (const auto read = read_delta(layout, step.coded, here.light, levels_); !read) return read;
  here.light.update = update;
  return {};
}

Expected<void> RegionStates::take(const RegionBody& body, std::uint64_t update,
                                  std::vector<std::int32_t>& coefficients,
                                  std::vector<int>& changed) {
  for (const RegionStep& step : body.steps) {
    if (const auto taken = take_step(step, update); !taken) return taken;
    if (states_[step.region].light.unit != states_[body.steps.front().region].light.unit) {
      return bad_stream("region", "has another unit than others");
    }
  }
  changed.clear();
  for (const RegionStep& step : body.steps) {
    const Region& region = cut_.regions()[step.region];
    const std::size_t numbers = region.layout.numbers();
    const std::vector<std::int32_t>& now = states_[step.region].light.coefficients;
    for (std::size_t i = 0; i < region.probes.size(); ++i) {
      const auto from = now.begin() + static_cast<std::ptrdiff_t>(i * numbers);
      const auto to =
          coefficients.begin() + static_cast<std::ptrdiff_t>(region.probes[i] * numbers);
      if (std::equal(from, from + static_cast<std::ptrdiff_t>(numbers), to)) continue;
      std::copy_n(from, numbers, to);
      changed.push_back(region.probes[i]);
    }
  }
  std::sort(changed.begin(), changed.end());
  return {};
}

}  // namespace lambent::stream
