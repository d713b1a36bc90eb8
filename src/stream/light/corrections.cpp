// SPDX-License-Identifier: Apache-2.0
#include "stream/light/corrections.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <tuple>

#include "core/little_endian.h"
#include "stream/coding/bit_models.h"
#include "stream/coding/range_coder.h"
#include "stream/coding/signed_number.h"
#include "stream/light/message.h"
#include "stream/light/on_all_cores.h"

namespace lambent::stream {
namespace {

// Numbers of CodedCorrection: steps per octave, and the number that represents 1.
constexpr float kSampleSteps = 4.0f, kSampleOne = 25.0f;
constexpr float kRatioSteps = 48.0f, kRatioOne = 128.0f;
constexpr float kDoubtSteps = 2.0f;

std::uint8_t nearest(float number, int least, int bits) {
  // Written so that NaN becomes the lowest
  const auto most = static_cast<float>((1 << bits) - 1);
  const float low = static_cast<float>(least);
  return static_cast<std::uint8_t>(number > low ? std::min(number, most) + 0.5f : low);
}

CodedCorrection encode_cell(const LearnedCorrection& cell) {
  CodedCorrection coded;
  if (!(cell.samples > 0.0f)) return coded;
  coded.samples =
      nearest(kSampleOne + kSampleSteps * std::log2(cell.samples), 1, CodedCorrection::kSampleBits);
  if (!(cell.looked_up > 0.0f)) {
    coded.doubt = (1 << CodedCorrection::kDoubtBits) - 1;
    return coded;
  }
  coded.ratio = nearest(kRatioOne + kRatioSteps * std::log2(cell.gathered / cell.looked_up), 0,
                        CodedCorrection::kRatioBits);
  coded.doubt = nearest(kDoubtSteps * std::log2(cell.samples / (kTrustedLookup * cell.looked_up)),
                        0, CodedCorrection::kDoubtBits);
  return coded;
}

LearnedCorrection decode_cell(const CodedCorrection& coded) {
  if (coded.samples == 0) return {0.0f, 0.0f, 0.0f};
  const float samples = std::exp2((static_cast<float>(coded.samples) - kSampleOne) / kSampleSteps);
  const float looked_up =
      samples / kTrustedLookup * std::exp2(-static_cast<float>(coded.doubt) / kDoubtSteps);
  const float ratio = coded.ratio == 0
                          ? 0.0f
                          : std::exp2((static_cast<float>(coded.ratio) - kRatioOne) / kRatioSteps);
  return {ratio * looked_up, looked_up, samples};
}

// The key of a block: `kind` has the direction that its surfaces face, its level and its volume;
// `zyx` its coordinates, in the order in which they are coded.
struct Place {
  std::uint32_t kind;
  std::array<int, 3> zyx;  // -32,768 to 32,767 each
};

Place place_of(const CorrectionKey& key) {
  const ivec3 at = block_of_key(key);
  return {key.rest >> kCorrectionKeyBits, {at.z, at.y, at.x}};
}

struct BlockModels {
  static constexpr int kKindBits = 16;
  BitModel same_kind;
  // Models of a coordinate, by whether the preceding ones equal those of the block before
  std::array<std::array<SignedNumberModels, 2>, 3> coordinates;
  std::array<std::array<BitModel, 1 << CodedCorrection::kSampleBits>, 2> samples;
  std::array<BitModel, 1 << CodedCorrection::kDoubtBits> doubt;
  SignedNumberModels ratio;
};

/// Codes a number bit by bit, the highest first; the models form a binary tree.
template <class Coder, std::size_t Size>
std::uint8_t code_tree(Coder& coder, std::array<BitModel, Size>& models, std::uint8_t value) {
  constexpr int kBits = std::bit_width(Size) - 1;
  unsigned node = 1;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    node = 2 * node + (code_bit(coder, models[node], (value >> bit & 1) != 0) ? 1 : 0);
  }
  return static_cast<std::uint8_t>(node - Size);
}

/// Codes the cells of a block. Returns false on data that no encoder wrote.
template <class Coder>
bool code_cells(Coder& coder, BlockModels& models, CodedCorrectionBlock& block) {
  int expected = static_cast<int>(kRatioOne);
  bool last = false;
  for (CodedCorrection& cell : block.cells) {
    cell.samples = code_tree(coder, models.samples[last ? 1 : 0], cell.samples);
    last = cell.samples > 0;
    if (!last) continue;
    cell.doubt = code_tree(coder, models.doubt, cell.doubt);
    const int ratio = expected + code_signed(coder, models.ratio, cell.ratio - expected);
    if (ratio < 0 || ratio >= 1 << CodedCorrection::kRatioBits) return false;
    cell.ratio = static_cast<std::uint8_t>(ratio);
    expected = ratio;
  }
  return true;
}

/// Codes a block relative to the one at `before`, and sets `before` to its place.
template <class Coder>
bool code_block(Coder& coder, BlockModels& models, Place& before, CodedCorrectionBlock& block) {
  Place place = place_of(block.key);
  bool same = code_bit(coder, models.same_kind, place.kind == before.kind);
  if (same) {
    place.kind = before.kind;
  } else {
    place.kind = coder.bits(BlockModels::kKindBits, place.kind);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int step = code_signed(coder, models.coordinates[axis][same ? 1 : 0],
                                 place.zyx[axis] - before.zyx[axis]);
    same = same && step == 0;
    place.zyx[axis] = before.zyx[axis] + step;
    if (place.zyx[axis] < -0x8000 || place.zyx[axis] > 0x7FFF) return false;
  }
  before = place;
  const auto low = [](int number) { return static_cast<std::uint32_t>(number) & 0xFFFFu; };
  block.key = {low(place.zyx[2]) | low(place.zyx[1]) << kCorrectionKeyBits,
               low(place.zyx[0]) | place.kind << kCorrectionKeyBits};
  return code_cells(coder, models, block);
}

/// The blocks of a piece.
template <class Block>
std::span<Block> piece_of(std::size_t piece, std::span<Block> blocks) {
  const std::size_t first = piece * kPieceBlocks;
  return blocks.subspan(first, std::min(kPieceBlocks, blocks.size() - first));
}

}  // namespace

