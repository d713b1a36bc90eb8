// SPDX-License-Identifier: Apache-2.0
// The probability models of levels, by context.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "stream/coding/bit_models.h"

namespace lambent::stream {

/// The models of levels. Each member is an array of models, indexed by the contexts in its comment.
struct LevelModels {
  static constexpr int kChannels = 3;
  static constexpr int kDegrees = 4;     // degrees from 3 on share their models
  static constexpr int kCounts = 4;      // values of a history
  static constexpr int kNear = 4;        // how many of three neighbours
  static constexpr int kSizes = 9;       // classes of a sum of magnitudes: size_class()
  static constexpr int kSigns = 3;       // the prevailing sign
  static constexpr int kFunctions = 17;  // functions from 16 on share their models
  static constexpr int kMagnitudes = 12;
  static constexpr int kActivities = 7;  // sums of three activities of 0 to 2
  static constexpr int kAfter = 3;

  template <std::size_t... Sizes>
  using Models = std::array<BitModel, (Sizes * ...)>;
  template <std::size_t Inputs, std::size_t... Sizes>
  using Mixes = std::array<MixWeights<Inputs>, (Sizes * ...)>;

  /// Whether a probe has any level, by the neighbours' activity, its history, and the history of
  /// the probes after it.
  Models<kActivities, kCounts, kAfter> coded;

  /// Whether a degree has any level: by channel and degree, its history, the neighbours and the
  /// first channel; and by channel and degree, the size of the levels before it, and the first
  /// channel.
  Models<kChannels, kDegrees, kCounts, kNear, 2> degree_by_history;
  Models<kChannels, kDegrees, kSizes, 2> degree_by_size;
  Mixes<2, kChannels, kDegrees> degree;

  /// Whether a level is not 0: by channel, function, history, and whether the first channel's is
  /// not 0; by channel, degree, the neighbours' size, and the size of the levels before it; by
  /// channel, degree, and which neighbours' levels are not 0.
  Models<kChannels, kFunctions, kCounts, 2> nonzero_by_function;
  Models<kChannels, kDegrees, kSizes, kSizes> nonzero_by_size;
  Models<kChannels, kDegrees, 8> nonzero_by_neighbours;
  Mixes<3, kChannels, kDegrees> nonzero;

  /// Whether a level is negative: by channel, degree, the neighbours' sign, and the first
  /// channel's; by channel, degree, and the size of the neighbours' sum.
  Models<kChannels, kDegrees, kSigns, kSigns> negative_by_sign;
  Models<kChannels, kDegrees, 2 * kSizes> negative_by_sum;
  Mixes<2, kChannels, kDegrees> negative;

  /// Whether a level is larger than the last index: by whether it is the first channel's, degree,
  /// and the neighbours' size; and by the same with the size of the levels before it.
  Models<2, kDegrees, kSizes, kMagnitudes> larger_by_neighbours;
  Models<2, kDegrees, kSizes, kMagnitudes> larger_by_size;
  Mixes<2, 2, kDegrees> larger;
  Models<kMagnitudes> escape;  ///< Magnitudes beyond kMagnitudes.

  bool operator==(const LevelModels&) const = default;

  /// Calls visit(model) for all models, in one order.
  template <class Self, class Visit>
  static void for_each(Self& self, Visit visit) {
    const auto all = [&](auto&... groups) {
      (std::for_each(groups.begin(), groups.end(), visit), ...);
    };
    all(self.coded, self.degree_by_history, self.degree_by_size, self.nonzero_by_function,
        self.nonzero_by_size, self.nonzero_by_neighbours, self.negative_by_sign,
        self.negative_by_sum, self.larger_by_neighbours, self.larger_by_size, self.escape);
  }
  /// Calls visit(weight) for all weights, in one order.
  template <class Self, class Visit>
  static void for_each_weight(Self& self, Visit visit) {
    const auto all = [&](auto&... groups) {
      const auto each = [&](auto& mix) {
        std::for_each(mix.weights.begin(), mix.weights.end(), visit);
      };
      (std::for_each(groups.begin(), groups.end(), each), ...);
    };
    all(self.degree, self.nonzero, self.negative, self.larger);
  }
};

/// The class of a sum of magnitudes, 0 to LevelModels::kSizes - 1: classes grow with the sum.
inline int size_class(std::int64_t sum) {
  constexpr std::array<std::int64_t, LevelModels::kSizes - 1> kAbove = {0, 1, 2, 4, 7, 11, 19, 35};
  int found = 0;
  for (const std::int64_t above : kAbove) found += sum > above ? 1 : 0;
  return found;
}

/// A probe's recent activity: counters of 2 bits that rise with each update in which there were
/// levels, and fall with each in which there were none.
class ProbeHistory {
 public:
  // One counter for each channel and degree, and one for the probe.
  static constexpr int kNumbers = 13, kProbe = 12;
  static constexpr std::uint32_t kWords = 1u << (2 * kNumbers);

  ProbeHistory() = default;
  explicit ProbeHistory(std::uint32_t word) : word_(word) {}
  bool operator==(const ProbeHistory&) const = default;

  std::uint32_t word() const { return word_; }
  int at(int number) const { return static_cast<int>(word_ >> (2 * number) & 3u); }
  /// Updates the counters; the set bits are those with levels in this update.
  void update(std::uint32_t bits) {
    std::uint32_t next = 0;
    for (int i = 0; i < kNumbers; ++i) {
      const int now = at(i);
      const int then = (bits >> i & 1u) != 0 ? (now < 2 ? now + 2 : 3) : (now > 0 ? now - 1 : 0);
      next |= static_cast<std::uint32_t>(then) << (2 * i);
    }
    word_ = next;
  }

 private:
  std::uint32_t word_ = 0;
};

}  // namespace lambent::stream
