// SPDX-License-Identifier: Apache-2.0
// Messages in frames that a broker takes: those that are too long for one are in several.
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

// Session, part, parts, and the message's sequence number.
inline constexpr std::size_t kFrameHeaderBytes = 20;
// A message has this many frames at most.
inline constexpr std::uint32_t kMaxFrames = 65'536;

/// A message as frames of at most so many bytes each. Sequence numbers count the messages of a
/// session, which is drawn anew with each start, or of an answer to a request to join.
std::vector<std::vector<std::byte>> write_frames(std::span<const std::byte> message,
                                                 std::uint32_t session, std::uint64_t sequence,
                                                 std::size_t most_bytes);

/// A message that frames brought.
struct FramedMessage {
  std::uint32_t session = 0;
  std::uint64_t sequence = 0;
  std::vector<std::byte> bytes;
};

/// Puts messages together. What is broken or incomplete is left out, as what a broker lost is:
/// sequence numbers tell.
class FrameReader {
 public:
  /// A message of more than `most_bytes` is left out.
  explicit FrameReader(std::size_t most_bytes) : most_bytes_(most_bytes) {}
  /// The message that a frame completes, if any.
  std::optional<FramedMessage> add(std::span<const std::byte> frame);

 private:
  std::size_t most_bytes_;
  std::optional<FramedMessage> begun_;
  std::uint32_t next_part_ = 0, parts_ = 0;
};

}  // namespace lambent::stream
