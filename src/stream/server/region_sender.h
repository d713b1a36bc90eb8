// SPDX-License-Identifier: Apache-2.0
// The clients that get light by regions, and the streams that each follows.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "stream/regions/region_encoder.h"
#include "stream/server/client_link.h"

namespace lambent::stream {

class RegionSender {
 public:
  /// Sets a client's surroundings; none: it gets all light.
  void set_surroundings(const ClientLink& client, const std::optional<Surroundings>& where);
  bool serves(const ClientLink& client) const { return clients_.contains(&client); }
  bool any() const { return !clients_.empty(); }
  /// Removes all clients except these.
  void keep(std::span<ClientLink* const> clients);

  /// Takes the next light, once for all clients.
  void follow(const LightDecoder& whole) { anew_ = regions_.follow(whole); }
  /// The message of that light for a client.
  LightMessage update_for(const LightDecoder& whole, const ClientLink& client, bool all);

 private:
  struct Served {
    Surroundings where;
    FollowedRegions has;
  };
  RegionEncoder regions_;
  bool anew_ = true;
  std::map<const ClientLink*, Served> clients_;
};

}  // namespace lambent::stream
