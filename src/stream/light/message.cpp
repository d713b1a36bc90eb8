// SPDX-License-Identifier: Apache-2.0
#include "stream/light/message.h"

#include <algorithm>

#include "core/checksum.h"
#include "core/little_endian.h"

namespace lambent::stream {

tl::unexpected<Error> bad_stream(const std::string& place, const std::string& cause) {
  return fail("light stream", place, cause);
}

LightMessage make_message(const MessageHeader& header, std::span<const std::byte> body) {
  ByteWriter out;
  out.u32(kLightMagic);
  out.u32(kLightVersion | static_cast<std::uint32_t>(header.kind) << 16u);
  out.u32(0);  // replaced by the checksum
  out.u32(header.stream);
  out.u64(header.update);
  out.u64(header.geometry);
  out.raw(body);
  LightMessage message{header.kind, header.update, out.take()};
  seal_message(message.bytes);
  return message;
}

std::vector<std::byte> geometry_body(std::uint64_t base, std::span<const std::byte> coded) {
  ByteWriter out;
  out.u64(base);
  out.raw(coded);
  return out.take();
}

void seal_message(std::span<std::byte> bytes) {
  if (bytes.size() < kMessageHeaderBytes) return;
  ByteWriter checksum;
  checksum.u32(crc32_of(bytes.subspan(kMessageCheckedOffset)));
  std::copy(checksum.bytes().begin(), checksum.bytes().end(),
            bytes.begin() + kMessageChecksumOffset);
}

Expected<OpenedMessage> open_message(std::span<const std::byte> bytes) {
  if (bytes.size() < kMessageHeaderBytes) return bad_stream("", "a message is cut short");
  ByteReader in(bytes);
  if (in.u32() != kLightMagic) return bad_stream("", "what came is no message of one");
  const std::uint32_t version_and_kind = in.u32();
  const std::uint32_t version = version_and_kind & 0xFFFFu, kind = version_and_kind >> 16u;
  if (version != kLightVersion) {
    return bad_stream("", "is of version " + std::to_string(version) + "; version " +
                              std::to_string(kLightVersion) + " can be read");
  }
  if (in.u32() != crc32_of(bytes.subspan(kMessageCheckedOffset))) {
    return bad_stream("", "a message is broken: its checksum does not match what it holds");
  }
  if (kind < static_cast<std::uint32_t>(LightMessageKind::geometry) ||
      kind > static_cast<std::uint32_t>(LightMessageKind::corrections)) {
    return bad_stream("", "holds a message of an unknown kind, " + std::to_string(kind));
  }
  OpenedMessage message;
  message.header.kind = static_cast<LightMessageKind>(kind);
  message.header.stream = in.u32();
  message.header.update = in.u64();
  message.header.geometry = in.u64();
  message.body = bytes.subspan(kMessageHeaderBytes);
  if (message.header.update == 0) {
    return bad_stream("", "holds a message of an update that there cannot be");
  }
  return message;
}

}  // namespace lambent::stream
