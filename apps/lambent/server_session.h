// SPDX-License-Identifier: Apache-2.0
// A connection to a server of light and pictures, which can be made again where it is lost.
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

  /// See stream::Client.
  Expected<void> send(const stream::Message& message);
  /// The next message within a time; none if none arrives in time. The cause of a failure includes
  /// what the server said last.
  Expected<std::optional<stream::Message>> receive(std::chrono::milliseconds timeout);
  /// Notes that the present connection has led to a picture.
  void note_picture() { brought_picture_ = true; }

  /// Whether the connection was lost, and it is worth to join again: it has led to a picture, and
  /// the server did not end it but to shut down.
  bool can_join_again() const;
  /// Joins the server again, after the connection was lost because of `why`. Fails with that where
  /// the server does not take the client within timeout(), and at an interrupt; or with the
  /// server's refusal, unless that is for now alone.
  Expected<void> join_again(const Error& why, const InterruptGuard& guard);
  void close() { joined_.client->close(); }

 private:
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
