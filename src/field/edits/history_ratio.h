// SPDX-License-Identifier: Apache-2.0
// By how much averaging over updates corrects what the last rays of a probe estimate alone.
#pragma once

#include <span>

#include "field/field_backend.h"
#include "field/probe_data.h"

namespace lambent {

/// The ratio of the light that some probes hold to what their last rays estimate, texel by texel.
WorkingIrradiance history_ratio_of(std::span<const int> probes, const ProbeData& data);
/// Stores what the last rays of some probes estimate, as a solve without history ratio found it.
void store_last_estimates(std::span<const int> probes, const WorkingIrradiance& solution,
                          ProbeData& data);
/// Computes coarse last estimates again, from the light as it is held.
void refine_last_estimates(std::span<const int> probes, FieldBackend& backend, ProbeData& data);

}  // namespace lambent
