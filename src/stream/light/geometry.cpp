// SPDX-License-Identifier: Apache-2.0
#include "stream/light/geometry.h"

#include <algorithm>
#include <cmath>

namespace lambent::stream {
CodedMoments encode_moments(const glm::vec2& moments, float longest) {
  if (!(moments.x > 0.0f)) return {};
  const float mean = moments.x / longest;
  const float variance = std::max(moments.y - moments.x * moments.x, 0.0f);
  const float deviation = std::sqrt(variance) / (kMaxDeviationShare * longest);
  const auto code = [](float share, int least, int most) {
    const float steps = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(most);
    return static_cast<std::uint8_t>(std::max(static_cast<int>(steps + 0.5f), least));
  };
  // A mean of 0 represents an unknown distance
  return {code(mean, 1, CodedMoments::kMaxMean),
          code(std::sqrt(deviation), 0, CodedMoments::kMaxDeviation)};
}

glm::vec2 decode_moments(const CodedMoments& moments, float longest) {
  const float mean = decode_mean(moments, longest);
  const float deviation = decode_deviation(moments, longest);
  return {mean, mean * mean + deviation * deviation};
}

const ProbeGrid& FieldGeometry::grid_of(int probe) const {
  std::size_t volume = volumes.size() - 1;
  while (probe < volumes[volume].grid.first) --volume;
  return volumes[volume].grid;
}

bool FieldGeometry::same_kind(const FieldGeometry& other) const {
  const auto same_volume = [](const Volume& a, const Volume& b) {
    return a.grid.count == b.grid.count && a.role.follows_viewer == b.role.follows_viewer &&
           a.role.level == b.role.level && a.grid.spacing == b.grid.spacing &&
           a.grid.axes == b.grid.axes;
  };
  return irradiance_texels == other.irradiance_texels && distance_texels == other.distance_texels &&
         volumes.size() == other.volumes.size() &&
         std::equal(volumes.begin(), volumes.end(), other.volumes.begin(), same_volume);
}

bool same_place(const ProbeGrid& a, const ProbeGrid& b) {
  return a.origin_ws == b.origin_ws && a.scroll == b.scroll && a.fade_centre == b.fade_centre &&
         a.fade_half == b.fade_half && a.fade_cells == b.fade_cells;
}

LightLayout layout_of(const FieldGeometry& geometry) {
  LightLayout layout;
  layout.texels = geometry.irradiance_texels * geometry.irradiance_texels;
  for (const Volume& volume : geometry.volumes) {
    layout.add_volume({volume.grid.count.x, volume.grid.count.y, volume.grid.count.z});
  }
  std::transform(geometry.states.begin(), geometry.states.end(), layout.lit.begin(),
                 [](ProbeState state) -> std::uint8_t { return state == ProbeState::off ? 0 : 1; });
  return layout;
}

}  // namespace lambent::stream
