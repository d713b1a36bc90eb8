// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "stream/coding/bit_models.h"

namespace lambent::stream {

/// Models of a signed number that is mostly small.
struct SignedNumberModels {
  static constexpr int kPrefix = 10;
  BitModel nonzero, negative;
  std::array<BitModel, kPrefix> size;
};

/// Codes a number within -65,536 to 65,536. Corrupt input decodes to a number in this range, too.
template <class Coder>
int code_signed(Coder& coder, SignedNumberModels& models, int value) {
  if (!code_bit(coder, models.nonzero, value != 0)) return 0;
  const bool negative = code_bit(coder, models.negative, value < 0);
  const auto rest = Coder::kWrites ? static_cast<std::uint32_t>(std::abs(value) - 1) : 0u;
  const std::uint32_t coded = std::min(code_exp_golomb(coder, models.size, rest), 0xFFFFu);
  return negative ? -static_cast<int>(coded) - 1 : static_cast<int>(coded) + 1;
}

}  // namespace lambent::stream
