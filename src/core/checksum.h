// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lambent {

/// The CRC-32 of zlib, PNG and Ethernet. `before` is the checksum of the preceding bytes; 0: there
/// are none.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace lambent
