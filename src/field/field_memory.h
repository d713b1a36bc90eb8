// SPDX-License-Identifier: Apache-2.0
// Estimates how much memory a field takes, before it is made.
#pragma once

#include <cstdint>

#include "lambent/field.h"

namespace lambent {

/// The memory of a field on the processor once all of its probes have been traced. This is an upper
/// bound, since probes inside solid matter trace no rays.
struct FieldMemory {
  std::uint64_t probes = 0;
  /// Bytes that do not depend on the number of rays: tiles, and the light in a solve.
  std::uint64_t bytes_per_probe = 0;
  /// The part of `bytes_per_probe` that each rank takes for all probes where ranks share the field.
  std::uint64_t bytes_per_probe_on_all = 0;
  /// Bytes per ray of a probe: its surfel and lookup, and its hit during an update.
  std::uint64_t bytes_per_ray = 0;

  std::uint64_t bytes(int rays_per_probe) const {
    return probes * (bytes_per_probe + bytes_per_ray * static_cast<std::uint64_t>(rays_per_probe));
  }
  /// Bytes that each rank takes where this many ranks share the field.
  std::uint64_t bytes_of_rank(int rays_per_probe, int ranks) const {
    const std::uint64_t on_all = probes * bytes_per_probe_on_all;
    return on_all + (bytes(rays_per_probe) - on_all) / static_cast<std::uint64_t>(ranks);
  }
};

FieldMemory field_memory(const FieldSettings& settings, std::uint64_t probes);

/// The memory of the field that the settings request in a place of these bounds. Fails as
/// IrradianceField::make does.
Expected<FieldMemory> planned_memory(const FieldSettings& settings, const Bounds& scene_bounds);

}  // namespace lambent
