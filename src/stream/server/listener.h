// SPDX-License-Identifier: Apache-2.0
// Who speaks HTTP and WebSocket, with or without TLS, on a port: takes connections, checks who may
// do what, and hands messages to the hub. Nothing here knows of scenes.
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
  std::uint16_t port = 8080;       ///< 0: any that is free.
  std::string certificate, key;    ///< PEM files, both or none; none: no TLS.
  std::string tokens;              ///< See Access; empty: none, on loopback alone.
  /// Origins of other pages that may connect, as https://example.org.
  std::vector<std::string> origins;
  /// A .glb file that whoever may look gets as /scene.glb; null: none.
  std::shared_ptr<const std::string> scene;
  std::string record;  ///< A file that becomes the session (SessionWriter); empty: none.
  std::size_t max_connections = 64;  ///< Clients and plain requests at a time.
  double max_message_rate = 200.0;   ///< Messages of a client a second.
  /// Until a connection has said what it wants.
  std::chrono::milliseconds hello_timeout{10'000};
  /// Without a sign of life; half of it after, one is asked for.
  std::chrono::milliseconds idle_timeout{20'000};
  /// Until a message that is written has left.
  std::chrono::milliseconds write_timeout{10'000};
  /// Told what somebody who runs a server wants to know, a line each, from any thread.
  std::function<void(const std::string&)> log = [](const std::string&) {};
};

/// Serves from construction to destruction, on a thread of its own.
class Listener {
 public:
  /// Refers to the hub, which must outlive it. Fails on addresses that cannot be listened at, on
  /// files that cannot be read or do not go together, and without tokens off loopback.
  static Expected<std::unique_ptr<Listener>> open(const ListenSettings& settings, Hub& hub);
  /// Drains, if `drain` has not.
  virtual ~Listener() = default;

  virtual std::uint16_t port() const = 0;
  /// As a browser takes it.
  virtual std::string url() const = 0;
  /// Takes no more connections, tells those that there are that the server ends, and waits until
  /// they have gone, at most two seconds.
  virtual void drain() = 0;
};

}  // namespace lambent::stream
