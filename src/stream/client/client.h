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
  std::string url;   ///< nats://HOST:PORT, with user and password if needed.
  std::string name;  ///< Name of the stream: letters, digits, - and _.
};

struct ConnectSettings {
  std::string host = "localhost";
  std::uint16_t port = 8080;
  bool tls = false;
  /// A PEM file of trusted certificate authorities, in addition to or in place of the system's;
  /// empty: the system's.
  std::string authority;
  BrokerAddress broker;                       ///< Used in place of a server; no name: none.
  std::string origin;                         ///< As browsers send it; empty: none.
  std::chrono::milliseconds timeout{10'000};  ///< For connecting, and for sending a message.
};

/// A connection. Not thread-safe. It makes progress only while one of its functions runs.
class Client {
 public:
  /// Connects, and sends `hello` if given. Fails where nobody answers, the certificate is not the
  /// host's, or the server refuses.
  static Expected<std::unique_ptr<Client>> connect(const ConnectSettings& settings,
                                                   const std::optional<Hello>& hello = {});
  virtual ~Client() = default;

  virtual Expected<void> send(const Message& message) = 0;
  /// Sends bytes that need not be a message, for tests of servers.
  virtual Expected<void> send_bytes(std::span<const std::byte> bytes, bool binary = true) = 0;
  /// The next message; none if none arrives in time. Fails once the connection has ended, and on
  /// messages that are not of the protocol.
  virtual Expected<std::optional<Message>> receive(std::chrono::milliseconds timeout) = 0;
  /// Makes the current or the next call of `receive` return at once. May be called from any thread.
  virtual void wake() = 0;
  /// Closes the WebSocket, and waits for the server to close it, too.
  virtual void close() = 0;
};

/// A client that a server has accepted, directly or through a broker, and the server's welcome.
/// Joining fails with Error::Kind::failed where it may succeed later: nobody answers, or the server
/// has as many clients as it may.
struct Joined {
  std::unique_ptr<Client> client;
  Welcome welcome;
};
Expected<Joined> join(const ConnectSettings& settings, const Hello& hello);

}  // namespace lambent::stream
