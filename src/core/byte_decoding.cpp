// SPDX-License-Identifier: Apache-2.0
#include "core/byte_decoding.h"

#include <cstddef>

#include "shared/color.h"

namespace lambent {
namespace {

constexpr float kMaxByte = 255.0f;

template <class Decode>
ByteDecoding make_table(Decode decode) {
  ByteDecoding table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = decode(static_cast<float>(i) / kMaxByte);
  }
  return table;
}

}  // namespace

const ByteDecoding& srgb_byte_decoding() {
  static const ByteDecoding table = make_table([](float v) { return linear_from_srgb(v); });
  return table;
}

const ByteDecoding& linear_byte_decoding() {
  static const ByteDecoding table = make_table([](float v) { return v; });
  return table;
}

}  // namespace lambent
