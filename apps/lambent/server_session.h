// SPDX-License-Identifier: Apache-2.0
// A connection to a server of light and pictures, which can be made again where it is lost.
#pragma once

#include <chrono>
#include <functional>
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

  /// See stream::Client.
  Expected<void> send(const stream::Message& message);
  /// The next message; none if none arrives in time, or there is an interrupt before. The cause of
  /// a failure includes what the server said last.
  Expected<std::optional<stream::Message>> receive_until(std::chrono::steady_clock::time_point end,
                                                         const InterruptGuard& guard);
  /// Notes that the present connection has led to a picture.
  void note_picture() { brought_picture_ = true; }

  /// Calls `use`, which uses the present connection, and, where that is lost after it has led to a
  /// picture, joins the server again and repeats. Returns once a call succeeds or there is an
  /// interrupt. Fails as a call fails, where the server refuses the client, and where it does not
  /// take it within timeout().
  Expected<void> over_connections(const InterruptGuard& guard,
                                  const std::function<Expected<void>()>& use);
  void close() { joined_.client->close(); }

 private:
  bool can_join_again() const;
  Expected<void> join_again(const Error& why, const InterruptGuard& guard);
  ServerSession(const stream::ConnectSettings& settings, const stream::Hello& hello,
                stream::Joined joined)
      : settings_(settings), hello_(hello), joined_(std::move(joined)) {}

  stream::ConnectSettings settings_;
  stream::Hello hello_;
  stream::Joined joined_;
  std::optional<stream::Refusal> refusal_;  // the last one on this connection
  bool lost_ = false, brought_picture_ = false;
};

}  // namespace lambent::cli
