// SPDX-License-Identifier: Apache-2.0
// Coding of levels, the quantised numbers of a light stream, with one function for writing and
// reading. A probe without levels takes one decision; otherwise decisions say which degrees of each
// channel have levels, and then which functions of these. The contexts of a decision are the
// probe's three preceding neighbours, the first channel, and earlier updates.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "stream/light/light_state.h"

namespace lambent::stream {

// Magnitudes of levels are clamped to this on reading; encoders write far smaller ones.
inline constexpr std::uint32_t kMaxLevel = 1u << 28u;

/// Codes the levels of all probes, one after the other. A Coder is a RangeEncoder, which writes
/// `levels`, or a RangeDecoder, which fills them in; they begin as 0.
template <class Coder>
class LevelCoder {
 public:
  LevelCoder(Coder& coder, LevelModels& models, const LightLayout& layout,
             std::span<const ProbeHistory> history, std::span<std::int32_t> levels)
      : coder_(coder),
        models_(models),
        layout_(layout),
        history_(history),
        levels_(levels),
        something_(layout.probes()),
        activity_(layout.probes()) {}

  /// Codes a probe. All before it must have been coded.
  void probe(int index) {
    if (layout_.lit[index] == 0) return;
    probe_ = index;
    own_ = levels_.data() + index * layout_.numbers();
    if (!code_probe_flag()) return;
    something_[index] = 1u << ProbeHistory::kProbe;
    std::uint64_t sum = 0;
    for (int channel = 0; channel < kChannels; ++channel) {
      for (int degree = 0; degree * degree < layout_.texels; ++degree) code_degree(channel, degree);
    }
    for (std::size_t i = 0; i < layout_.numbers(); ++i) sum += std::abs(own_[i]);
    activity_[index] = sum > kActive ? 2 : 1;
  }

  /// For ProbeHistory::update: bits of those numbers of a probe that had levels.
  std::uint32_t something(int index) const { return something_[index]; }

 private:
  // Sum of a probe's magnitudes above which its activity is 2.
  static constexpr std::uint64_t kActive = 2;

  /// The sum of a number over the three preceding neighbours; missing ones count as 0.
  template <class Number>
  auto sum_before(Number number) const {
    decltype(number(0)) sum = 0;
    for (const std::int32_t other : layout_.before[probe_]) {
      if (other >= 0) sum += number(other);
    }
    return sum;
  }

  bool code_probe_flag() {
    const int active = sum_before([&](int other) { return int{activity_[other]}; });
    int after = 0;
    for (const std::int32_t other : layout_.after[probe_]) {
      if (other >= 0) after += history_[other].at(ProbeHistory::kProbe);
    }
    const int late = after == 0 ? 0 : after < 4 ? 1 : 2;
    const int own = history_[probe_].at(ProbeHistory::kProbe);
    BitModel& model =
        models_.coded[(active * LevelModels::kCounts + own) * LevelModels::kAfter + late];
    const bool any = Coder::kWrites && std::any_of(own_, own_ + layout_.numbers(),
                                                   [](std::int32_t level) { return level != 0; });
    return code_bit(coder_, model, any);
  }

  /// The index of a channel and a degree in arrays of models; degrees from 3 on share theirs.
  static int group_of(int channel, int degree) {
    return channel * LevelModels::kDegrees + std::min(degree, LevelModels::kDegrees - 1);
  }

  static std::int64_t magnitudes(std::span<const std::int32_t> levels) {
    std::int64_t sum = 0;
    for (const std::int32_t level : levels) sum += std::abs(level);
    return sum;
  }

  void code_degree(int channel, int degree) {
    group_ = group_of(channel, degree);
    const int begin = degree * degree, end = std::min((degree + 1) * (degree + 1), layout_.texels);
    const std::span levels(own_ + channel * layout_.texels, layout_.texels);
    // Predict the size of levels from those of the preceding degree, and of the first channel
    const int before_begin = degree > 0 ? (degree - 1) * (degree - 1) : 0;
    const std::int64_t before = magnitudes(levels.subspan(before_begin, begin - before_begin));
    const std::int64_t first =
        channel > 0 ? magnitudes(std::span(own_ + begin, own_ + end)) : before;
    size_ = size_class(channel > 0 ? first + (before + 1) / 2 : before);
    count_ = history_[probe_].at(group_);
    const int near =
        sum_before([&](int other) { return static_cast<int>(something_[other] >> group_ & 1u); });
    const int with_first = channel > 0 && first > 0 ? 1 : 0;
    const bool any = Coder::kWrites && std::any_of(levels.begin() + begin, levels.begin() + end,
                                                   [](std::int32_t level) { return level != 0; });
    const int history = group_ * LevelModels::kCounts + count_;
    if (!code_mixed<Coder, 2>(
            coder_, models_.degree[group_],
            {&models_.degree_by_history[(history * LevelModels::kNear + near) * 2 + with_first],
             &models_.degree_by_size[(group_ * LevelModels::kSizes + size_) * 2 + with_first]},
            any)) {
      return;
    }
    something_[probe_] |= 1u << group_;
    bool found = false;
    for (int function = begin; function < end; ++function) {
      // If no other function had a level, the last one must have one
      const bool sure = function + 1 == end && !found;
      found = code_level(channel, function, sure) || found;
    }
  }

