// SPDX-License-Identifier: Apache-2.0
// Based on: M. Mahoney, "Adaptive Weighing of Context Models for Lossless Data Compression",
// Florida Tech. Technical Report CS-2005-16, 2005: the predictions of several contexts for a binary
// decision are mixed in the logistic domain, with adaptive weights. Integers only, like the coder.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "stream/coding/range_coder.h"

namespace lambent::stream {

/// An adaptive model of one kind of binary decision: its probability is the mean of two estimates,
/// one of which adapts fast and one slowly.
struct BitModel {
  // From these numbers of decisions on, the estimates are averages over about the last 16 and 180.
  static constexpr std::uint8_t kFastCount = 16, kSlowCount = 180;

  std::uint16_t fast = kProbabilityOne / 2;  ///< Probabilities of a 1, out of kProbabilityOne.
  std::uint16_t slow = kProbabilityOne / 2;
  std::uint8_t count = 0;  ///< Decisions so far, up to kSlowCount.

  bool operator==(const BitModel&) const = default;

  std::uint32_t probability() const { return (std::uint32_t{fast} + slow) / 2; }
  void update(bool bit) {
    fast = moved(fast, bit, std::min(count, kFastCount));
    slow = moved(slow, bit, count);
    if (count < kSlowCount) ++count;
  }

 private:
  /// The estimate after one more decision, which has the weight 1 / (count + 1.5).
  static std::uint16_t moved(std::uint16_t estimate, bool bit, std::uint8_t count) {
    static constexpr auto kShares = [] {
      std::array<std::int32_t, kSlowCount + 1> shares{};
      for (int n = 0; n <= kSlowCount; ++n) {
        shares[n] = static_cast<int>(2 * kProbabilityOne) / (2 * n + 3);
      }
      return shares;
    }();
    const std::int64_t target = bit ? kProbabilityOne - 1 : 0;
    return static_cast<std::uint16_t>(estimate +
                                      (target - estimate) * kShares[count] / kProbabilityOne);
  }
};

// Least probability of a decision, so that an unexpected one costs at most 11 bits.
inline constexpr std::uint32_t kLeastProbability = 32;

inline std::uint32_t coded_probability(std::uint32_t probability) {
  return std::clamp(probability, kLeastProbability, kProbabilityOne - kLeastProbability);
}

/// Codes a decision: writes it, or reads it and ignores `value`. Returns it.
template <class Coder>
bool code_bit(Coder& coder, BitModel& model, bool value) {
  const bool coded = coder.bit(coded_probability(model.probability()), value);
  model.update(coded);
  return coded;
}

// Log odds are numbers of 8 fractional bits, within -2047 to 2047.
inline constexpr int kMaxLogOdds = 2047;

// 65536 / (1 + exp(-i / 2)) for i of -16 to 16.
inline constexpr std::array<std::int32_t, 33> kLogistic = {
    22,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,  3108,
    4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565,
    62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514};

/// The probability of log odds: 65536 / (1 + exp(-x / 256)), interpolated between those 33.
constexpr std::uint32_t probability_of(int log_odds) {
  constexpr int kBetween = 128;
  const int shifted = std::clamp(log_odds, -kMaxLogOdds, kMaxLogOdds) + kMaxLogOdds + 1;
  const int below = shifted / kBetween, rest = shifted % kBetween;
  return static_cast<std::uint32_t>(
      (kLogistic[below] * (kBetween - rest) + kLogistic[below + 1] * rest) / kBetween);
}

// The table of log odds is for probabilities rounded down to multiples of 2^kLogOddsShift.
inline constexpr int kLogOddsShift = 4;

/// Log odds by probability: the least whose probability is no lower.
inline constexpr auto kLogOdds = [] {
  std::array<std::int16_t, (kProbabilityOne >> kLogOddsShift)> table{};
  int x = -kMaxLogOdds;
  for (std::uint32_t p = 0; p < table.size(); ++p) {
    while (x < kMaxLogOdds && probability_of(x) < (p << kLogOddsShift)) ++x;
    table[p] = static_cast<std::int16_t>(x);
  }
  return table;
}();

/// The log odds of a probability.
inline int log_odds_of(std::uint32_t probability) {
  return kLogOdds[probability >> kLogOddsShift];
}

// Weights have 16 fractional bits, and are within these.
inline constexpr std::int32_t kMixWeightOne = 1 << 16, kMaxMixWeight = 8 * kMixWeightOne;

/// Weights of the predictions of several models.
template <std::size_t Count>
struct MixWeights {
  // Each weight begins slightly above 1 / Count.
  static constexpr std::int32_t kStart = kMixWeightOne * 4 / 3 / static_cast<int>(Count);
  // Learning rate of weights: with 14 to 16, the size of a stream differs by less than a
  // thousandth.
  static constexpr int kRateShift = 15;

  std::array<std::int32_t, Count> weights = [] {
    std::array<std::int32_t, Count> start;
    start.fill(kStart);
    return start;
  }();

  bool operator==(const MixWeights&) const = default;
};

/// Codes a decision with the mixed predictions of several models.
template <class Coder, std::size_t Count>
bool code_mixed(Coder& coder, MixWeights<Count>& mix, const std::array<BitModel*, Count>& models,
                bool value) {
  std::array<int, Count> odds;
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < Count; ++i) {
    odds[i] = log_odds_of(models[i]->probability());
    sum += std::int64_t{mix.weights[i]} * odds[i];
  }
  const auto mixed =
      static_cast<int>(std::clamp<std::int64_t>(sum / kMixWeightOne, -kMaxLogOdds, kMaxLogOdds));
  const std::uint32_t probability = coded_probability(probability_of(mixed));
  const bool coded = coder.bit(probability, value);
  const std::int32_t error =
      (coded ? static_cast<std::int32_t>(kProbabilityOne) : 0) - static_cast<int>(probability);
  for (std::size_t i = 0; i < Count; ++i) {
    const std::int32_t step = odds[i] * (error / 4) / (1 << MixWeights<Count>::kRateShift);
    mix.weights[i] = std::clamp(mix.weights[i] + step, -kMaxMixWeight, kMaxMixWeight);
    models[i]->update(coded);
  }
  return coded;
}

/// Codes a number, 0 or more, of any size: a unary prefix with a model for each of its bits, which
/// counts the bits that follow (exponential Golomb code of order 0). Returns it; decoded numbers
/// are clamped to 2^31 - 2.
template <class Coder, std::size_t Length>
std::uint32_t code_exp_golomb(Coder& coder, std::array<BitModel, Length>& models,
                              std::uint32_t value) {
  constexpr int kMaxBits = 30;
  const int wanted = Coder::kWrites ? std::bit_width(value + 1) - 1 : 0;
  int bits = 0;
  while (bits < kMaxBits &&
         code_bit(coder, models[std::min<std::size_t>(bits, Length - 1)], bits < wanted)) {
    ++bits;
  }
  const std::uint32_t rest = coder.bits(bits, value + 1 - (1u << bits));
  return (1u << bits) - 1 + rest;
}

}  // namespace lambent::stream
