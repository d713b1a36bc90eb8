// SPDX-License-Identifier: Apache-2.0
// Files with the messages of clients to a server, and the times at which they arrived:
// docs/protocol.md.
#pragma once

#include <chrono>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// An action of a client.
struct SessionEntry {
  std::chrono::microseconds time{0};  ///< Since the server began to listen; in ascending order.
  std::uint32_t client = 0;           ///< From 1, in the order of connecting.
  /// The first of each client is a Hello without a token; none: the client has left.
  std::optional<Message> message;
};

/// Whether a message is recorded: all messages of clients, except answers to those of the server.
bool belongs_to_session(const Message& message);

/// Writes a session while it runs. The file remains readable if the server is killed.
class SessionWriter {
 public:
  /// Largest size of a session.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30u;

  /// Creates or replaces the file. Fails where that is not possible.
  static Expected<SessionWriter> create(const std::string& path);
  /// Fails where the disk or the session is full; nothing more is written then.
  Expected<void> add(const SessionEntry& entry);

 private:
  SessionWriter(std::string path, std::ofstream file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  std::ofstream file_;
  std::uint64_t bytes_ = 0;
};

/// Reads all entries of a file. A truncated entry at the end, from a server that was killed, is
/// skipped. Fails on files that are missing or of another kind or version, and on entries that no
/// server wrote.
Expected<std::vector<SessionEntry>> read_session(const std::string& path);

}  // namespace lambent::stream
