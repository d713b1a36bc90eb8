// SPDX-License-Identifier: Apache-2.0
// Lookup corrections in a light stream: for each cell the number of its samples, how many of these
// are trusted, and the mean ratio.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/correction/correction_table.h"
#include "lambent/error.h"
#include "lambent/stream.h"

namespace lambent::stream {

/// A cell in three numbers.
struct CodedCorrection {
  static constexpr int kSampleBits = 6, kRatioBits = 8, kDoubtBits = 4;

  std::uint8_t samples = 0;  ///< 0: none. Else 2^((n - 1) / 4 - 6) samples.
  std::uint8_t ratio = 0;    ///< Gathered over looked up: 0, or 2^((n - 128) / 48).
  std::uint8_t doubt = 0;    ///< Trusted share of the samples: 2^(-n / 2).

  bool operator==(const CodedCorrection&) const = default;
};

struct CodedCorrectionBlock {
  CorrectionKey key{};
  std::array<CodedCorrection, kCellCorners> cells;
};

/// Convert blocks to the coded form, in the order of coding, and back.
std::vector<CodedCorrectionBlock> encode_corrections(std::span<const CorrectionBlock> blocks);
std::vector<CorrectionBlock> decode_corrections(std::span<const CodedCorrectionBlock> blocks);

/// Number of blocks in a piece, except the last: some 70 kB each.
inline constexpr std::size_t kPieceBlocks = 14'336;
/// A piece has at most this many bytes per block, and kMostBlockBytes more; ten times the usual
/// size.
inline constexpr std::size_t kMostBlockBytes = 64;

inline std::size_t correction_pieces(std::size_t blocks) {
  return (blocks + kPieceBlocks - 1) / kPieceBlocks;
}

/// Codes piece number `piece` of all blocks.
std::vector<std::byte> write_corrections(std::size_t piece,
                                         std::span<const CodedCorrectionBlock> blocks);

/// All pieces. An empty one is not coded yet, or was not received.
using CorrectionPieces = std::vector<std::vector<std::byte>>;
/// Codes the empty pieces.
void write_pieces(std::span<const CodedCorrectionBlock> blocks, CorrectionPieces& pieces);
/// Messages of the pieces that are not empty, sent after an update.
std::vector<LightMessage> correction_messages(std::uint32_t stream, std::uint64_t update,
                                              std::uint64_t number, const CorrectionPieces& pieces);

/// Reads a piece into `blocks`, which has all blocks of a field with `volumes` volumes, and returns
/// its number. Fails on data that no encoder wrote, and then leaves the blocks unchanged.
Expected<std::size_t> read_corrections(std::span<const std::byte> body, std::uint32_t volumes,
                                       std::span<CodedCorrectionBlock> blocks);

}  // namespace lambent::stream
