// SPDX-License-Identifier: Apache-2.0
// Invalidation: which probe rays and surfels an edit of the world affects.
//
// An edit names the boxes in which geometry was and is, the lights as they were and are, and the
// materials that differ. Only rays and surfels that these can affect are traced and shaded again.
// They use the same ray directions and random numbers as before, so that whatever the edit does not
// affect keeps its exact bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"
#include "lambent/world.h"

namespace lambent {

/// The luminance of the direct and sky light that each probe's rays bring back, summed over them.
std::vector<double> direct_light_of(std::span<const ProbeTrace> traces,
                                    std::span<const int> probes);

/// What bringing probes up to date took and changed.
struct InvalidationResult {
  std::uint64_t probe_rays = 0;   ///< Probe rays traced again.
  std::uint64_t shadow_rays = 0;  ///< Shadow and visibility rays traced.
  std::vector<int>
      moved;  ///< Probes whose rays now have other distances, in the order of `probes`.
  std::vector<PassTime> passes;  ///< What a device took for each pass; none on the processor.
};

/// Brings the surfels and stored distances of `probes`, which have been traced, up to date with the
/// world. `changes` name everything that may differ from the world in which the surfels were found;
/// naming more does no harm. Where the distances of a probe changed, the lookups of those surfels
/// of `all` traced probes that read it are found again.
InvalidationResult invalidate_surfels(const World& world, const SolidSides& solid_sides,
                                      std::span<const WorldChanges> changes,
                                      const FieldSettings& settings, std::span<const int> probes,
                                      std::span<const int> all, const VisibilityRays& by,
                                      ProbeStore& store, std::span<ProbeTrace> traces,
                                      uint dither_seed);

}  // namespace lambent
