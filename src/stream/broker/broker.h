// SPDX-License-Identifier: Apache-2.0
// Light through a broker: a server publishes it once, and any number of clients subscribe.
// docs/protocol.md has the subjects and frames. In builds with LAMBENT_STREAM_NATS.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "stream/client/client.h"
#include "stream/server/hub.h"

namespace lambent::stream {

/// Whether this build supports brokers.
bool has_broker();

/// Whether an address is that of a broker: nats://HOST[:PORT]/NAME, or tls://.
bool is_broker_address(const std::string& text);
/// Parses a broker's address. Fails, naming `option`, where it is not one.
Expected<BrokerAddress> parse_broker_address(const std::string& option, const std::string& text);

/// Publishes the light of a hub's world, as one client of it, on a thread of its own.
class BrokerPublisher {
 public:
  /// Fails where the broker does not answer now, as `open` will.
  static Expected<void> check(const BrokerAddress& address);
  /// Refers to the hub, which must outlive it. `log` is called with later errors. Fails where the
  /// broker does not answer, the hub is full, or the build does not support brokers.
  static Expected<std::unique_ptr<BrokerPublisher>> open(
      const BrokerAddress& address, Hub& hub, std::function<void(const std::string&)> log);
  virtual ~BrokerPublisher() = default;
};

/// Joins the stream that a server publishes, as a client of light with Role::view. Fails where the
/// broker or the server does not answer.
Expected<Joined> join_through_broker(const ConnectSettings& settings, const Hello& hello);

}  // namespace lambent::stream
