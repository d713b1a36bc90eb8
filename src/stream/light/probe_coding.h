// SPDX-License-Identifier: Apache-2.0
// Records of probes in messages of geometry: states, offsets and tiles of distances.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "stream/coding/bit_models.h"
#include "stream/coding/signed_number.h"
#include "stream/light/geometry.h"

namespace lambent::stream {

/// Models of probes' records. The context of a texel's number is how much the neighbouring texels
/// differ from one another.
struct ProbeModels {
  static constexpr int kActivities = 5, kStateBits = 3;
  using Number = SignedNumberModels;
  std::array<BitModel, 2> changed;
  std::array<BitModel, 1 << kStateBits> state;
  BitModel centred, blank;
  std::array<std::array<Number, kActivities>, 2> numbers;  // of means, and of deviations
};

/// The prediction of a number from those to its left, above, and above left (the median edge
/// detector of LOCO-I: Weinberger et al., "The LOCO-I Lossless Image Compression Algorithm", IEEE
/// Transactions on Image Processing 9(8), 2000).
inline int expected_number(int left, int above, int corner) {
  const auto [low, high] = std::minmax(left, above);
  return std::clamp(left + above - corner, low, high);
}

inline int activity_of(int left, int above, int corner) {
  const int sum = std::abs(left - corner) + std::abs(above - corner);
  return sum == 0 ? 0 : sum <= 2 ? 1 : sum <= 5 ? 2 : sum <= 12 ? 3 : 4;
}

/// Codes one number of each texel of a tile, as the difference from that of `before`. Returns
/// whether all are within 0 to `most`.
template <class Coder>
bool code_tile(Coder& coder, std::array<ProbeModels::Number, ProbeModels::kActivities>& models,
               std::uint8_t CodedMoments::*number, int edge, int most,
               std::span<const CodedMoments> before, std::span<CodedMoments> tile) {
  const auto difference = [&](int x, int y) {
    if (x < 0 || y < 0) return 0;
    const std::size_t t = static_cast<std::size_t>(y) * edge + x;
    return int{tile[t].*number} - int{before[t].*number};
  };
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const int left = x > 0 ? difference(x - 1, y) : difference(x, y - 1);
      const int above = y > 0 ? difference(x, y - 1) : left;
      const int corner = x > 0 && y > 0 ? difference(x - 1, y - 1) : left;
      const int expected = expected_number(left, above, corner);
      const std::size_t t = static_cast<std::size_t>(y) * edge + x;
      const int coded = code_signed(coder, models[activity_of(left, above, corner)],
                                    Coder::kWrites ? difference(x, y) - expected : 0);
      const int value = before[t].*number + expected + coded;
      if (value < 0 || value > most) return false;
      tile[t].*number = static_cast<std::uint8_t>(value);
    }
  }
  return true;
}

/// Codes a probe's record: its state, offset and distances, the latter as differences from
/// `before`, which may be blank. Returns false on data that no encoder wrote.
template <class Coder>
bool code_probe(Coder& coder, ProbeModels& models, int probe, std::span<const CodedMoments> before,
                FieldGeometry& geometry) {
  int state = Coder::kWrites ? static_cast<int>(geometry.states[probe]) : 0, node = 1;
  for (int bit = ProbeModels::kStateBits - 1; bit >= 0; --bit) {
    node = 2 * node + (code_bit(coder, models.state[node], (state >> bit & 1) != 0) ? 1 : 0);
  }
  state = node - (1 << ProbeModels::kStateBits);
  if (state > static_cast<int>(ProbeState::vigilant)) return false;
  geometry.states[probe] = static_cast<ProbeState>(state);

  std::uint32_t& offset = geometry.offsets[probe];
  if (code_bit(coder, models.centred, offset == 0)) {
    offset = 0;
  } else {
    offset = coder.bits(3 * kOffsetBits, offset);
    if (encode_probe_offset(decode_probe_offset(offset)) != offset) return false;
  }
  const std::span tile(&geometry.moments[probe * geometry.tile()], geometry.tile());
  const bool is_blank = std::all_of(tile.begin(), tile.end(), [](const CodedMoments& moments) {
    return moments == CodedMoments{};
  });
  if (code_bit(coder, models.blank, is_blank)) {
    std::fill(tile.begin(), tile.end(), CodedMoments{});
    return true;
  }
  const int edge = geometry.distance_texels;
  return code_tile(coder, models.numbers[0], &CodedMoments::mean, edge, CodedMoments::kMaxMean,
                   before, tile) &&
         code_tile(coder, models.numbers[1], &CodedMoments::deviation, edge,
                   CodedMoments::kMaxDeviation, before, tile);
}

}  // namespace lambent::stream
