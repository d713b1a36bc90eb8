// SPDX-License-Identifier: Apache-2.0
// Coding of the bodies of keys and deltas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "stream/light/light_state.h"

namespace lambent::stream {

/// Writes the levels that an update adds to the coefficients, and applies them to the state.
/// `levels` has the layout of LightState::coefficients.
std::vector<std::byte> write_delta(const LightLayout& layout, std::span<const std::int32_t> levels,
                                   LightState& state);

/// Reads a delta into `levels`, and applies it to the state. Fails on data that no encoder wrote;
/// the state is then unchanged.
Expected<void> read_delta(const LightLayout& layout, std::span<const std::byte> body,
                          LightState& state, std::vector<std::int32_t>& levels);

/// Writes a state, without its update.
std::vector<std::byte> write_key(const LightLayout& layout, const LightState& state);

/// Reads a state. Fails on data that no encoder wrote.
Expected<LightState> read_key(const LightLayout& layout, std::span<const std::byte> body);

}  // namespace lambent::stream
