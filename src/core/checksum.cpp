// SPDX-License-Identifier: Apache-2.0
#include "core/checksum.h"

#include <zlib.h>

namespace lambent {

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
  // zlib takes a null pointer for a wish to start anew
  if (bytes.empty()) return before;
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace lambent
