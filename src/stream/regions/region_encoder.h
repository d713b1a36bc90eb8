// SPDX-License-Identifier: Apache-2.0
// Encodes the streams of regions from a stream of all light.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lambent/stream.h"
#include "stream/light/light_state.h"
#include "stream/regions/region_coding.h"
#include "stream/regions/region_cut.h"

namespace lambent::stream {

/// The stream that a client follows, for each region; empty before its first message.
using FollowedRegions = std::vector<RegionRate>;

class RegionEncoder {
 public:
  /// Takes the state of a decoder of all light. If an update was skipped, the streams of regions
  /// begin anew. Returns whether they do; all clients then need the whole state.
  bool follow(const LightDecoder& decoder);

  /// The update for a client at `client` that follows the streams `has`, which is updated. `all`:
  /// it joined late, has lost a message, or streams begin anew.
  LightMessage update_for(const LightDecoder& decoder, const Surroundings& client, bool all,
                          FollowedRegions& has);

 private:
  /// A region's stream of one rate. A stream that nobody follows is not coded until somebody does.
  struct Stream {
    LightState light;              ///< State after `light.update`; 0: nobody follows it.
    std::uint64_t asked = 0;       ///< The last update for which it was requested.
    std::vector<std::byte> delta;  ///< Leads from `from` to `light.update`.
    std::vector<std::byte> key;    ///< Key of `key_update`.
    std::uint64_t from = 0, key_update = 0;
  };
  Stream& stream(std::size_t region, RegionRate rate) {
    return streams_[2 * region + static_cast<std::size_t>(rate)];
  }
  void advance(std::size_t region, Stream& of, const LightState& whole);
  RegionStep key_of(std::size_t region, RegionRate rate, const LightState& whole);

  std::optional<RegionCut> cut_;
  std::uint64_t geometry_ = 0, geometries_ = 0, update_ = 0;
  float unit_ = 0.0f;
  std::vector<Stream> streams_;
};

}  // namespace lambent::stream
