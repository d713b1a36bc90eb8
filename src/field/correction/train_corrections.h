// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/probe_data.h"
#include "lambent/world.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// A surfel at which an update learns, unless it reflects nothing.
struct TrainedSurfel {
  int probe;
  int ray;
};

/// The surfels at which update `number` of these probes learns, in each run of training_stride()
/// one. Their places in the list pick their random numbers.
std::vector<TrainedSurfel> trained_surfels(const ProbeData& data, std::span<const int> probes,
                                           uint number);

/// How what the gathers of update `number` meet is shaded.
ShadeHitsSettings training_shading(const FieldSettings& settings, uint number);

/// Learns how far the field's lookups are off: gathers irradiance at a share of the surfels of
/// `probes`, and at points that these gathers meet, and compares it with what lookups find there
/// without corrections. The field holds the light of the update before update `number`, whose
/// surfels are known already. `by` says how lookups see probes, with corrections. Where ranks share
/// the field, each gathers at its own surfels, and all learn from all. Returns the number of rays
/// that this one traced.
std::uint64_t train_corrections(const World& world, std::span<const int> probes,
                                const VisibilityRays& by, uint number, ProbeData& data);

}  // namespace lambent
