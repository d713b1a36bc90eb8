// SPDX-License-Identifier: Apache-2.0
// Coding of the body of a region message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lambent/error.h"

namespace lambent::stream {

/// The two streams of each region.
enum class RegionRate : std::uint8_t { near = 0, far = 1 };

/// One step of a region's stream, coded once for all clients that follow it.
struct RegionStep {
  std::uint32_t region = 0;
  RegionRate rate = RegionRate::near;
  bool is_key = false;
  /// The message's update less, for a delta, the update from which it leads; for a key, the key's
  /// own update.
  std::uint32_t age = 0;
  std::span<const std::byte> coded;
};

/// Writes a body. `whole`: the steps are keys of all regions, which need no earlier light.
std::vector<std::byte> write_regions(bool whole, std::span<const RegionStep> steps);

struct RegionBody {
  bool whole = false;
  std::vector<RegionStep> steps;
};
/// Reads a body, to which the result refers. `regions` is the number of regions. Fails on data that
/// no encoder wrote.
Expected<RegionBody> read_regions(std::span<const std::byte> body, std::size_t regions);

}  // namespace lambent::stream
