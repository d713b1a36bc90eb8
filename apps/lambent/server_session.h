// SPDX-License-Identifier: Apache-2.0
// A connection to a server of light and pictures that is made again where it ends.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "lambent/error.h"
#include "lambent/interrupts.h"
#include "stream/client/client.h"

namespace lambent::cli {

class ServerSession {
 public:
  /// Joins a server, with `hello` in each connection.
  static Expected<ServerSession> join(const stream::ConnectSettings& settings,
                                      const stream::Hello& hello);

  /// The welcome of the present connection.
  const stream::Welcome& welcome() const { return joined_.welcome; }
  /// How long an answer may take.
  std::chrono::milliseconds timeout() const { return settings_.timeout; }

  /// See stream::Client. A failure means that the connection is lost.
  Expected<void> send(const stream::Message& message);
  /// The next message within a time; none if none arrives in time. A failure means that the
  /// connection is lost; its cause includes what the server said last.
  Expected<std::optional<stream::Message>> receive(std::chrono::milliseconds timeout);
  /// Says that the connection has brought what it was made for.
  void bore_fruit() { fruitful_ = true; }

  bool is_lost() const { return lost_; }
  /// Joins the server again, within timeout(), once the connection was lost because of `why`. Fails
  /// with that where the connection bore no fruit, where nobody answers in time, and at an
  /// interrupt; or with the server's refusal.
  Expected<void> join_again(const Error& why, const InterruptGuard& guard);
  void close() { joined_.client->close(); }

 private:
  ServerSession(const stream::ConnectSettings& settings, const stream::Hello& hello,
                stream::Joined joined)
      : settings_(settings), hello_(hello), joined_(std::move(joined)) {}

  stream::ConnectSettings settings_;
  stream::Hello hello_;
  stream::Joined joined_;
  std::string said_;
  bool lost_ = false, fruitful_ = false;
};

}  // namespace lambent::cli
