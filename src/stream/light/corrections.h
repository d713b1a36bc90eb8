// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups, as a light stream tells them: of each cell how many samples it rests on,
// how many of these are trusted, and the ratio that they found.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "field/correction/correction_table.h"
#include "stream/coding/range_coder.h"

namespace lambent::stream {

/// A cell in three numbers.
struct CodedCorrection {
  static constexpr int kSampleBits = 6, kRatioBits = 8, kDoubtBits = 4;

  std::uint8_t samples = 0;  ///< 0: none. Else 2^((n - 1) / 4 - 6).
  std::uint8_t ratio = 0;    ///< Gathered over looked up: 0, or 2^((n - 128) / 48).
  std::uint8_t doubt = 0;    ///< So many of the samples are trusted: 2^(-n / 2).

  bool operator==(const CodedCorrection&) const = default;
};

struct CodedCorrectionBlock {
  CorrectionKey key{};
  std::array<CodedCorrection, kCellCorners> cells;
};

/// Blocks as they are sent, in an order of their own, and back.
std::vector<CodedCorrectionBlock> encode_corrections(std::span<const CorrectionBlock> blocks);
std::vector<CorrectionBlock> decode_corrections(std::span<const CodedCorrectionBlock> blocks);

/// Writes blocks.
void write_corrections(RangeEncoder& coder, std::span<const CodedCorrectionBlock> blocks);

/// Reads as many blocks as there are, of a field of so many volumes. Returns false on what no
/// encoder wrote.
bool read_corrections(RangeDecoder& coder, std::uint32_t volumes,
                      std::span<CodedCorrectionBlock> blocks);

}  // namespace lambent::stream
