// SPDX-License-Identifier: Apache-2.0
#include "stream/session/replay.h"

#include <algorithm>
#include <map>
#include <thread>
#include <type_traits>
#include <utility>

#include "stream/edits/edits.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

using Clock = std::chrono::steady_clock;

// Wait for messages of one client if there are none.
constexpr std::chrono::milliseconds kLook{1};

/// The number of an edit; 0: the message is not an edit.
std::uint32_t edit_number(const Message& message) {
  return std::visit(
      [](const auto& any) -> std::uint32_t {
        if constexpr (std::is_constructible_v<Edit, decltype(any)>) return any.input;
        return 0;
      },
      message);
}

struct OneClient {
  std::unique_ptr<Client> client;
  bool of_pictures = false;
  std::uint32_t last_edit = 0, applied = 0;  // numbers of inputs
  bool settled() const { return applied >= last_edit; }
};

class Replay {
 public:
  Replay(const ReplaySettings& settings, const std::function<bool()>& stop)
      : settings_(settings), stop_(stop) {}

  Expected<Replayed> run(std::span<const SessionEntry> entries) {
    const Clock::time_point start = Clock::now();
    for (const SessionEntry& entry : entries) {
      const auto due = start + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(entry.time) / settings_.speed);
      if (const auto waited = wait_until(due, [] { return false; }); !waited) {
        return tl::unexpected(waited.error());
      }
      if (const auto done = act(entry); !done) return tl::unexpected(done.error());
    }
    const auto settled = settle([this] {
      return std::all_of(clients_.begin(), clients_.end(),
                         [](const auto& one) { return one.second.settled(); });
    });
    if (!settled) return tl::unexpected(settled.error());
    for (auto& [number, one] : clients_) one.client->close();
    return replayed_;
  }

 private:
  Expected<void> act(const SessionEntry& entry) {
    if (!entry.message) {
      const auto one = clients_.find(entry.client);
      if (one == clients_.end()) return {};
      // Wait until its last edit was applied
      const auto settled = settle([&] { return one->second.settled(); });
      if (!settled) return settled;
      one->second.client->close();
      clients_.erase(one);
      return {};
    }
    if (const auto* hello = std::get_if<Hello>(&*entry.message)) return come(entry.client, *hello);
    OneClient& one = clients_.at(entry.client);
    if (const auto sent = one.client->send(*entry.message); !sent) return sent;
    ++replayed_.messages;
    if (const std::uint32_t number = edit_number(*entry.message)) one.last_edit = number;
    return {};
  }

  Expected<void> come(std::uint32_t number, Hello hello) {
    hello.token = settings_.token;
    auto joined = join(settings_.connect, hello);
    if (!joined) return tl::unexpected(joined.error());
    clients_[number] = {std::move(joined->client), (hello.wants & kWantsPicture) != 0};
    ++replayed_.clients;
    return {};
  }

  /// Receives and answers messages until `end`, or until `done` returns true.
  template <class Done>
  Expected<void> wait_until(Clock::time_point end, const Done& done) {
    while (!done()) {
      for (auto& [number, one] : clients_) {
        if (const auto taken = take_all(one); !taken) return taken;
      }
      if (stop_()) return fail("", "", "was interrupted", Error::Kind::failed);
      if (Clock::now() >= end) break;
      if (clients_.empty()) std::this_thread::sleep_until(std::min(end, Clock::now() + kLook));
    }
    return {};
  }

  Expected<void> take_all(OneClient& one) {
    for (;;) {
      const auto message = one.client->receive(kLook);
      if (!message) return tl::unexpected(message.error());
      if (!*message) return {};
      if (const auto taken = take(one, **message); !taken) return taken;
    }
  }

  Expected<void> take(OneClient& one, const Message& message) {
    if (const auto* picture = std::get_if<Picture>(&message)) {
      ++replayed_.pictures;
      one.applied = std::max(one.applied, picture->input);
      return one.client->send(Received{picture->number, 0.0f});
    }
    if (const auto* light = std::get_if<LightPayload>(&message)) {
      const auto opened = open_message(light->bytes);
      if (!opened) return tl::unexpected(opened.error());
      const LightMessageKind kind = opened->header.kind;
      if (kind != LightMessageKind::geometry && kind != LightMessageKind::corrections) {
        ++replayed_.updates;
      }
      return one.client->send(LightReceived{light->update, opened->header.geometry, 0});
    }
    if (const auto* told = std::get_if<InputsApplied>(&message)) {
      one.applied = std::max(one.applied, told->input);
    } else if (const auto* refusal = std::get_if<Refusal>(&message)) {
      if (refusal->code != Refusal::Code::refused_input) {
        return fail("", settings_.connect.host, "refuses: " + refusal->text, Error::Kind::failed);
      }
      ++replayed_.refused_inputs;
    }
    return {};
  }

  /// Waits until `settled` returns true.
  template <class Settled>
  Expected<void> settle(const Settled& settled) {
    const auto waited = wait_until(Clock::now() + settings_.connect.timeout, settled);
    if (!waited || settled()) return waited;
    return fail("", settings_.connect.host, "does not apply edits in time", Error::Kind::failed);
  }

  const ReplaySettings& settings_;
  const std::function<bool()>& stop_;
  std::map<std::uint32_t, OneClient> clients_;
  Replayed replayed_;
};

}  // namespace

Expected<Replayed> replay_session(std::span<const SessionEntry> entries,
                                  const ReplaySettings& settings,
                                  const std::function<bool()>& stop) {
  return Replay(settings, stop).run(entries);
}

}  // namespace lambent::stream
