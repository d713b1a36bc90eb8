// SPDX-License-Identifier: Apache-2.0
// Tables that decode the 256 values of an 8-bit channel.
#pragma once

#include <array>

namespace lambent {

using ByteDecoding = std::array<float, 256>;

/// Linear light of sRGB-encoded bytes.
const ByteDecoding& srgb_byte_decoding();
/// Bytes as numbers from 0 to 1.
const ByteDecoding& linear_byte_decoding();

}  // namespace lambent
