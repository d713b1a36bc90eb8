// SPDX-License-Identifier: Apache-2.0
// A server of light and pictures: the world's loop and a listener for clients.
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
  /// Maximum number of these that request pictures; each takes a renderer's memory (Renderer).
  std::size_t max_picture_clients = 8;
  /// Broker to which light is published, too, as one of the clients; no name: none.
  BrokerAddress publish;
};

class Server {
 public:
  /// Starts to listen; clients are answered once `run` is called. Fails as Listener::open does.
  static Expected<std::unique_ptr<Server>> open(const ServedWorld& served,
                                                const ServerSettings& settings);

  /// A server whose light another server computes.
  static Expected<std::unique_ptr<Server>> open(const RelayedWorld& relayed,
                                                const ServerSettings& settings);
  ~Server();

  std::string url() const { return listener_->url(); }
  std::uint16_t port() const { return listener_->port(); }
  HubStats stats() const { return hub_.stats(); }

  /// Serves until `stop` returns true, which is called at least about ten times a second; then
  /// notifies clients, and returns when they have disconnected. Fails where the world cannot
  /// continue.
  Expected<void> run(const std::function<bool()>& stop);

 private:
  Server(const ServedWorld& served, const ServerSettings& settings);
  Server(const RelayedWorld& relayed, const ServerSettings& settings);
  static Expected<std::unique_ptr<Server>> listening(std::unique_ptr<Server> server,
                                                     const ServerSettings& settings);

  Hub hub_;
  Upstream* upstream_ = nullptr;  // wakes the hub; null: none
  WorldLoop loop_;
  std::unique_ptr<Listener> listener_;
  std::unique_ptr<BrokerPublisher> publisher_;  // null: none
};

}  // namespace lambent::stream
