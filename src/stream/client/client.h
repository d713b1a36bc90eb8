// SPDX-License-Identifier: Apache-2.0
// A native client of a server of light and pictures.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "lambent/error.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// A stream of light at a broker.
struct BrokerAddress {
  std::string url;   ///< nats://HOST:PORT, with a user and password where it needs them.
  std::string name;  ///< Of the stream there, of letters, digits, - and _.
};

struct ConnectSettings {
  std::string host = "localhost";
  std::uint16_t port = 8080;
  bool tls = false;
  /// A PEM file of whom to trust besides, or in place of, the system's authorities; empty: these.
  std::string authority;
  BrokerAddress broker;                       ///< In place of a server; no name: none.
  std::string origin;                         ///< As browsers send it; empty: none.
  std::chrono::milliseconds timeout{10'000};  ///< To connect, and to send a message.
};

/// A connection. Not thread-safe. Nothing happens on it but while a function of it runs.
class Client {
 public:
  /// Connects, and says hello where there is one. Fails where nobody answers, the certificate is
  /// not the host's, or the server refuses.
  static Expected<std::unique_ptr<Client>> connect(const ConnectSettings& settings,
                                                   const std::optional<Hello>& hello = {});
  virtual ~Client() = default;

  virtual Expected<void> send(const Message& message) = 0;
  /// Sends bytes that need be no message, for tests of servers.
  virtual Expected<void> send_bytes(std::span<const std::byte> bytes, bool binary = true) = 0;
  /// The next message; none where none came in time. Fails once the connection has ended, and on
  /// messages that are not of the protocol.
  virtual Expected<std::optional<Message>> receive(std::chrono::milliseconds timeout) = 0;
  /// Has `receive` return at once, now or when it is called next. May be called from any thread.
  virtual void wake() = 0;
  /// Says farewell, and waits for the server's.
  virtual void close() = 0;
};

/// Connects and says hello, to a server or through a broker; the welcome, where the server takes
/// the client in.
struct Joined {
  std::unique_ptr<Client> client;
  Welcome welcome;
};
Expected<Joined> join(const ConnectSettings& settings, const Hello& hello);

}  // namespace lambent::stream
