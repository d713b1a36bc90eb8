// SPDX-License-Identifier: Apache-2.0
// The state of a light stream: what encoder and decoder have after an update, equal to the bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stream/light/level_models.h"

namespace lambent::stream {

inline constexpr int kChannels = 3;

// A coefficient is within so many units of 0: far more than any light is, and far from an overflow.
inline constexpr std::int32_t kMaxCoefficient = 1 << 28;

// Units [(W/m^2)^(1/2)] beyond these are of no light: irradiance is below 1e18 W/m^2.
inline constexpr float kLeastUnit = 1e-15f, kMaxUnit = 1e9f;

/// Light, in integers.
struct LightState {
  std::uint64_t update = 0;  ///< 0: there is no light.
  /// A step of the coefficients [(W/m^2)^(1/2)], kLeastUnit to kMaxUnit.
  float unit = 1.0f;
  /// Of a probe's channels, one after the other, and their functions (LightSignal).
  std::vector<std::int32_t> coefficients;
  std::vector<ProbeHistory> history;  ///< A probe each.
  LevelModels models;

  bool operator==(const LightState&) const = default;
};

/// The probes of a field as the coding of light sees them.
struct LightLayout {
  static constexpr int kAxes = 3;

  int texels = 0;  ///< Of a tile.
  std::vector<std::uint8_t>
      lit;  ///< A probe each: 0 where it is in solid matter, and has no light.
  /// Of each probe the one before it along each axis of its volume in memory, and the one after it;
  /// -1: there is none.
  std::vector<std::array<std::int32_t, kAxes>> before, after;

  int probes() const { return static_cast<int>(lit.size()); }
  /// The numbers of a probe in coefficients and levels.
  std::size_t numbers() const { return static_cast<std::size_t>(kChannels) * texels; }
  /// Adds a volume of so many probes along its axes, all lit.
  void add_volume(const std::array<int, kAxes>& count);
};

/// Removes the light of probes that are not lit.
void clear_unlit(const LightLayout& layout, LightState& state);

}  // namespace lambent::stream
