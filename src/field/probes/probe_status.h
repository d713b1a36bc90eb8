// SPDX-License-Identifier: Apache-2.0
// The state and history of a probe.
#pragma once

#include <cstdint>

namespace lambent {

/// The classification of a probe. JCGT 10(2) 2021, sec. 5.
enum class ProbeState : std::uint8_t {
  off,             ///< Stands inside geometry: neither traced nor looked up.
  sleeping,        ///< Near no surface: traced in turns, for lookups in open air.
  newly_awake,     ///< A dynamic instance came near since the last update.
  awake,           ///< Lights a dynamic instance.
  newly_vigilant,  ///< Found to light static surfaces, but not yet traced since.
  vigilant,        ///< Lights static surfaces.
};

/// The state and history of a probe: all that is stored of it besides its tiles and surfels.
struct ProbeStatus {
  /// Number of updates with FieldSettings::rays_per_probe rays that its tiles average, >= 0.
  float samples = 0.0f;
  /// Relative variance of the light that an update with FieldSettings::rays_per_probe rays
  /// estimates, and the number of updates from which the variance was learned.
  float variance = 1.0f;
  std::uint16_t variance_samples = 0;
  ProbeState state = ProbeState::newly_vigilant;
  /// Number of the update that traced it last, counted from 1; 0: none.
  std::uint32_t last_traced = 0;
  std::uint64_t revision = 0;  ///< Revision of the world that its surfels are up to date with.
};

}  // namespace lambent
