// SPDX-License-Identifier: Apache-2.0
// What the last rays of probes told of the light on their own, and by how much their averages know
// better: the gain that following an edit keeps (update_edits.cpp).
#include <algorithm>

#include "field/field_state.h"
#include "field/probes/tile_light.h"

namespace lambent {
namespace {

// What one update's rays tell of a probe is not off by more than this factor, or they met nothing
// worth correcting.
constexpr float kMaxHistoryRatio = 2.0f;

/// What `told` must be multiplied by to give `held`, within bounds.
vec4 history_ratio_between(const vec4& last_irradiance_estimate, const vec4& held) {
  vec4 history_ratio(1.0f);
  for (int c = 0; c < 3; ++c) {
    if (last_irradiance_estimate[c] > kTiniestLight)
      history_ratio[c] =
          clamp(held[c] / last_irradiance_estimate[c], 1.0f / kMaxHistoryRatio, kMaxHistoryRatio);
  }
  return history_ratio;
}

}  // namespace

/// By how much averaging corrects what the probes' last rays told.
WorkingIrradiance IrradianceField::State::history_ratio_of(std::span<const int> probes) const {
  const int texels = tile_texels();
  WorkingIrradiance history_ratio = light_of(light, probes, texels);
  const WorkingIrradiance estimate = light_of(last_irradiance_estimate, probes, texels);
  for (std::size_t i = 0; i < history_ratio.size(); ++i)
    history_ratio[i] = history_ratio_between(estimate[i], history_ratio[i]);
  return history_ratio;
}

/// Remembers what the probes' rays told when their light was solved for without a gain.
void IrradianceField::State::store_last_estimates(std::span<const int> probes,
                                                  const WorkingIrradiance& solution) {
  const auto texels = static_cast<std::size_t>(tile_texels());
  for (std::size_t k = 0; k < probes.size(); ++k) {
    std::copy_n(&solution[k * texels], texels, &last_irradiance_estimate[probes[k] * texels]);
    last_estimate_is_coarse[probes[k]] = 1;
  }
}

/// Computes what the rays of probes traced since the last edit tell of the light as it is held:
/// where it is dark, the solution's error is more than what edits are held to touch. Others keep
/// what they told, lest changes too small to be seen be lost.
void IrradianceField::State::refine_last_estimates(std::span<const int> probes) {
  std::vector<int> rough;
  for (const int probe : probes) {
    if (last_estimate_is_coarse[probe] != 0) rough.push_back(probe);
  }
  const auto texels = static_cast<std::size_t>(tile_texels());
  WorkingIrradiance exact = light_of(last_irradiance_estimate, rough, tile_texels());
  if (device) {
    device->receive(rough, exact, exact);
  } else {
    transport(rough).apply(light, exact, exact);
  }
  for (std::size_t k = 0; k < rough.size(); ++k) {
    std::copy_n(&exact[k * texels], texels, &last_irradiance_estimate[rough[k] * texels]);
    last_estimate_is_coarse[rough[k]] = 0;
  }
}

}  // namespace lambent
