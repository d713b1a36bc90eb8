// SPDX-License-Identifier: Apache-2.0
#include "stream/client/upstream.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace lambent::stream {
namespace {

// Maximum number of queued messages; a server that accepts none of them is soon lost.
constexpr std::size_t kMaxWaiting = 512;
// Limits of received messages that were not taken: servers stop at 64 updates of light, so these
// are never reached by them.
constexpr std::size_t kMaxArrivedBytes = std::size_t{1} << 30u, kMaxArrived = 65'536;
// Timeout of attempts to reconnect.
constexpr std::chrono::milliseconds kShort{1'000};
// Interval at which messages to send are polled, in case a call to wake was missed.
constexpr std::chrono::milliseconds kLook{250};

/// Whether two welcomes describe scenes with the same numbers of instances and lights.
bool same_scene(const Welcome& a, const Welcome& b) {
  return a.instances == b.instances && a.lights.size() == b.lights.size();
}

Hello hello_of(const UpstreamSettings& settings) {
  Hello hello;
  hello.wants = kWantsLight;
  hello.token = settings.token;
  return hello;
}

}  // namespace

Expected<std::unique_ptr<Upstream>> Upstream::open(const UpstreamSettings& settings) {
  auto joined = join(settings.connect, hello_of(settings));
  if (!joined) return tl::unexpected(joined.error());
  return std::unique_ptr<Upstream>(new Upstream(settings, std::move(*joined)));
}

Upstream::Upstream(const UpstreamSettings& settings, Joined joined)
    : settings_(settings), first_welcome_(joined.welcome), client_(std::move(joined.client)) {
  status_ = {true, 1, ""};
  arrived_.emplace_back(first_welcome_);
  thread_ = std::thread([this] { run(); });
}

Upstream::~Upstream() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    if (client_) client_->wake();
    ends_.notify_all();
  }
  thread_.join();
}

void Upstream::on_arrival(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

std::vector<Message> Upstream::take() {
  const std::lock_guard lock(mutex_);
  arrived_bytes_ = 0;
  return std::exchange(arrived_, {});
}

void Upstream::send(Message message) {
  const std::lock_guard lock(mutex_);
  if (!client_ || waiting_.size() >= kMaxWaiting) return;
  waiting_.push_back(std::move(message));
  client_->wake();
}

UpstreamStatus Upstream::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool Upstream::ending() const {
  const std::lock_guard lock(mutex_);
  return ending_;
}

void Upstream::lost(const std::string& why) {
  std::shared_ptr<Client> client;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  client = std::exchange(client_, nullptr);
  waiting_.clear();
  status_.connected = false;
  status_.lost_because = why;
  if (wake_) wake_();
}

/// Sends queued messages; returns false if the connection has ended.
bool Upstream::send_waiting() {
  for (;;) {
    std::optional<Message> message;
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.empty()) return true;
      message = std::move(waiting_.front());
      waiting_.pop_front();
    }
    if (const auto sent = client_->send(*message); !sent) {
      lost(sent.error().message());
      return false;
    }
  }
}

/// Stores a message for `take`; returns false if too many are stored.
bool Upstream::arrived(Message message) {
  const std::lock_guard lock(mutex_);
  if (const auto* light = std::get_if<LightPayload>(&message))
    arrived_bytes_ += light->bytes.size();
  if (arrived_bytes_ > kMaxArrivedBytes || arrived_.size() >= kMaxArrived) return false;
  if (const auto* refusal = std::get_if<Refusal>(&message)) said_ = refusal->text;
  arrived_.push_back(std::move(message));
  if (wake_) wake_();
  return true;
}

/// Receives until the connection or this object ends.
void Upstream::follow_connection() {
  auto heard = std::chrono::steady_clock::now();
  said_.clear();
  while (!ending()) {
    if (!send_waiting()) return;
    auto message = client_->receive(kLook);
    if (!message) {
      return lost(said_.empty() ? message.error().message()
                                : message.error().message() + "; it said: " + said_);
    }
    const auto now = std::chrono::steady_clock::now();
    if (!*message) {
      if (now - heard > settings_.silence) return lost("has said nothing for too long");
      continue;
    }
    heard = now;
    if (!arrived(std::move(**message))) return lost("sends more than can be taken");
  }
}

void Upstream::reconnect() {
  ConnectSettings connect = settings_.connect;
  connect.timeout = std::min(connect.timeout, kShort);
  auto joined = join(connect, hello_of(settings_));
  if (!joined) return lost(joined.error().message());
  if (!same_scene(joined->welcome, first_welcome_)) return lost("serves another scene now");
  const std::lock_guard lock(mutex_);
  client_ = std::move(joined->client);
  status_.connected = true;
  status_.lost_because.clear();
  ++status_.connections;
  arrived_.emplace_back(joined->welcome);
  if (wake_) wake_();
}

void Upstream::run() {
  while (!ending()) {
    if (client_) {
      follow_connection();
    } else {
      reconnect();
    }
    std::unique_lock lock(mutex_);
    if (!client_ && !ending_) ends_.wait_for(lock, settings_.retry, [this] { return ending_; });
  }
}

}  // namespace lambent::stream
