// SPDX-License-Identifier: Apache-2.0
#include "lambent/server_session.h"

#include <algorithm>
#include <thread>

#include "lambent/console.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

// Time between attempts to join, and the longest that one of them may take.
constexpr std::chrono::milliseconds kRetry{250}, kAttempt{1'000};

}  // namespace

Expected<ServerSession> ServerSession::join(const stream::ConnectSettings& settings,
                                            const stream::Hello& hello) {
  auto joined = stream::join(settings, hello);
  if (!joined) return tl::unexpected(joined.error());
  return ServerSession(settings, hello, std::move(*joined));
}

Expected<void> ServerSession::send(const stream::Message& message) {
  const auto sent = joined_.client->send(message);
  lost_ = lost_ || !sent;
  return sent;
}

Expected<std::optional<stream::Message>> ServerSession::receive(std::chrono::milliseconds timeout) {
  auto message = joined_.client->receive(timeout);
  if (!message) {
    lost_ = true;
    if (!said_.empty()) message.error().cause += "; it said: " + printable(said_);
    return message;
  }
  if (!*message) return message;
  if (const auto* refusal = std::get_if<stream::Refusal>(&**message)) said_ = refusal->text;
  return message;
}

Expected<void> ServerSession::join_again(const Error& why, const InterruptGuard& guard) {
  if (!std::exchange(fruitful_, false)) return tl::unexpected(why);
  warn("the server has gone, and is looked for: " + why.message());
  stream::ConnectSettings attempt = settings_;
  attempt.timeout = std::min(attempt.timeout, kAttempt);
  const auto end = std::chrono::steady_clock::now() + settings_.timeout;
  while (!guard.interrupted() && std::chrono::steady_clock::now() < end) {
    auto joined = stream::join(attempt, hello_);
    if (joined) {
      joined_ = std::move(*joined);
      lost_ = false;
      said_.clear();
      tell("the server is back");
      return {};
    }
    if (joined.error().kind != Error::Kind::failed) return tl::unexpected(joined.error());
    std::this_thread::sleep_for(kRetry);
  }
  return tl::unexpected(why);
}

}  // namespace lambent::cli
