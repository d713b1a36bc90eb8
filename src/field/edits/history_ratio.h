// SPDX-License-Identifier: Apache-2.0
// The history ratio of a probe: the ratio of its light, which averages many updates, to the light
// that its last rays alone estimate.
#pragma once

#include <span>
#include <vector>

#include "field/edits/history_ratio_math.h"
#include "field/field_backend.h"
#include "field/probe_data.h"
#include "field/probes/tile_light.h"

namespace lambent {

/// The ratio of the light that some probes hold to the light that their last rays estimate, texel
/// by texel.
WorkingIrradiance history_ratio_of(std::span<const int> probes, const ProbeData& data);
/// Reduces the history ratios of some probes, which still hold the light before an edit, where it
/// made their direct light much brighter, given the light along the rays of each. Returns the
/// history_share() of each, where the mean probe is that of these.
std::vector<float> reduce_history_ratios(std::span<const int> probes, const ProbeData& data,
                                         std::span<const EditedLight> light,
                                         WorkingIrradiance& history_ratio);
/// Lowers the number of samples of a probe whose light an edit changed from `held` to `found`,
/// given the direct light along its rays and its history_share(). Returns the share of its average
/// that is kept.
float reduce_samples(TileLight held, TileLight found, const EditedLight& light, float history_share,
                     float& samples);
/// Stores the light that the last rays of some probes estimate: the solution of a solve without
/// history ratio.
void store_last_estimates(std::span<const int> probes, const WorkingIrradiance& solution,
                          ProbeData& data);
/// Computes those last estimates again that are coarse (ProbeData::last_estimate_is_coarse), from
/// the current light.
void refine_last_estimates(std::span<const int> probes, FieldBackend& backend, ProbeData& data);

}  // namespace lambent
