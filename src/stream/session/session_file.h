// SPDX-License-Identifier: Apache-2.0
// What clients sent to a server, with the times at which it came, in a file: docs/protocol.md.
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

/// Something that a client did.
struct SessionEntry {
  std::chrono::microseconds time{0};  ///< Since the server began to listen; never before the last.
  std::uint32_t client = 0;           ///< From 1, counted as they came.
  /// Its first is a Hello without a token; none: the client has gone.
  std::optional<Message> message;
};

/// Whether a message is kept: all that clients say, but for answers to what the server sends.
bool belongs_to_session(const Message& message);

/// Writes a session as it goes on. What is written stays readable if the server is killed.
class SessionWriter {
 public:
  /// A session has no more bytes than this.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30u;

  /// Makes the file, or makes it anew. Fails where that cannot be.
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

/// All entries of a file. One that is cut short at its end is of a server that was killed, and left
/// out. Fails on files that are missing, of another kind or version, and on entries that no server
/// wrote.
Expected<std::vector<SessionEntry>> read_session(const std::string& path);

}  // namespace lambent::stream
