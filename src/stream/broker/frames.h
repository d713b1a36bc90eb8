// SPDX-License-Identifier: Apache-2.0
// Messages as frames for a broker: a message that is too long for one frame is split into several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lambent::stream {

/// The subjects of a name.
inline std::string light_subject(const std::string& name) {
  return "lambent." + name + ".light";
}
inline std::string join_subject(const std::string& name) {
  return "lambent." + name + ".join";
}

// A frame's header: session, part, number of parts, and the message's sequence number.
inline constexpr std::size_t kFrameHeaderBytes = 20;
// A message has this many frames at most.
inline constexpr std::uint32_t kMaxFrames = 65'536;

/// Splits a message into frames of at most `most_bytes` each. Sequence numbers count the messages
/// of a session, whose number is random for each start, or of an answer to a request to join.
std::vector<std::vector<std::byte>> write_frames(std::span<const std::byte> message,
                                                 std::uint32_t session, std::uint64_t sequence,
                                                 std::size_t most_bytes);

/// A message reassembled from frames.
struct FramedMessage {
  std::uint32_t session = 0;
  std::uint64_t sequence = 0;
  std::vector<std::byte> bytes;
};

/// Reassembles messages. Broken and incomplete messages are dropped, like those that a broker lost;
/// sequence numbers show the gap.
class FrameReader {
 public:
  /// Messages of more than `most_bytes` are dropped.
  explicit FrameReader(std::size_t most_bytes) : most_bytes_(most_bytes) {}
  /// The message that a frame completes, if any.
  std::optional<FramedMessage> add(std::span<const std::byte> frame);

 private:
  std::size_t most_bytes_;
  std::optional<FramedMessage> begun_;
  std::uint32_t next_part_ = 0, parts_ = 0;
};

}  // namespace lambent::stream
