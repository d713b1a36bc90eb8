// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nats/nats.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "stream/client/client.h"

namespace lambent::stream {

struct NatsDeleter {
  void operator()(natsConnection* one) const { natsConnection_Destroy(one); }
  void operator()(natsSubscription* one) const { natsSubscription_Destroy(one); }
  void operator()(natsOptions* one) const { natsOptions_Destroy(one); }
  void operator()(natsMsg* one) const { natsMsg_Destroy(one); }
};
using NatsMessage = std::unique_ptr<natsMsg, NatsDeleter>;
using NatsSubscription = std::unique_ptr<natsSubscription, NatsDeleter>;

inline std::span<const std::byte> bytes_of(const NatsMessage& message) {
  return {reinterpret_cast<const std::byte*>(natsMsg_GetData(message.get())),
          static_cast<std::size_t>(natsMsg_GetDataLength(message.get()))};
}

/// A connection to a broker. Received messages are polled, on the caller's thread.
class NatsConnection {
 public:
  /// `comes_back`: a lost connection is re-established, without limit, and messages published
  /// meanwhile may be lost. Fails where the broker does not answer.
  static Expected<NatsConnection> open(const BrokerAddress& address, bool comes_back,
                                       std::chrono::milliseconds timeout);

  Expected<NatsSubscription> subscribe(const std::string& subject) const;
  /// Returns once the broker has received everything that was sent.
  Expected<void> flush(std::chrono::milliseconds timeout) const;
  Expected<void> publish(const std::string& subject, std::span<const std::byte> bytes) const;
  Expected<void> request(const std::string& subject, const std::string& reply) const;
  /// A new unique subject.
  std::string new_inbox() const;
  /// Largest size of a published frame [bytes].
  std::size_t max_frame_bytes() const;

 private:
  NatsConnection(std::string host, natsConnection* connection)
      : host_(std::move(host)), connection_(connection) {}
  Expected<void> checked(natsStatus status, const char* what) const;

  std::string host_;
  std::unique_ptr<natsConnection, NatsDeleter> connection_;
};

/// The next message of a subscription; none where none arrives in time. Fails once the connection
/// is closed.
Expected<std::optional<NatsMessage>> next_message(const NatsSubscription& subscription,
                                                  std::chrono::milliseconds timeout);

}  // namespace lambent::stream
