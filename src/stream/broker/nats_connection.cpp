// SPDX-License-Identifier: Apache-2.0
#include "stream/broker/nats_connection.h"

#include <algorithm>
#include <utility>

namespace lambent::stream {
namespace {

constexpr std::int64_t kReconnectWaitMs = 250;
// Longer messages of light are split, even if the broker accepts larger ones, so that other
// messages are not delayed.
constexpr std::int64_t kMaxFrameBytes = std::int64_t{512} << 10u;

}  // namespace

Expected<NatsConnection> NatsConnection::open(const BrokerAddress& address, bool comes_back,
                                              std::chrono::milliseconds timeout) {
  natsOptions* made = nullptr;
  natsStatus status = natsOptions_Create(&made);
  const std::unique_ptr<natsOptions, NatsDeleter> options(made);
  if (status == NATS_OK) status = natsOptions_SetURL(made, address.url.c_str());
  if (status == NATS_OK) status = natsOptions_SetTimeout(made, timeout.count());
  if (status == NATS_OK) status = natsOptions_SetAllowReconnect(made, comes_back);
  if (status == NATS_OK) status = natsOptions_SetMaxReconnect(made, -1);
  if (status == NATS_OK) status = natsOptions_SetReconnectWait(made, kReconnectWaitMs);
  natsConnection* connection = nullptr;
  if (status == NATS_OK) status = natsConnection_Connect(&connection, made);
  if (status == NATS_OK) return NatsConnection(address.url, connection);
  return fail("", address.url,
              std::string("the broker does not answer: ") + natsStatus_GetText(status),
              Error::Kind::failed);
}

Expected<void> NatsConnection::checked(natsStatus status, const char* what) const {
  if (status == NATS_OK) return {};
  return fail("", host_, std::string(what) + ": " + natsStatus_GetText(status),
              Error::Kind::failed);
}

Expected<NatsSubscription> NatsConnection::subscribe(const std::string& subject) const {
  natsSubscription* made = nullptr;
  const auto done = checked(natsConnection_SubscribeSync(&made, connection_.get(), subject.c_str()),
                            "the broker takes no subscription");
  if (!done) return tl::unexpected(done.error());
  return NatsSubscription(made);
}

Expected<void> NatsConnection::flush(std::chrono::milliseconds timeout) const {
  return checked(natsConnection_FlushTimeout(connection_.get(), timeout.count()),
                 "the broker does not answer");
}

Expected<void> NatsConnection::publish(const std::string& subject,
                                       std::span<const std::byte> bytes) const {
  return checked(natsConnection_Publish(connection_.get(), subject.c_str(), bytes.data(),
                                        static_cast<int>(bytes.size())),
                 "the broker does not take what is published");
}

Expected<void> NatsConnection::request(const std::string& subject, const std::string& reply) const {
  return checked(
      natsConnection_PublishRequest(connection_.get(), subject.c_str(), reply.c_str(), nullptr, 0),
      "the broker takes no request");
}

std::string NatsConnection::new_inbox() const {
  natsInbox* inbox = nullptr;
  if (natsInbox_Create(&inbox) != NATS_OK) return {};
  std::string name = inbox;
  natsInbox_Destroy(inbox);
  return name;
}

std::size_t NatsConnection::max_frame_bytes() const {
  return static_cast<std::size_t>(std::clamp<std::int64_t>(
      natsConnection_GetMaxPayload(connection_.get()), 1024, kMaxFrameBytes));
}

Expected<std::optional<NatsMessage>> next_message(const NatsSubscription& subscription,
                                                  std::chrono::milliseconds timeout) {
  natsMsg* message = nullptr;
  const natsStatus status = natsSubscription_NextMsg(&message, subscription.get(),
                                                     std::max<std::int64_t>(timeout.count(), 1));
  if (status == NATS_OK) return std::optional(NatsMessage(message));
  // None of these ends the connection: messages that a slow reader lost are found by sequence
  // numbers, and a request without a responder may get one later
  if (status == NATS_TIMEOUT || status == NATS_SLOW_CONSUMER || status == NATS_NO_RESPONDERS) {
    return std::optional<NatsMessage>();
  }
  return fail("", "broker", std::string("has ended the connection: ") + natsStatus_GetText(status),
              Error::Kind::failed);
}

}  // namespace lambent::stream