std::vector<CodedCorrectionBlock> encode_corrections(std::span<const CorrectionBlock> blocks) {
  std::vector<CodedCorrectionBlock> coded;
  for (const CorrectionBlock& block : blocks) {
    CodedCorrectionBlock& made = coded.emplace_back();
    made.key = block.key;
    std::transform(block.cells.begin(), block.cells.end(), made.cells.begin(), encode_cell);
  }
  const auto order = [](const CodedCorrectionBlock& block) {
    const Place place = place_of(block.key);
    return std::tuple(place.kind, place.zyx);
  };
  std::sort(coded.begin(), coded.end(),
            [&](const auto& a, const auto& b) { return order(a) < order(b); });
  return coded;
}

std::vector<CorrectionBlock> decode_corrections(std::span<const CodedCorrectionBlock> blocks) {
  std::vector<CorrectionBlock> decoded;
  for (const CodedCorrectionBlock& block : blocks) {
    CorrectionBlock& made = decoded.emplace_back();
    made.key = block.key;
    std::transform(block.cells.begin(), block.cells.end(), made.cells.begin(), decode_cell);
  }
  return decoded;
}

std::vector<std::byte> write_corrections(std::size_t piece,
                                         std::span<const CodedCorrectionBlock> blocks) {
  ByteWriter out;
  out.u32(static_cast<std::uint32_t>(piece));
  RangeEncoder coder;
  BlockModels models;
  Place place{};
  for (CodedCorrectionBlock block : piece_of(piece, blocks)) {
    code_block(coder, models, place, block);
  }
  out.raw(coder.finish());
  return out.take();
}

void write_pieces(std::span<const CodedCorrectionBlock> blocks, CorrectionPieces& pieces) {
  pieces.resize(correction_pieces(blocks.size()));
  on_all_cores(pieces.size(), [&](std::size_t piece) {
    if (pieces[piece].empty()) pieces[piece] = write_corrections(piece, blocks);
  });
}

std::vector<LightMessage> correction_messages(std::uint32_t stream, std::uint64_t update,
                                              std::uint64_t number,
                                              const CorrectionPieces& pieces) {
  std::vector<LightMessage> messages;
  for (const std::vector<std::byte>& piece : pieces) {
    if (piece.empty()) continue;
    messages.push_back(
        make_message({LightMessageKind::corrections, stream, update, number}, piece));
  }
  return messages;
}

Expected<std::size_t> read_corrections(std::span<const std::byte> body, std::uint32_t volumes,
                                       std::span<CodedCorrectionBlock> blocks) {
  if (body.size() < sizeof(std::uint32_t)) return bad_stream("corrections", "are cut short");
  const std::size_t piece = ByteReader(body).u32();
  if (piece >= correction_pieces(blocks.size())) {
    return bad_stream("corrections", "have no piece " + std::to_string(piece));
  }
  const std::span<CodedCorrectionBlock> own = piece_of(piece, blocks);
  if (body.size() > kMostBlockBytes * (own.size() + 1)) {
    return bad_stream("corrections", "take more than they can");
  }
  std::vector<CodedCorrectionBlock> read(own.size());
  RangeDecoder coder(body.subspan(sizeof(std::uint32_t)));
  BlockModels models;
  Place place{};
  for (CodedCorrectionBlock& block : read) {
    if (!code_block(coder, models, place, block) || coder.overrun() ||
        !is_block_key(block.key, volumes)) {
      return bad_stream("corrections", "make no sense");
    }
  }
  if (coder.left() > 0) return bad_stream("corrections", "go on after their end");
  std::copy(read.begin(), read.end(), own.begin());
  return piece;
}

}  // namespace lambent::stream
