// SPDX-License-Identifier: Apache-2.0
// A server of light and pictures: the world's loop and who listens for clients.
#pragma once

#include <functional>
#include <memory>

#include "stream/broker/broker.h"
#include "stream/server/listener.h"
#include "stream/server/world_loop.h"

namespace lambent::stream {

struct ServerSettings {
  ListenSettings listen;
  WorldSettings world;
  std::size_t max_clients = 8;
  /// Of these, clients of pictures: each takes a renderer's memory (Renderer).
  std::size_t max_picture_clients = 8;
  BrokerAddress publish;  ///< Where light goes besides, as one of the clients; no name: nowhere.
};

class Server {
 public:
  /// Listens from now on; clients are answered once it runs. Fails as Listener::open does.
  static Expected<std::unique_ptr<Server>> open(const ServedWorld& served,
                                                const ServerSettings& settings);

  /// The same where another server computes the light.
  static Expected<std::unique_ptr<Server>> open(const RelayedWorld& relayed,
                                                const ServerSettings& settings);
  ~Server();

  std::string url() const { return listener_->url(); }
  std::uint16_t port() const { return listener_->port(); }
  HubStats stats() const { return hub_.stats(); }

  /// Serves until `stop` says so, asked some ten times a second or more; then tells clients, and
  /// returns when they have gone. Fails where the world cannot go on.
  Expected<void> run(const std::function<bool()>& stop);

 private:
  Server(const ServedWorld& served, const ServerSettings& settings);
  Server(const RelayedWorld& relayed, const ServerSettings& settings);
  static Expected<std::unique_ptr<Server>> listening(std::unique_ptr<Server> server,
                                                     const ServerSettings& settings);

  Hub hub_;
  Upstream* upstream_ = nullptr;  // that wakes the hub; null: none
  WorldLoop loop_;
  std::unique_ptr<Listener> listener_;
  std::unique_ptr<BrokerPublisher> publisher_;  // null: none
};

}  // namespace lambent::stream
