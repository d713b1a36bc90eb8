// SPDX-License-Identifier: Apache-2.0
// Invalidation: which probe rays and surfels an edit of the world affects.
//
// An edit lists the boxes that contain changed geometry before and after it, the changed lights
// before and after it, and the materials that differ. Only rays and surfels that these can affect
// are traced and shaded again. They use the same ray directions and random numbers as before, so
// that everything that the edit does not affect keeps its exact bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/edits/edited_light_math.h"
#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"
#include "lambent/world.h"

namespace lambent {

/// Luminance of the direct or sky light that a probe receives along a surfel's ray.
inline float ray_light(const Surfel& surfel) {
  return ray_light(static_cast<uint>(surfel.kind), surfel.albedo_over_pi, surfel.light);
}

/// The rays and times that bringing probes up to date took, and the probes that it changed.
struct InvalidationResult {
  std::uint64_t probe_rays = 0;   ///< Probe rays traced again.
  std::uint64_t shadow_rays = 0;  ///< Shadow and visibility rays traced.
  std::vector<int>
      moved;  ///< Probes whose rays now have other distances, in the order of `probes`.
  /// Direct light along each probe's rays before and after, in the order of `probes`.
  std::vector<EditedLight> light;
  std::vector<PassTime> passes;  ///< A device's time for each pass; empty on the processor.
};

/// Brings the surfels and stored distances of `probes`, which have been traced, up to date with the
/// world. `changes` list everything that may differ from the world in which the surfels were found;
/// listing more does no harm. Where the distances of a probe changed, the lookups of those surfels
/// of `all` traced probes that read it are recomputed.
InvalidationResult invalidate_surfels(const World& world, const SolidSides& solid_sides,
                                      std::span<const WorldChanges> changes,
                                      const FieldSettings& settings, std::span<const int> probes,
                                      std::span<const int> all, const VisibilityRays& by,
                                      ProbeStore& store, std::span<ProbeTrace> traces,
                                      uint dither_seed);

}  // namespace lambent