  /// The levels of the same function in the three preceding neighbours.
  struct Neighbours {
    std::int64_t sum = 0, magnitudes = 0;
    int signs = 0, which = 0;
  };
  Neighbours neighbours_at(std::size_t number) const {
    Neighbours found;
    for (int axis = 0; axis < LightLayout::kAxes; ++axis) {
      const std::int32_t other = layout_.before[probe_][axis];
      const std::int32_t level = other < 0 ? 0 : levels_[other * layout_.numbers() + number];
      found.sum += level;
      found.magnitudes += std::abs(level);
      found.signs += level > 0 ? 1 : level < 0 ? -1 : 0;
      found.which |= level != 0 ? 1 << axis : 0;
    }
    return found;
  }

  /// Codes a level, and returns whether it is not 0. With `sure`, it is known not to be 0.
  bool code_level(int channel, int function, bool sure) {
    const std::size_t number = static_cast<std::size_t>(channel) * layout_.texels + function;
    std::int32_t& level = own_[number];
    const Neighbours near = neighbours_at(number);
    const std::int32_t first = channel > 0 ? own_[function] : 0;
    const int near_size = size_class(near.magnitudes);
    if (!sure) {
      const int shown =
          channel * LevelModels::kFunctions + std::min(function, LevelModels::kFunctions - 1);
      const int by_function = (shown * LevelModels::kCounts + count_) * 2 + (first != 0 ? 1 : 0);
      const int by_size = (group_ * LevelModels::kSizes + near_size) * LevelModels::kSizes + size_;
      if (!code_mixed<Coder, 3>(
              coder_, models_.nonzero[group_],
              {&models_.nonzero_by_function[by_function], &models_.nonzero_by_size[by_size],
               &models_.nonzero_by_neighbours[group_ * 8 + near.which]},
              level != 0)) {
        return false;
      }
    }
    const bool negative = code_sign(near, first, level < 0);
    const std::uint32_t magnitude = code_magnitude(near_size, level);
    level = negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
    return true;
  }

  bool code_sign(const Neighbours& near, std::int32_t first, bool negative) {
    const auto side = [](std::int64_t sum) { return sum < 0 ? 0 : sum > 0 ? 2 : 1; };
    const int by_sign =
        (group_ * LevelModels::kSigns + side(near.signs)) * LevelModels::kSigns + side(first);
    const int size = size_class(std::abs(near.sum));
    const int by_sum =
        group_ * 2 * LevelModels::kSizes + (near.sum < 0 ? LevelModels::kSizes + size : size);
    return code_mixed<Coder, 2>(
        coder_, models_.negative[group_],
        {&models_.negative_by_sign[by_sign], &models_.negative_by_sum[by_sum]}, negative);
  }

  /// The magnitude of a level that is not 0.
  std::uint32_t code_magnitude(int near_size, std::int32_t level) {
    const int group = group_ < LevelModels::kDegrees
                          ? group_
                          : LevelModels::kDegrees + group_ % LevelModels::kDegrees;
    const int by_neighbours = (group * LevelModels::kSizes + near_size) * LevelModels::kMagnitudes;
    const int by_size = (group * LevelModels::kSizes + size_) * LevelModels::kMagnitudes;
    const auto wanted = static_cast<std::uint32_t>(std::abs(level));
    std::uint32_t magnitude = 1;
    while (magnitude <= LevelModels::kMagnitudes) {
      const int so_far = static_cast<int>(magnitude) - 1;
      if (!code_mixed<Coder, 2>(coder_, models_.larger[group],
                                {&models_.larger_by_neighbours[by_neighbours + so_far],
                                 &models_.larger_by_size[by_size + so_far]},
                                wanted > magnitude)) {
        return magnitude;
      }
      ++magnitude;
    }
    const std::uint32_t beyond = Coder::kWrites ? wanted - magnitude : 0;
    return std::min(magnitude + code_exp_golomb(coder_, models_.escape, beyond), kMaxLevel);
  }

  Coder& coder_;
  LevelModels& models_;
  const LightLayout& layout_;
  std::span<const ProbeHistory> history_;
  std::span<std::int32_t> levels_;
  std::vector<std::uint32_t> something_;
  std::vector<std::uint8_t> activity_;
  // State of the current probe, channel and degree
  int probe_ = 0;
  std::int32_t* own_ = nullptr;
  int group_ = 0, size_ = 0, count_ = 0;
};

}  // namespace lambent::stream
