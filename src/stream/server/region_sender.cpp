// SPDX-License-Identifier: Apache-2.0
#include "stream/server/region_sender.h"

#include <algorithm>

namespace lambent::stream {

void RegionSender::set_surroundings(const ClientLink& client,
                                    const std::optional<Surroundings>& where) {
  if (where) {
    clients_[&client].where = *where;
  } else {
    clients_.erase(&client);
  }
}

void RegionSender::keep(std::span<ClientLink* const> clients) {
  std::erase_if(clients_, [clients](const auto& served) {
    return std::find(clients.begin(), clients.end(), served.first) == clients.end();
  });
}

LightMessage RegionSender::update_for(const LightDecoder& whole, const ClientLink& client,
                                      bool all) {
  Served& served = clients_.at(&client);
  return regions_.update_for(whole, served.where, all || anew_, served.has);
}

}  // namespace lambent::stream
