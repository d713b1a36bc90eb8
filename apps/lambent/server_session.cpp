// SPDX-License-Identifier: Apache-2.0
#include "lambent/server_session.h"

#include <algorithm>
#include <thread>

#include "lambent/console.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

// Time between attempts to join.
constexpr std::chrono::milliseconds kRetry{250};
// Interval at which interrupts are looked for while nothing arrives.
constexpr std::chrono::milliseconds kInterruptPoll{100};

}  // namespace

Expected<ServerSession> ServerSession::join(const stream::ConnectSettings& settings,
                                            const stream::Hello& hello) {
  auto joined = stream::join(settings, hello);
  if (!joined) return tl::unexpected(joined.error());
  return ServerSession(settings, hello, std::move(*joined));
}

Expected<void> ServerSession::send(const stream::Message& message) {
  const auto sent = joined_.client->send(message);
  if (!sent) lost_ = true;
  return sent;
}

Expected<std::optional<stream::Message>> ServerSession::receive_until(
    std::chrono::steady_clock::time_point end, const InterruptGuard& guard) {
  while (!guard.interrupted()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) break;
    auto message = joined_.client->receive(std::min(left, kInterruptPoll));
    if (!message) {
      // Messages that are not of the protocol are bad input, and leave the connection as it is
      if (message.error().kind == Error::Kind::failed) lost_ = true;
      if (refusal_) message.error().cause += "; it said: " + printable(refusal_->text);
      return message;
    }
    if (!*message) continue;
    if (const auto* refusal = std::get_if<stream::Refusal>(&**message)) refusal_ = *refusal;
    return message;
  }
  return std::optional<stream::Message>();
}

/// Whether the connection was lost, and joining again may help: it has led to a picture, and the
/// server did not end it for anything that the client did.
bool ServerSession::can_join_again() const {
  using Code = stream::Refusal::Code;
  const bool at_fault =
      refusal_ && refusal_->code != Code::shutting_down && refusal_->code != Code::refused_input;
  return lost_ && brought_picture_ && !at_fault;
}

/// Joins the server again, after the connection was lost because of `why`.
Expected<void> ServerSession::join_again(const Error& why, const InterruptGuard& guard) {
  warn("the connection to the server was lost, and is tried again: " + why.message());
  const auto end = std::chrono::steady_clock::now() + settings_.timeout;
  while (!guard.interrupted() && std::chrono::steady_clock::now() < end) {
    auto joined = stream::join(settings_, hello_);
    if (joined) {
      joined_ = std::move(*joined);
      lost_ = brought_picture_ = false;
      refusal_.reset();
      tell("the server is back");
      return {};
    }
    if (joined.error().kind != Error::Kind::failed) return tl::unexpected(joined.error());
    std::this_thread::sleep_for(kRetry);
  }
  return tl::unexpected(why);
}

Expected<void> ServerSession::over_connections(const InterruptGuard& guard,
                                               const std::function<Expected<void>()>& use) {
  for (;;) {
    const auto done = use();
    if (done || !can_join_again()) return done;
    const auto back = join_again(done.error(), guard);
    if (guard.interrupted()) return {};
    if (!back) return back;
  }
}

}  // namespace lambent::cli
