// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <deque>
#include <utility>

#include "lambent/stream.h"
#include "stream/broker/broker.h"
#include "stream/broker/frames.h"
#include "stream/broker/nats_connection.h"
#include "stream/edits/edits.h"

namespace lambent::stream {
namespace {

using Clock = std::chrono::steady_clock;

// Interval at which `wake` is polled.
constexpr std::chrono::milliseconds kSubscriberLook{10};
// Time after which a request to join is repeated: it was lost, or the server is full.
constexpr std::chrono::seconds kAskAgain{3};
// Maximum number of the stream's messages that are queued while the answer to a request to join is
// pending.
constexpr std::size_t kMaxHeld = 4096;
constexpr std::size_t kMaxMessageBytes = kHeaderBytes + kMaxLightBytes;

/// A Client that reads from a broker. Messages of the stream are returned after the answer to the
/// request to join; if some are lost, the whole state is requested again.
class NatsSubscriber : public Client {
 public:
  NatsSubscriber(BrokerAddress address, NatsConnection connection, NatsSubscription stream)
      : address_(std::move(address)),
        connection_(std::move(connection)),
        stream_(std::move(stream)) {}

  /// Requests the whole state.
  Expected<void> ask() {
    const std::string inbox = connection_.new_inbox();
    auto answer = connection_.subscribe(inbox);
    if (!answer) return tl::unexpected(answer.error());
    answer_ = std::move(*answer);
    answered_ = 0;
    begun_ = false;
    answer_frames_ = FrameReader(kMaxMessageBytes);
    held_.clear();
    asked_ = Clock::now();
    // The broker must know the subscriptions before the answer is sent
    if (const auto done = connection_.flush(std::chrono::milliseconds(1'000)); !done) return done;
    return connection_.request(join_subject(address_.name), inbox);
  }

  Expected<void> send(const Message& message) override {
    if (std::visit([](const auto& any) { return std::is_constructible_v<Edit, decltype(any)>; },
                   message)) {
      return fail("", address_.url, "a broker hands on no edits");
    }
    const auto* told = std::get_if<LightReceived>(&message);
    if (told != nullptr && told->needs_key == 1 && begun_) return ask();
    return {};
  }
  Expected<void> send_bytes(std::span<const std::byte> /*bytes*/, bool /*binary*/) override {
    return fail("", address_.url, "a broker hands on no messages of clients");
  }

  Expected<std::optional<Message>> receive(std::chrono::milliseconds timeout) override {
    const auto end = Clock::now() + timeout;
    do {
      auto message = step(std::min<std::chrono::milliseconds>(timeout, kSubscriberLook));
      if (!message || *message) return message;
    } while (Clock::now() < end && !woken_.exchange(false));
    return std::nullopt;
  }
  void wake() override { woken_ = true; }
  void close() override {}

 private:
  /// Receives one frame, if there is any.
  Expected<std::optional<Message>> step(std::chrono::milliseconds wait) {
    if (begun_ && !held_.empty()) {
      FramedMessage framed = std::move(held_.front());
      held_.pop_front();
      return follow(std::move(framed));
    }
    if (!begun_) {
      if (Clock::now() > asked_ + kAskAgain) {
        if (const auto asked = ask(); !asked) return tl::unexpected(asked.error());
      }
      auto came = next_message(answer_, wait);
      if (!came) return tl::unexpected(came.error());
      if (*came) return take_answer(**came);
      wait = std::chrono::milliseconds(1);
    }
    auto came = next_message(stream_, wait);
    if (!came) return tl::unexpected(came.error());
    if (!*came) return begun_ ? take_rest() : std::nullopt;
    auto framed = stream_frames_.add(bytes_of(**came));
    if (!framed) return std::nullopt;
    if (begun_) return follow(std::move(*framed));
    // leaves a gap, so that the state is requested again
    if (held_.size() >= kMaxHeld) held_.clear();
    held_.push_back(std::move(*framed));
    return std::nullopt;
  }

  /// Receives the part of the answer after the light, which is corrections. All other messages also
  /// come on the stream.
  Expected<std::optional<Message>> take_rest() {
    auto came = next_message(answer_, std::chrono::milliseconds(1));
    if (!came) return tl::unexpected(came.error());
    if (!*came) return std::nullopt;
    auto message = take_answer(**came);
    if (!message || !*message) return message;
    const auto* light = std::get_if<LightPayload>(&**message);
    if (light == nullptr ||
        static_cast<LightMessageKind>(light->kind) != LightMessageKind::corrections) {
      return std::nullopt;
    }
    return message;
  }

  Expected<std::optional<Message>> take_answer(const NatsMessage& came) {
    auto framed = answer_frames_.add(bytes_of(came));
    if (!framed) return std::nullopt;
    auto message = parse_message(framed->bytes, Sender::server);
    if (!message || framed->sequence != answered_ + 1) {
      if (const auto asked = ask(); !asked) return tl::unexpected(asked.error());
      return std::nullopt;
    }
    ++answered_;
    asked_ = Clock::now();
    if (session_ && framed->session != *session_) return fail_of_another();
    session_ = framed->session;
    const auto* light = std::get_if<LightPayload>(&*message);
    if (!begun_ && light != nullptr &&
        static_cast<LightMessageKind>(light->kind) == LightMessageKind::key) {
      begun_ = true;
      sequence_ = 0;
    }
    // Return only the first welcome
    if (std::holds_alternative<Welcome>(*message) && std::exchange(welcomed_, true)) {
      return std::nullopt;
    }
    return std::optional(std::move(*message));
  }

  /// Returns a message of the stream if it follows the last one, or the answer.
  Expected<std::optional<Message>> follow(FramedMessage framed) {
    if (framed.session != session_) {
      // It is from another server, or from one that restarted
      auto message = parse_message(framed.bytes, Sender::server);
      if (!message) return std::nullopt;
      return fail_of_another();
    }
    if (sequence_ != 0 && framed.sequence != sequence_ + 1) {
      if (const auto asked = ask(); !asked) return tl::unexpected(asked.error());
      return std::nullopt;
    }
    sequence_ = framed.sequence;
    auto message = parse_message(framed.bytes, Sender::server);
    if (!message) return std::nullopt;
    return std::optional(std::move(*message));
  }

  tl::unexpected<Error> fail_of_another() const {
    return fail("", address_.url, "another server publishes as " + address_.name + " now",
                Error::Kind::failed);
  }

  const BrokerAddress address_;
  const NatsConnection connection_;
  const NatsSubscription stream_;
  NatsSubscription answer_;  // to the last request
  FrameReader stream_frames_{kMaxMessageBytes}, answer_frames_{kMaxMessageBytes};
  std::deque<FramedMessage> held_;
  Clock::time_point asked_;
  // number of messages of the answer, and the stream's last sequence number
  std::uint64_t answered_ = 0, sequence_ = 0;
  std::optional<std::uint32_t> session_;
  bool begun_ = false;  // the whole state of light was received
  bool welcomed_ = false;
  std::atomic<bool> woken_ = false;
};

}  // namespace

Expected<Joined> join_through_broker(const ConnectSettings& settings, const Hello& hello) {
  const BrokerAddress& address = settings.broker;
  if (hello.wants != kWantsLight) {
    return fail("", address.url, "a broker has light alone, in our own codec");
  }
  auto connection = NatsConnection::open(address, false, settings.timeout);
  if (!connection) return tl::unexpected(connection.error());
  auto stream = connection->subscribe(light_subject(address.name));
  if (!stream) return tl::unexpected(stream.error());
  auto client =
      std::make_unique<NatsSubscriber>(address, std::move(*connection), std::move(*stream));
  if (const auto asked = client->ask(); !asked) return tl::unexpected(asked.error());
  const auto answer = client->receive(settings.timeout);
  if (!answer) return tl::unexpected(answer.error());
  const auto* welcome = *answer ? std::get_if<Welcome>(&**answer) : nullptr;
  if (welcome == nullptr) {
    return fail("", address.url, "no server publishes as " + address.name, Error::Kind::failed);
  }
  const Welcome told = *welcome;
  return Joined{std::move(client), told};
}

}  // namespace lambent::stream
