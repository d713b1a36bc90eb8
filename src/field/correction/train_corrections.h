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
struct TrainingSurfel {
  int probe;
  int ray;
};

/// The surfels of these probes at which update `number` learns: one of every training_stride()
/// consecutive surfels. Their places in the list seed their random numbers.
std::vector<TrainingSurfel> training_surfels(const ProbeData& data, std::span<const int> probes,
                                             uint number);

/// The settings with which the hits of the gathers of update `number` are shaded.
ShadeHitsSettings training_shading(const FieldSettings& settings, uint number);

/// Learns corrections of the field's lookups: gathers irradiance at a share of the surfels of
/// `probes`, and at hits of these gathers, and compares it with the irradiance of lookups without
/// corrections. The surfels are those of update `number`, and the field holds the light of the
/// update before it. `by` has the visibility and the corrections with which the gathers look the
/// field up. Where ranks share the field, each gathers at its own surfels, and all learn from all
/// samples. Returns the number of rays that this rank traced.
std::uint64_t train_corrections(const World& world, std::span<const int> probes,
                                const VisibilityRays& by, uint number, ProbeData& data);

}  // namespace lambent
