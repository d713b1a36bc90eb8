// SPDX-License-Identifier: Apache-2.0
#include "stream/broker/frames.h"

#include <algorithm>
#include <utility>

#include "core/little_endian.h"

namespace lambent::stream {

std::vector<std::vector<std::byte>> write_frames(std::span<const std::byte> message,
                                                 std::uint32_t session, std::uint64_t sequence,
                                                 std::size_t most_bytes) {
  const std::size_t part_bytes = most_bytes - kFrameHeaderBytes;
  const std::size_t parts =
      std::max<std::size_t>(1, (message.size() + part_bytes - 1) / part_bytes);
  std::vector<std::vector<std::byte>> frames;
  for (std::size_t part = 0; part < parts; ++part) {
    ByteWriter out;
    out.u32(session);
    out.u32(static_cast<std::uint32_t>(part));
    out.u32(static_cast<std::uint32_t>(parts));
    out.u64(sequence);
    const std::size_t begin = part * part_bytes;
    out.raw(message.subspan(begin, std::min(part_bytes, message.size() - begin)));
    frames.push_back(out.take());
  }
  return frames;
}

std::optional<FramedMessage> FrameReader::add(std::span<const std::byte> frame) {
  if (frame.size() < kFrameHeaderBytes) return std::nullopt;
  ByteReader in(frame);
  FramedMessage message;
  message.session = in.u32();
  const std::uint32_t part = in.u32(), parts = in.u32();
  message.sequence = in.u64();
  if (part == 0) {
    begun_ = std::move(message);
    next_part_ = 0;
    parts_ = parts;
  }
  const std::span<const std::byte> rest = frame.subspan(kFrameHeaderBytes);
  const bool fits = begun_ && part == next_part_ && parts == parts_ && part < parts &&
                    parts <= kMaxFrames && begun_->bytes.size() + rest.size() <= most_bytes_;
  const bool same =
      fits &&
      (part == 0 || (message.session == begun_->session && message.sequence == begun_->sequence));
  if (!same) {
    begun_.reset();
    return std::nullopt;
  }
  begun_->bytes.insert(begun_->bytes.end(), rest.begin(), rest.end());
  if (++next_part_ < parts_) return std::nullopt;
  return std::exchange(begun_, std::nullopt);
}

}  // namespace lambent::stream
