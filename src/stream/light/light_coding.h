// SPDX-License-Identifier: Apache-2.0
// Bodies of keys and deltas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "stream/light/light_state.h"

namespace lambent::stream {

/// Writes what is added to the coefficients in an update, and brings the state to where that leads.
/// `levels` is as LightState::coefficients.
std::vector<std::byte> write_delta(const LightLayout& layout, std::span<const std::int32_t> levels,
                                   LightState& state);

/// Reads a delta, and brings the state to where it leads. Where it fails, since no encoder wrote
/// this, the state is as it was. `levels` is what was read.
Expected<void> read_delta(const LightLayout& layout, std::span<const std::byte> body,
                          LightState& state, std::vector<std::int32_t>& levels);

/// Writes a state, but for its update.
std::vector<std::byte> write_key(const LightLayout& layout, const LightState& state);

/// Reads a state. Fails on what no encoder wrote.
Expected<LightState> read_key(const LightLayout& layout, std::span<const std::byte> body);

}  // namespace lambent::stream
