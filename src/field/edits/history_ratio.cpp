// SPDX-License-Identifier: Apache-2.0
// The ratio of the averaged light of probes to the light that their last rays alone estimate. Edits
// preserve this ratio (apply_scene_edits.cpp), and with it the noise reduction of averaging.
#include "field/edits/history_ratio.h"

#include <algorithm>

namespace lambent {
/// Computes the ratio of each texel's averaged light to the probe's last estimate.
WorkingIrradiance history_ratio_of(std::span<const int> probes, const ProbeData& data) {
  const int texels = data.tile_texels();
  WorkingIrradiance history_ratio = light_of(data.light, probes, texels);
  const WorkingIrradiance estimate = light_of(data.last_irradiance_estimate, probes, texels);
  for (std::size_t i = 0; i < history_ratio.size(); ++i)
    history_ratio[i] = history_ratio_between(estimate[i], history_ratio[i]);
  return history_ratio;
}

std::vector<float> reduce_history_ratios(std::span<const int> probes, const ProbeData& data,
                                         std::span<const EditedLight> light,
                                         WorkingIrradiance& history_ratio) {
  if (probes.empty()) return {};
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  std::vector<ProbeAtEdit> found;
  double held = 0.0, before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const TileLight tile(&data.light[probes[k] * texels], texels);
    found.push_back(probe_at_edit(light[k], mean_luminance(tile)));
    held += found[k].held;
    before += found[k].direct_before;
    after += found[k].direct_after;
  }
  const auto count = static_cast<double>(probes.size());
  const ProbeAtEdit mean = {static_cast<float>(held / count), static_cast<float>(before / count),
                            static_cast<float>(after / count)};
  std::vector<float> shares(probes.size());
  for (std::size_t k = 0; k < probes.size(); ++k) {
    shares[k] = history_share(found[k], mean);
    for (std::size_t t = 0; t < texels; ++t) {
      vec4& ratio = history_ratio[k * texels + t];
      ratio = reduce_history_ratio(ratio, shares[k]);
    }
  }
  return shares;
}

float reduce_samples(TileLight held, TileLight found, const EditedLight& light, float history_share,
                     float& samples) {
  const EstimateVariance variance =
      estimate_variance(light, mean_luminance(held), mean_luminance(found));
  if (relative_square(held, found) < kChangedFraction * kChangedFraction) {
    // Several changes too small to be visible add up, and so does their noise
    samples = samples_after_ratio(samples, variance);
    return 1.0f;
  }
  // The more the distribution of the light changed, the fewer samples the average counts as
  const float kept = likeness(found, held) * history_share;
  samples = samples_after_edit(samples, variance, kept);
  return kept;
}

/// Stores the solution of a solve without history ratio as the probes' last estimates.
void store_last_estimates(std::span<const int> probes, const WorkingIrradiance& solution,
                          ProbeData& data) {
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  for (std::size_t k = 0; k < probes.size(); ++k) {
    std::copy_n(&solution[k * texels], texels, &data.last_irradiance_estimate[probes[k] * texels]);
    data.last_estimate_is_coarse[probes[k]] = 1;
  }
}

/// Computes the last estimates of those probes again that were traced since the last edit, from the
/// current light of all probes. In dark places, the error of the solve that these estimates come
/// from is larger than the smallest visible change by an edit. Other probes keep their estimates:
/// otherwise a sequence of changes, each too small to be visible, would be lost.
void refine_last_estimates(std::span<const int> probes, FieldBackend& backend, ProbeData& data) {
  std::vector<int> rough;
  for (const int probe : probes) {
    if (data.last_estimate_is_coarse[probe] != 0) rough.push_back(probe);
  }
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  WorkingIrradiance exact = light_of(data.last_irradiance_estimate, rough, data.tile_texels());
  backend.receive(rough, exact);
  for (std::size_t k = 0; k < rough.size(); ++k) {
    std::copy_n(&exact[k * texels], texels, &data.last_irradiance_estimate[rough[k] * texels]);
    data.last_estimate_is_coarse[rough[k]] = 0;
  }
}

}  // namespace lambent
