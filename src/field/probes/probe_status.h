// SPDX-License-Identifier: Apache-2.0
// What is known of a probe besides its tiles and its trace.
#pragma once

#include <cstdint>

namespace lambent {

/// What a probe is for. JCGT 10(2) 2021, sec. 5.
enum class ProbeState : std::uint8_t {
  off,             ///< Stands in solid matter: neither traced nor looked up.
  sleeping,        ///< Near no surface: traced once, for those who ask about open air.
  newly_awake,     ///< Something that moves came near since the last update.
  awake,           ///< Lights something that moves.
  newly_vigilant,  ///< Found to light static surfaces, not yet traced for it.
  vigilant,        ///< Lights static surfaces.
};

struct ProbeStatus {
  float samples = 0.0f;  ///< Updates of the settings' rays that its tiles average, >= 0.
  /// Relative variance of what one such update tells of its light, and the updates that this has
  /// been learned from.
  float noise = 1.0f;
  std::uint16_t noise_samples = 0;
  ProbeState state = ProbeState::newly_vigilant;
  std::uint32_t served = 0;  ///< Number of the update that traced it last, counted from 1; 0: none.
  std::uint64_t revision = 0;  ///< Of the world that its surfels are up to date with.
};

}  // namespace lambent
