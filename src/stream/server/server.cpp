// SPDX-License-Identifier: Apache-2.0
#include "stream/server/server.h"

#include <algorithm>
#include <utility>

namespace lambent::stream {

Server::Server(const ServedWorld& served, const ServerSettings& settings)
    : hub_(settings.max_clients, settings.max_picture_clients),
      loop_(served, settings.world, hub_) {}

Server::Server(const RelayedWorld& relayed, const ServerSettings& settings)
    : hub_(settings.max_clients, settings.max_picture_clients),
      upstream_(&relayed.light),
      loop_(relayed, settings.world, hub_, settings.listen.log) {
  upstream_->on_arrival([this] { hub_.wake(); });
}

Server::~Server() {
  if (upstream_ != nullptr) upstream_->on_arrival(nullptr);
}

Expected<std::unique_ptr<Server>> Server::open(const ServedWorld& served,
                                               const ServerSettings& settings) {
  return listening(std::unique_ptr<Server>(new Server(served, settings)), settings);
}

Expected<std::unique_ptr<Server>> Server::open(const RelayedWorld& relayed,
                                               const ServerSettings& settings) {
  return listening(std::unique_ptr<Server>(new Server(relayed, settings)), settings);
}

Expected<std::unique_ptr<Server>> Server::listening(std::unique_ptr<Server> server,
                                                    const ServerSettings& settings) {
  ListenSettings listen = settings.listen;
  // Reserve connections for plain requests when the number of clients is at its limit
  constexpr std::size_t kPlainConnections = 56;
  listen.max_connections =
      std::max(listen.max_connections, settings.max_clients + kPlainConnections);
  auto listener = Listener::open(listen, server->hub_);
  if (!listener) return tl::unexpected(listener.error());
  server->listener_ = std::move(*listener);
  if (!settings.publish.name.empty()) {
    auto publisher = BrokerPublisher::open(settings.publish, server->hub_, listen.log);
    if (!publisher) return tl::unexpected(publisher.error());
    server->publisher_ = std::move(*publisher);
  }
  return server;
}

Expected<void> Server::run(const std::function<bool()>& stop) {
  Expected<void> done = loop_.run(stop);
  publisher_.reset();
  listener_->drain();
  return done;
}

}  // namespace lambent::stream
