// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups, as a light stream tells them: of each cell how many samples it rests on,
// how many of these are trusted, and the ratio that they found.
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

/// Blocks are sent in pieces of so many, the last of fewer: some 70 kB each.
inline constexpr std::size_t kPieceBlocks = 14'336;
/// A piece has at most so many bytes for each of its blocks, and kMostBlockBytes more. Ten times
/// what most take.
inline constexpr std::size_t kMostBlockBytes = 64;

inline std::size_t correction_pieces(std::size_t blocks) {
  return (blocks + kPieceBlocks - 1) / kPieceBlocks;
}

/// Writes one piece of all blocks.
std::vector<std::byte> write_corrections(std::size_t piece,
                                         std::span<const CodedCorrectionBlock> blocks);

/// All pieces. An empty one is to be coded, or is not here.
using CorrectionPieces = std::vector<std::vector<std::byte>>;
/// Codes the pieces that are to be coded.
void write_pieces(std::span<const CodedCorrectionBlock> blocks, CorrectionPieces& pieces);
/// Messages of those pieces that are there, sent after an update.
std::vector<LightMessage> correction_messages(std::uint32_t stream, std::uint64_t update,
                                              std::uint64_t number, const CorrectionPieces& pieces);

/// Reads a piece of as many blocks as there are in all, of a field of so many volumes, and returns
/// which it is. Fails on what no encoder wrote, and leaves the blocks as they were.
Expected<std::size_t> read_corrections(std::span<const std::byte> body, std::uint32_t volumes,
                                       std::span<CodedCorrectionBlock> blocks);

}  // namespace lambent::stream
