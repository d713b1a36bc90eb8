// SPDX-License-Identifier: Apache-2.0
#include "stream/server/client_link.h"

#include <algorithm>
#include <utility>

namespace lambent::stream {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

ClientLink::ClientLink(Hello hello, Role role, std::function<void()> wake_connection,
                       std::function<void()> wake_world)
    : hello_(std::move(hello)),
      role_(role),
      wake_connection_(std::move(wake_connection)),
      wake_world_(std::move(wake_world)) {}

std::optional<Refusal> ClientLink::take_edit(const Edit& edit) {
  if (role_ != Role::change) {
    return Refusal{Refusal::Code::not_allowed, "this token allows to look, not to change"};
  }
  const auto same =
      std::find_if(inputs_.edits.begin(), inputs_.edits.end(),
                   [&edit](const Edit& earlier) { return target_of(earlier) == target_of(edit); });
  if (same != inputs_.edits.end()) {
    const Edit both = merged(*same, edit);
    inputs_.edits.erase(same);
    inputs_.edits.push_back(both);
  } else {
    if (inputs_.edits.size() >= kMaxEdits) {
      return Refusal{Refusal::Code::too_many, "too many edits at once"};
    }
    inputs_.edits.push_back(edit);
  }
  inputs_.last_input = std::visit([](const auto& any) { return any.input; }, edit);
  if (!first_edit_) first_edit_ = inputs_.last_input;
  return std::nullopt;
}

void ClientLink::take_received(const Received& received, Clock::time_point now,
                               std::optional<PathTime> path) {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  while (!under_way_.empty() && under_way_.front().number <= received.picture) {
    // A picture that was not sent yet cannot have arrived
    const UnderWay& one = under_way_.front();
    if (!one.sent) return;
    const Milliseconds took = now - *one.sent;
    const Milliseconds on_path = path && one.path ? Milliseconds(*path - *one.path) : took;
    inputs_.arrivals.push_back({took.count(), std::min(on_path, took).count()});
    under_way_.pop_front();
  }
}

std::optional<Refusal> ClientLink::receive(const Message& message, Clock::time_point now,
                                           std::optional<PathTime> path) {
  std::optional<Refusal> refusal;
  std::optional<Ping> answer;
  {
    const std::lock_guard lock(mutex_);
    refusal = std::visit(
        Overloaded{
            [&](const CameraInput& camera) -> std::optional<Refusal> {
              inputs_.camera = camera;
              inputs_.last_input = camera.input;
              return std::nullopt;
            },
            [&](const PictureRequest& request) -> std::optional<Refusal> {
              inputs_.request = request;
              return std::nullopt;
            },
            [&](const Interest& interest) -> std::optional<Refusal> {
              if (!wants(kWantsLight)) {
                return Refusal{Refusal::Code::bad_message, "there is no light to have less of"};
              }
              inputs_.interest = interest;
              return std::nullopt;
            },
            [&](const TimeOfDay& edit) { return take_edit(edit); },
            [&](const SunInput& edit) { return take_edit(edit); },
            [&](const LightInput& edit) { return take_edit(edit); },
            [&](const ObjectInput& edit) { return take_edit(edit); },
            [&](const Received& received) -> std::optional<Refusal> {
              take_received(received, now, path);
              return std::nullopt;
            },
            [&](const LightReceived& received) -> std::optional<Refusal> {
              take_light_received(received);
              return std::nullopt;
            },
            [&](const Ping& ping) -> std::optional<Refusal> {
              if (ping.answer == 0) answer = Ping{ping.token, 1};
              return std::nullopt;
            },
            [](const auto&) -> std::optional<Refusal> {
              return Refusal{Refusal::Code::bad_message, "this message is not expected now"};
            }},
        message);
  }
  if (answer) put_notice(*answer);
  // Answers to light do not wake the world, since many clients send them constantly
  const bool is_answer =
      std::holds_alternative<LightReceived>(message) || std::holds_alternative<Ping>(message);
  if (!is_answer) wake_world_();
  return refusal;
}

void ClientLink::take_light_received(const LightReceived& received) {
  while (!updates_under_way_.empty() && updates_under_way_.front().update <= received.update) {
    updates_under_way_.pop_front();
  }
  known_geometry_ = received.geometry;
  // Ignore reports from before the whole state was sent again
  if (received.needs_key == 1 && received.update >= all_sent_at_) light_lost_ = true;
}

bool ClientLink::is_late() const {
  if (updates_under_way_.size() < kUpdatesUnderWay) return false;
  if (updates_under_way_.size() >= kMostUpdatesUnderWay) return true;
  std::size_t bytes = 0;
  for (const LightUnderWay& one : updates_under_way_) bytes += one.bytes;
  return 2 * bytes >= whole_bytes_;
}

LightNeed ClientLink::need_light() {
  const std::lock_guard lock(mutex_);
  const bool late = is_late();
  if (late) light_lost_ = true;
  if (gone_ || late) return LightNeed::nothing;
  return light_lost_ ? LightNeed::all : LightNeed::changes;
}

std::uint64_t ClientLink::known_geometry() const {
  const std::lock_guard lock(mutex_);
  return known_geometry_;
}

void ClientLink::put_light(std::span<const SharedBytes> messages, std::uint64_t update,
                           LightNeed what) {
  {
    const std::lock_guard lock(mutex_);
    if (gone_ || messages.empty()) return;
    light_.insert(light_.end(), messages.begin(), messages.end());
    std::size_t bytes = 0;
    for (const SharedBytes& message : messages) bytes += message->size();
    // A whole state takes time to transfer, and must not count against the client
    updates_under_way_.push_back({update, what == LightNeed::all ? 0 : bytes});
    if (what == LightNeed::all) whole_bytes_ = bytes;
    if (what == LightNeed::all) {
      later_put_ = false;
      light_lost_ = false;
      all_sent_at_ = update;
    }
  }
  wake_connection_();
}

void ClientLink::put_later(std::span<const SharedBytes> messages, bool anew) {
  {
    const std::lock_guard lock(mutex_);
    if (gone_) return;
    if (anew) later_.clear();
    later_.insert(later_.end(), messages.begin(), messages.end());
    later_put_ = true;
  }
  wake_connection_();
}

bool ClientLink::has_all() const {
  const std::lock_guard lock(mutex_);
  return later_put_ && !light_lost_ && light_.empty() && later_.empty();
}

void ClientLink::begin_light_anew() {
  const std::lock_guard lock(mutex_);
  light_.clear();
  later_.clear();
  updates_under_way_.clear();
  all_sent_at_ = 0;
  light_lost_ = true;
}

SharedBytes ClientLink::next(Clock::time_point now, std::optional<PathTime> path) {
  const std::lock_guard lock(mutex_);
  if (!notices_.empty()) {
    auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(notices_.front()));
    notices_.pop_front();
    return bytes;
  }
  if (!light_.empty()) {
    SharedBytes bytes = std::move(light_.front());
    light_.pop_front();
    return bytes;
  }
  if (!picture_) {
    if (later_.empty()) return nullptr;
    SharedBytes bytes = std::move(later_.front());
    later_.pop_front();
    return bytes;
  }
  for (UnderWay& one : under_way_) {
    if (one.number != waiting_picture_) continue;
    one.sent = now;
    one.path = path;
  }
  auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(*picture_));
  picture_.reset();
  return bytes;
}

