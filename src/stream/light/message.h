// SPDX-License-Identifier: Apache-2.0
// The frame around the messages of a light stream (docs/stream-light.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lambent/stream.h"

namespace lambent::stream {

inline constexpr std::uint32_t kLightMagic = 0x4C424D4Cu;  // "LMBL"
inline constexpr std::uint16_t kLightVersion = 2;

// Offsets and sizes [bytes].
inline constexpr std::size_t kMessageChecksumOffset = 8;
// the checksum covers all bytes from here on
inline constexpr std::size_t kMessageCheckedOffset = 12;
inline constexpr std::size_t kMessageHeaderBytes = 32;

struct MessageHeader {
  LightMessageKind kind = LightMessageKind::delta;
  std::uint32_t stream = 0;
  std::uint64_t update = 0;    ///< From 1.
  std::uint64_t geometry = 0;  ///< geometry_number() of the geometry to which it belongs.
};

/// The unique number of the geometry that appeared in an update of a stream.
inline std::uint64_t geometry_number(std::uint32_t stream, std::uint64_t update) {
  return std::uint64_t{stream} << 32u | (update & 0xFFFFFFFFu);
}

struct OpenedMessage {
  MessageHeader header;
  std::span<const std::byte> body;
};

/// Makes a message with this body.
LightMessage make_message(const MessageHeader& header, std::span<const std::byte> body);

/// The body of a geometry message: the number of the geometry that it changes (0: none, it is
/// whole), and the coded data.
std::vector<std::byte> geometry_body(std::uint64_t base, std::span<const std::byte> coded);

/// Writes the checksum of a message into its header, if the message has one.
void seal_message(std::span<std::byte> bytes);

/// Splits a message into its parts. Fails on bytes that are not a message, truncated, or broken.
Expected<OpenedMessage> open_message(std::span<const std::byte> bytes);

/// An error about a part of the stream.
tl::unexpected<Error> bad_stream(const std::string& place, const std::string& cause);

}  // namespace lambent::stream
