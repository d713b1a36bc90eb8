// SPDX-License-Identifier: Apache-2.0
#include "core/checksum.h"

#if LAMBENT_CPU
#include <zlib.h>
#else
#include <array>
#endif

namespace lambent {

#if LAMBENT_CPU

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
  // zlib restarts the checksum when it gets a null pointer
  if (bytes.empty()) return before;
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

#else

// Without zlib: a table of remainders, byte by byte (ISO 3309, polynomial 0x04C11DB7, bits
// reversed).
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
  static constexpr std::uint32_t kReversedPolynomial = 0xEDB88320u;
  static constexpr auto kRemainders = [] {
    std::array<std::uint32_t, 256> remainders{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      std::uint32_t r = byte;
      for (int bit = 0; bit < 8; ++bit) r = (r >> 1) ^ ((r & 1u) != 0 ? kReversedPolynomial : 0u);
      remainders[byte] = r;
    }
    return remainders;
  }();
  std::uint32_t crc = ~before;
  for (const std::byte byte : bytes) {
    crc = (crc >> 8) ^ kRemainders[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xFFu];
  }
  return ~crc;
}

#endif

}  // namespace lambent
