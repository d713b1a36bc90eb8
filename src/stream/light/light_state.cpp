// SPDX-License-Identifier: Apache-2.0
#include "stream/light/light_state.h"

#include <algorithm>

namespace lambent::stream {
void LightLayout::add_volume(const std::array<int, kAxes>& count) {
  const auto first = static_cast<std::int32_t>(lit.size());
  const std::array<std::int32_t, kAxes> step = {1, count[0], count[0] * count[1]};
  const std::size_t last = lit.size() + static_cast<std::size_t>(step[2]) * count[2];
  lit.resize(last, 1);
  before.reserve(last);
  after.reserve(last);
  for (std::int32_t probe = first; before.size() < last; ++probe) {
    std::array<std::int32_t, kAxes> low{}, high{};
    for (int axis = 0; axis < kAxes; ++axis) {
      const int coordinate = (probe - first) / step[axis] % count[axis];
      low[axis] = coordinate > 0 ? probe - step[axis] : -1;
      high[axis] = coordinate + 1 < count[axis] ? probe + step[axis] : -1;
    }
    before.push_back(low);
    after.push_back(high);
  }
}

void clear_unlit(const LightLayout& layout, LightState& state) {
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] != 0) continue;
    std::fill_n(state.coefficients.begin() + probe * layout.numbers(), layout.numbers(), 0);
    state.history[probe] = ProbeHistory{};
  }
}

}  // namespace lambent::stream
