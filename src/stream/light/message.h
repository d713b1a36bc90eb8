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
inline constexpr std::size_t kMessageCheckedOffset = 12;  // the checksum is of all from here on
inline constexpr std::size_t kMessageHeaderBytes = 32;

struct MessageHeader {
  LightMessageKind kind = LightMessageKind::delta;
  std::uint32_t stream = 0;
  std::uint64_t update = 0;    ///< From 1.
  std::uint64_t geometry = 0;  ///< geometry_number() of the geometry that it is of.
};

/// The number of the geometry that came to be in an update of a stream, unlike that of any other.
inline std::uint64_t geometry_number(std::uint32_t stream, std::uint64_t update) {
  return std::uint64_t{stream} << 32u | (update & 0xFFFFFFFFu);
}

struct OpenedMessage {
  MessageHeader header;
  std::span<const std::byte> body;
};

/// A message of this body.
LightMessage make_message(const MessageHeader& header, std::span<const std::byte> body);

/// The body of a message of geometry: what it changes (0: nothing, it is whole), and the coded
/// rest.
std::vector<std::byte> geometry_body(std::uint64_t base, std::span<const std::byte> coded);

/// Writes the checksum of a message into its header, where it has one.
void seal_message(std::span<std::byte> bytes);

/// The parts of a message. Fails on what is no message, cut short, or broken.
Expected<OpenedMessage> open_message(std::span<const std::byte> bytes);

/// An error that says what of the stream it is about.
tl::unexpected<Error> bad_stream(const std::string& place, const std::string& cause);

}  // namespace lambent::stream
