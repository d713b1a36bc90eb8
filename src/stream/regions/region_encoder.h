// SPDX-License-Identifier: Apache-2.0
// The streams of regions, made of a stream of light that is whole.
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

/// What a client follows of each region; empty before it got anything.
using FollowedRegions = std::vector<RegionRate>;

class RegionEncoder {
 public:
  /// Takes what a decoder of the whole stream has come to: each update, in order, or the streams of
  /// regions begin anew. Whether they do: then all clients need all.
  bool follow(const LightDecoder& decoder);

  /// The update as a client needs it that follows `has` and stands there, and what it follows then.
  /// `all`: it has come late, has lost something, or streams begin anew.
  LightMessage update_for(const LightDecoder& decoder, const Surroundings& client, bool all,
                          FollowedRegions& has);

 private:
  /// A region's stream of one rate. What nobody follows is coded again once somebody does.
  struct Stream {
    LightState light;              ///< Of `light.update`; 0: nobody has followed it.
    std::uint64_t asked = 0;       ///< The last update for which somebody asked.
    std::vector<std::byte> delta;  ///< To `light.update`, from `from`.
    std::vector<std::byte> key;    ///< Of `key_update`.
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
