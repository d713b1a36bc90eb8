// SPDX-License-Identifier: Apache-2.0
#include "lambent/server_session.h"

#include <thread>

#include "lambent/console.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

// Time between attempts to join.
constexpr std::chrono::milliseconds kRetry{250};

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

Expected<std::optional<stream::Message>> ServerSession::receive(std::chrono::milliseconds timeout) {
  auto message = joined_.client->receive(timeout);
  if (!message) {
    // Messages that are not of the protocol are bad input, and leave the connection as it is
    if (message.error().kind == Error::Kind::failed) lost_ = true;
    if (refusal_) message.error().cause += "; it said: " + printable(refusal_->text);
    return message;
  }
  if (!*message) return message;
  if (const auto* refusal = std::get_if<stream::Refusal>(&**message)) refusal_ = *refusal;
  return message;
}

bool ServerSession::can_join_again() const {
  return lost_ && brought_picture_ &&
         (!refusal_ || refusal_->code == stream::Refusal::Code::shutting_down);
}

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

}  // namespace lambent::cli
