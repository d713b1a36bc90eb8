// SPDX-License-Identifier: Apache-2.0
// The body of a message of regions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lambent/error.h"

namespace lambent::stream {

/// Which stream of a region.
enum class RegionRate : std::uint8_t { near = 0, far = 1 };

/// One step of a region's stream, coded once for all clients that follow it.
struct RegionStep {
  std::uint32_t region = 0;
  RegionRate rate = RegionRate::near;
  bool is_key = false;
  /// Before the message's update: of a delta the update that it leads from; of a key its own.
  std::uint32_t age = 0;
  std::span<const std::byte> coded;
};

/// `whole`: keys of all regions, which need no light before.
std::vector<std::byte> write_regions(bool whole, std::span<const RegionStep> steps);

struct RegionBody {
  bool whole = false;
  std::vector<RegionStep> steps;
};
/// Refers to the body. Fails on what no encoder wrote; there are so many regions.
Expected<RegionBody> read_regions(std::span<const std::byte> body, std::size_t regions);

}  // namespace lambent::stream