void ClientLink::leave() {
  {
    const std::lock_guard lock(mutex_);
    gone_ = true;
    picture_.reset();
    notices_.clear();
    light_.clear();
    later_.clear();
  }
  wake_world_();
}

bool ClientLink::gone() const {
  const std::lock_guard lock(mutex_);
  return gone_;
}

ClientInputs ClientLink::take_inputs(bool with_edits) {
  const std::lock_guard lock(mutex_);
  ClientInputs taken = std::exchange(inputs_, {});
  inputs_.last_input = taken.last_input;
  if (with_edits) {
    first_edit_.reset();
  } else {
    inputs_.edits = std::exchange(taken.edits, {});
    if (first_edit_) taken.last_input = std::min(taken.last_input, *first_edit_ - 1);
  }
  return taken;
}

bool ClientLink::ready_for_picture() const {
  const std::lock_guard lock(mutex_);
  return !gone_ && !picture_ && under_way_.size() < kPicturesUnderWay;
}

void ClientLink::put_picture(const Picture& picture) {
  std::vector<std::byte> bytes = write_message(picture);
  {
    const std::lock_guard lock(mutex_);
    if (gone_) return;
    picture_ = std::move(bytes);
    waiting_picture_ = picture.number;
    under_way_.push_back({picture.number, {}, {}});
  }
  wake_connection_();
}

void ClientLink::put_notice(const Message& message) {
  std::vector<std::byte> bytes = write_message(message);
  {
    const std::lock_guard lock(mutex_);
    // Drop notices of a client that reads nothing; the connection's deadline ends it
    if (gone_ || notices_.size() >= kMaxNotices) return;
    notices_.push_back(std::move(bytes));
  }
  wake_connection_();
}

std::size_t ClientLink::waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = picture_ ? picture_->size() : 0;
  for (const auto& notice : notices_) bytes += notice.size();
  for (const auto& message : light_) bytes += message->size();
  for (const auto& message : later_) bytes += message->size();
  return bytes;
}

}  // namespace lambent::stream
