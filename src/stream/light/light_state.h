// SPDX-License-Identifier: Apache-2.0
// The state of a light stream after an update, which is equal to the bit in encoder and decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stream/light/level_models.h"

namespace lambent::stream {

inline constexpr int kChannels = 3;

// Largest magnitude of a coefficient [units]: far more than any light needs, and far from an
// overflow.
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

// Range of units [(W/m^2)^(1/2)]: irradiance is below 1e18 W/m^2.
inline constexpr float kLeastUnit = 1e-15f, kMaxUnit = 1e9f;

/// Light, in integers.
struct LightState {
  std::uint64_t update = 0;  ///< 0: there is no light.
  /// A step of the coefficients [(W/m^2)^(1/2)], kLeastUnit to kMaxUnit.
  float unit = 1.0f;
  /// For each probe and channel, the coefficients of all functions (LightSignal).
  std::vector<std::int32_t> coefficients;
  std::vector<ProbeHistory> history;  ///< One per probe.
  LevelModels models;

  bool operator==(const LightState&) const = default;
};

/// The layout of a field's probes, for the coding of light.
struct LightLayout {
  static constexpr int kAxes = 3;

  int texels = 0;  ///< Texels of a tile.
  std::vector<std::uint8_t>
      lit;  ///< One per probe: 0 where it is in solid matter, and has no light.
  /// For each probe and axis, the preceding and the following probe in the memory order of its
  /// volume; -1: there is none.
  std::vector<std::array<std::int32_t, kAxes>> before, after;

  int probes() const { return static_cast<int>(lit.size()); }
  /// Number of a probe's coefficients, and of its levels.
  std::size_t numbers() const { return static_cast<std::size_t>(kChannels) * texels; }
  /// Adds a volume with `count` probes along its axes, all lit.
  void add_volume(const std::array<int, kAxes>& count);
};

/// Removes the light of probes that are not lit.
void clear_unlit(const LightLayout& layout, LightState& state);

}  // namespace lambent::stream
