// SPDX-License-Identifier: Apache-2.0
#include "stream/server/hub.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace lambent::stream {

void Hub::set_welcome(const Welcome& welcome) {
  const std::lock_guard lock(mutex_);
  welcome_ = welcome;
}

Welcome Hub::welcome(Role role) const {
  const std::lock_guard lock(mutex_);
  Welcome told = welcome_;
  told.role = role;
  return told;
}

std::shared_ptr<ClientLink> Hub::join(const Hello& hello, Role role,
                                      std::function<void()> wake_connection) {
  auto client =
      std::make_shared<ClientLink>(hello, role, std::move(wake_connection), [this] { wake(); });
  const std::lock_guard lock(mutex_);
  const auto watching = static_cast<std::size_t>(std::count_if(
      clients_.begin(), clients_.end(), [](const auto& one) { return one->wants(kWantsPicture); }));
  const bool no_renderer = client->wants(kWantsPicture) && watching >= max_picture_clients_;
  if (no_renderer || clients_.size() >= max_clients_) return nullptr;
  clients_.push_back(client);
  ++membership_;
  ++stats_.joined;
  woken_ = true;
  rings_.notify_all();
  return client;
}

void Hub::leave(const std::shared_ptr<ClientLink>& client) {
  client->leave();
  const std::lock_guard lock(mutex_);
  std::erase(clients_, client);
  ++membership_;
}

std::vector<std::shared_ptr<ClientLink>> Hub::clients() const {
  const std::lock_guard lock(mutex_);
  return clients_;
}

std::uint64_t Hub::membership() const {
  const std::lock_guard lock(mutex_);
  return membership_;
}

void Hub::wake() {
  const std::lock_guard lock(mutex_);
  woken_ = true;
  rings_.notify_all();
}

void Hub::wait_until(Clock::time_point until) {
  std::unique_lock lock(mutex_);
  rings_.wait_until(lock, until, [this] { return woken_; });
  woken_ = false;
}

HubStats Hub::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

std::string Hub::stats_json() const {
  std::size_t waiting = 0;
  const auto connected = clients();
  for (const auto& client : connected) waiting += client->waiting_bytes();
  const HubStats now = stats();
  nlohmann::ordered_json json;
  json["clients"] = connected.size();
  json["clients_so_far"] = now.joined;
  json["state"] = now.state;
  json["update_ms"] = now.update_ms;
  json["updates_per_s"] = now.rate;
  if (!now.light_from) json["probes_stale"] = now.probes_stale;
  json["pictures"] = now.pictures;
  json["picture_ms"] = now.picture_ms;
  json["light_bytes"] = now.light_bytes;
  json["waiting_bytes"] = waiting;
  json["refused"] = now.refused;
  if (now.light_from) {
    json["light_server_connected"] = now.light_from->connected;
    json["light_server_connections"] = now.light_from->connections;
    json["light_server_lost_because"] = now.light_from->lost_because;
  }
  // Text from elsewhere may not be UTF-8
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace lambent::stream
