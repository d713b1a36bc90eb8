// SPDX-License-Identifier: Apache-2.0
// How much memory a field takes, told before it is made.
#pragma once

#include <cstdint>

#include "lambent/field.h"

namespace lambent {

/// Of a field on the processor, once all of its probes have been traced: an upper bound, since
/// probes inside solid matter trace nothing.
struct FieldMemory {
  std::uint64_t probes = 0;
  std::uint64_t bytes_per_probe = 0;  ///< Whatever its rays: tiles, and the light being solved for.
  /// The part of these that every rank takes for each probe where ranks share the field.
  std::uint64_t bytes_per_probe_on_all = 0;
  std::uint64_t bytes_per_ray = 0;  ///< Of each probe: what it met, kept and in passing.

  std::uint64_t bytes(int rays_per_probe) const {
    return probes * (bytes_per_probe + bytes_per_ray * static_cast<std::uint64_t>(rays_per_probe));
  }
  /// What each of so many ranks takes that share the field.
  std::uint64_t bytes_of_rank(int rays_per_probe, int ranks) const {
    const std::uint64_t on_all = probes * bytes_per_probe_on_all;
    return on_all + (bytes(rays_per_probe) - on_all) / static_cast<std::uint64_t>(ranks);
  }
};

FieldMemory field_memory(const FieldSettings& settings, std::uint64_t probes);

/// The same of the probes that the settings ask for in a place of these bounds. Fails as
/// IrradianceField::make does.
Expected<FieldMemory> planned_memory(const FieldSettings& settings, const Bounds& scene_bounds);

}  // namespace lambent
