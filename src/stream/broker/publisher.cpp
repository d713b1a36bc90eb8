// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <list>
#include <random>
#include <thread>
#include <utility>

#include "stream/broker/broker.h"
#include "stream/broker/frames.h"
#include "stream/broker/nats_connection.h"
#include "stream/edits/edits.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

// Interval at which messages to publish and requests to join are polled.
constexpr std::chrono::milliseconds kPublisherLook{5};
constexpr std::chrono::milliseconds kConnectTimeout{5'000};
// Maximum number of clients that join at a time, each of which gets the whole state; others ask
// again.
constexpr std::size_t kMaxJoining = 16;
// Time for a client to receive the whole state; there may be no light yet.
constexpr std::chrono::seconds kJoinTimeout{10};

Hello light_hello() {
  Hello hello;
  hello.wants = kWantsLight;
  return hello;
}

/// Whether a message for a client of light is published: edits and light are.
bool is_handed_on(const Message& message) {
  return std::holds_alternative<LightPayload>(message) ||
         std::visit([](const auto& any) { return std::is_constructible_v<Edit, decltype(any)>; },
                    message);
}

class NatsPublisher : public BrokerPublisher {
 public:
  NatsPublisher(BrokerAddress address, NatsConnection connection, NatsSubscription joins, Hub& hub,
                std::shared_ptr<ClientLink> stream, std::function<void(const std::string&)> log)
      : address_(std::move(address)),
        connection_(std::move(connection)),
        joins_(std::move(joins)),
        hub_(hub),
        stream_(std::move(stream)),
        log_(std::move(log)),
        session_(std::random_device()()) {
    thread_ = std::thread([this] { run(); });
  }
  ~NatsPublisher() override {
    ends_ = true;
    thread_.join();
    for (const Joining& one : joining_) hub_.leave(one.link);
    hub_.leave(stream_);
  }

 private:
  struct Joining {
    std::shared_ptr<ClientLink> link;
    std::string reply;
    Clock::time_point since;
    std::uint64_t sequence = 0;
  };

  void run() {
    while (!ends_) {
      take_joins();
      publish_stream();
      std::erase_if(joining_, [this](Joining& one) {
        const bool done = answer(one) || Clock::now() > one.since + kJoinTimeout;
        if (done) hub_.leave(one.link);
        return done;
      });
    }
  }

  /// Answers requests to join; waits for kLook for the first one.
  void take_joins() {
    for (auto wait = kPublisherLook;; wait = std::chrono::milliseconds(1)) {
      const auto message = next_message(joins_, wait);
      if (!message) {
        tell(message.error().message());
        std::this_thread::sleep_for(kPublisherLook);
        return;
      }
      if (!*message) return;
      const char* reply = natsMsg_GetReply((*message)->get());
      if (reply == nullptr || joining_.size() >= kMaxJoining) continue;
      auto link = hub_.join(light_hello(), Role::view, [] {});
      if (!link) continue;
      Joining one{std::move(link), reply, Clock::now()};
      publish(reply, write_message(hub_.welcome(Role::view)), ++one.sequence);
      joining_.push_back(std::move(one));
    }
  }

  /// Publishes the world's messages for clients of light, and answers them as a client would.
  void publish_stream() {
    while (const SharedBytes bytes = stream_->next(Clock::now())) {
      const auto message = parse_message(*bytes, Sender::server);
      if (!message || !is_handed_on(*message)) continue;
      publish(light_subject(address_.name), *bytes, ++sequence_);
      answer_light(*stream_, *message);
    }
  }

  /// Sends a joining client its messages; returns whether it has got all.
  bool answer(Joining& one) {
    while (const SharedBytes bytes = one.link->next(Clock::now())) {
      const auto message = parse_message(*bytes, Sender::server);
      if (!message || !is_handed_on(*message)) continue;
      publish(one.reply, *bytes, ++one.sequence);
      answer_light(*one.link, *message);
    }
    return one.link->has_all();
  }

  static void answer_light(ClientLink& link, const Message& message) {
    const auto* light = std::get_if<LightPayload>(&message);
    if (light == nullptr) return;
    const auto opened = open_message(light->bytes);
    // The geometry of corrections is the one with which they appeared, so skip them
    if (!opened || opened->header.kind == LightMessageKind::corrections) return;
    static_cast<void>(
        link.receive(LightReceived{light->update, opened->header.geometry, 0}, Clock::now()));
  }

  void publish(const std::string& subject, std::span<const std::byte> message,
               std::uint64_t sequence) {
    for (const auto& frame :
         write_frames(message, session_, sequence, connection_.max_frame_bytes())) {
      if (const auto done = connection_.publish(subject, frame); !done) {
        return tell(done.error().message());
      }
    }
    told_ = false;
  }

  /// Logs an error, once until publishing works again.
  void tell(const std::string& what) {
    if (!std::exchange(told_, true)) log_(what);
  }

  const BrokerAddress address_;
  const NatsConnection connection_;
  const NatsSubscription joins_;
  Hub& hub_;
  const std::shared_ptr<ClientLink> stream_;
  const std::function<void(const std::string&)> log_;
  const std::uint32_t session_;
  std::uint64_t sequence_ = 0;
  std::list<Joining> joining_;
  bool told_ = false;
  std::atomic<bool> ends_ = false;
  std::thread thread_;  // last: it uses all others
};

}  // namespace

bool has_broker() {
  return true;
}

Expected<void> BrokerPublisher::check(const BrokerAddress& address) {
  const auto connection = NatsConnection::open(address, false, kConnectTimeout);
  if (!connection) return tl::unexpected(connection.error());
  return {};
}

Expected<std::unique_ptr<BrokerPublisher>> BrokerPublisher::open(
    const BrokerAddress& address, Hub& hub, std::function<void(const std::string&)> log) {
  auto connection = NatsConnection::open(address, true, kConnectTimeout);
  if (!connection) return tl::unexpected(connection.error());
  auto joins = connection->subscribe(join_subject(address.name));
  if (!joins) return tl::unexpected(joins.error());
  // From now on, requests to join are received
  if (const auto done = connection->flush(kConnectTimeout); !done) {
    return tl::unexpected(done.error());
  }
  auto stream = hub.join(light_hello(), Role::view, [] {});
  if (!stream) return fail("", address.url, "there are as many clients as may be");
  return std::make_unique<NatsPublisher>(address, std::move(*connection), std::move(*joins), hub,
                                         std::move(stream), std::move(log));
}

}  // namespace lambent::stream
