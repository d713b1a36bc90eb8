// SPDX-License-Identifier: Apache-2.0
// What an edit of the world does to probes: which rays now meet something else, which surfels see
// another light, and which probes see those surfels.
//
// An edit names boxes in which geometry stood or stands, lights as they were and are, and
// materials. Only what these can reach is looked at again, with the very rays and random numbers
// that found it, so that what the edit does not touch keeps its bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"
#include "lambent/world.h"

namespace lambent {

struct InvalidationResult {
  std::uint64_t probe_rays = 0;   ///< Traced again.
  std::uint64_t shadow_rays = 0;  ///< Likewise.
  std::vector<int> moved;         ///< Probes that see other distances, in the order asked for.
};

/// Brings the surfels of `probes`, which have been traced, and their stored distances up to date
/// with the world. `changes` tell what may differ from the world that the surfels were found in;
/// more than that does no harm. Lookups of `all` traced probes' surfels follow where the distances
/// of a probe that they read changed.
InvalidationResult invalidate_surfels(const World& world, std::span<const WorldChanges> changes,
                                      const FieldSettings& settings, std::span<const int> probes,
                                      std::span<const int> all, const VisibilityRays& by,
                                      ProbeStore& store, std::span<ProbeTrace> traces,
                                      uint dither_seed);

}  // namespace lambent
