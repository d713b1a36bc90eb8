// SPDX-License-Identifier: Apache-2.0
// Listens for HTTP and WebSocket, with or without TLS, on a port: accepts connections, checks
// access, and passes messages to the hub. Independent of scenes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "stream/server/hub.h"

namespace lambent::stream {

struct ListenSettings {
  std::string host = "127.0.0.1";  ///< An address or name of this machine.
  std::uint16_t port = 8080;       ///< 0: any free port.
  std::string certificate, key;    ///< PEM files, both or none; none: no TLS.
  std::string tokens;              ///< See Access; empty: none, only allowed on loopback.
  /// Origins of other pages that may connect, such as https://example.org.
  std::vector<std::string> origins;
  /// A .glb file that authorised clients get as /scene.glb; null: none.
  std::shared_ptr<const std::string> scene;
  std::string record;  ///< File to which the session is recorded (SessionWriter); empty: none.
  /// Clients and plain requests at a time. Where there are as many, a new connection takes the
  /// place of the one that has waited longest without a request or, as a WebSocket, without a
  /// Hello.
  std::size_t max_connections = 64;
  double max_message_rate = 200.0;  ///< Messages of a client per second.
  /// Time for a connection to send its request and Hello.
  std::chrono::milliseconds hello_timeout{10'000};
  /// Time without any message; after half of it, a ping is sent.
  std::chrono::milliseconds idle_timeout{20'000};
  /// Time for writing a message.
  std::chrono::milliseconds write_timeout{10'000};
  /// Called with lines of the log for the server's operator, from any thread.
  std::function<void(const std::string&)> log = [](const std::string&) {};
};

/// Serves from construction to destruction, on a thread of its own.
class Listener {
 public:
  /// Fails on certificates, keys, tokens and addresses that cannot be used now. Leaves nothing
  /// open.
  static Expected<void> check(const ListenSettings& settings);
  /// Refers to the hub, which must outlive it. Fails on addresses where it cannot listen, on files
  /// that cannot be read or do not match, and without tokens on addresses other than loopback.
  static Expected<std::unique_ptr<Listener>> open(const ListenSettings& settings, Hub& hub);
  /// Calls `drain` if it was not called.
  virtual ~Listener() = default;

  virtual std::uint16_t port() const = 0;
  /// The server's address for a browser.
  virtual std::string url() const = 0;
  /// Accepts no more connections, tells existing ones that the server ends, and waits until they
  /// have closed, at most two seconds.
  virtual void drain() = 0;
};

}  // namespace lambent::stream
