// SPDX-License-Identifier: Apache-2.0
// The state that all connections share. Included only by files that use Boost.Beast.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "stream/server/access.h"
#include "stream/server/hub.h"
#include "stream/server/listener.h"
#include "stream/session/session_file.h"

namespace lambent::stream {

/// The listener's interface to a connection.
class OpenConnection {
 public:
  virtual ~OpenConnection() = default;
  /// Sends the reason to the client where it can be told, and closes.
  virtual void refuse(Refusal refusal) = 0;
  /// Closes the connection at once if it has not asked for anything yet; returns whether it did.
  virtual bool give_way() = 0;
  /// Checks deadlines, and whether the token is still valid.
  virtual void tick() = 0;
};

/// Used only by the listener's thread.
struct ConnectionContext {
  ConnectionContext(const ListenSettings& listen, Hub& shared, Access who)
      : settings(listen),
        hub(shared),
        access(std::move(who)),
        hosts(is_loopback(listen.host), listen.origins) {}

  ListenSettings settings;
  Hub& hub;
  Access access;
  HostCheck hosts;
  std::unique_ptr<boost::asio::ssl::context> tls;  // null: none
  std::optional<SessionWriter> session;
  std::chrono::steady_clock::time_point session_start = std::chrono::steady_clock::now();
  std::uint32_t session_clients = 0;  // number of clients so far
  std::size_t connections = 0;
  // In the order in which they came, a WebSocket from its handshake on
  std::vector<std::weak_ptr<OpenConnection>> open_connections;
  boost::asio::io_context io{1};  // last: its connections must be destroyed before everything else

  /// Records a message of a client if a session is recorded; none: the client has left.
  void record(std::uint32_t client, std::optional<Message> message) {
    if (!session) return;
    const auto since = std::chrono::duration_cast<std::chrono::microseconds>(
        std::chrono::steady_clock::now() - session_start);
    const auto added = session->add({since, client, std::move(message)});
    if (added) return;
    settings.log("the session is recorded no longer: " + added.error().message());
    session.reset();
  }

  void count_refused() {
    hub.edit_stats([](HubStats& stats) { ++stats.refused; });
  }
};

/// Counts a connection while it exists.
class ConnectionCount {
 public:
  explicit ConnectionCount(ConnectionContext& context) : context_(&context) {
    ++context.connections;
  }
  ConnectionCount(ConnectionCount&& from) noexcept
      : context_(std::exchange(from.context_, nullptr)) {}
  ConnectionCount& operator=(ConnectionCount&&) = delete;
  ~ConnectionCount() {
    if (context_ != nullptr) --context_->connections;
  }

 private:
  ConnectionContext* context_;
};

inline std::int64_t unix_time_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace lambent::stream
