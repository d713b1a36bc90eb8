// SPDX-License-Identifier: Apache-2.0
#include "stream/light/quantise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/parallel.h"
#include "stream/light/light_signal.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

constexpr std::size_t kChunk = 128;  // probes per task

// The share of the mean light in the denominator of LightErrors::dark.
constexpr double kDarkShare = 0.1;

// Least light to which errors are relative [W/m^2].
constexpr double kLeastLight = 1e-20;

// The brightest light that is coded [W/m^2].
constexpr float kMaxLight = 1e14f;

// Factor of a unit over the target error times the root of the mean light. With it, both errors of
// the atrium's day are within the target with a thrift of 1.
constexpr float kUnits = 1.4f;

// Least change that becomes a level [units], and its increase with a thrift of 1.
constexpr float kDeadZone = 0.5f, kThriftyDeadZone = 0.15f;
// The same for a level of 1 that is the only one of its degree.
constexpr float kLoneDeadZone = 0.5f, kThriftyLoneDeadZone = 0.4f;
// Least reduction of the square error [units^2] for which a probe with one or two levels of 1 is
// sent, with a thrift of 1.
constexpr float kThriftyGain = 1.2f;
constexpr int kFewLevels = 2;

/// Chooses the levels of one probe.
class ProbeLevels {
 public:
  ProbeLevels(const LightLayout& layout, std::span<const float> changes,
              std::span<std::int32_t> levels, float thrift)
      : texels_(layout.texels), changes_(changes), levels_(levels), thrift_(thrift) {}

  void choose() {
    // Levels of 1 begin at the edge of the dead zone
    const float shift = 1.0f - (kDeadZone + kThriftyDeadZone * thrift_);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const auto level = static_cast<std::int32_t>(std::max(std::abs(changes_[i]) + shift, 0.0f));
      levels_[i] = changes_[i] < 0.0f ? -level : level;
    }
    std::int64_t sum = 0;
    for (int channel = 0; channel < kChannels; ++channel) {
      for (int degree = 0; degree * degree < texels_; ++degree) {
        sum += without_lone_level(channel * texels_ + degree * degree, 2 * degree + 1);
      }
    }
    if (sum > 0 && sum <= kFewLevels && gain() < kThriftyGain * thrift_) {
      std::fill(levels_.begin(), levels_.end(), 0);
    }
  }

 private:
  /// Removes the level of a degree if it is small and the only one. Returns the sum of magnitudes.
  std::int64_t without_lone_level(std::size_t first, std::size_t count) {
    std::int64_t sum = 0;
    std::size_t at = first;
    for (std::size_t i = first; i < first + count; ++i) {
      if (levels_[i] == 0) continue;
      sum += std::abs(levels_[i]);
      at = i;
    }
    if (sum != 1 || std::abs(changes_[at]) >= kLoneDeadZone + kThriftyLoneDeadZone * thrift_) {
      return sum;
    }
    levels_[at] = 0;
    return 0;
  }

  /// The reduction of the square error by the levels.
  float gain() const {
    float sum = 0.0f;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const auto level = static_cast<float>(levels_[i]);
      sum += level * (2.0f * changes_[i] - level);
    }
    return sum;
  }

  int texels_;
  std::span<const float> changes_;
  std::span<std::int32_t> levels_;
  float thrift_;
};

}  // namespace

Expected<void> check_light(std::span<const glm::vec4> tiles) {
  for (const glm::vec4& texel : tiles) {
    // Written so that NaN fails
    const bool sound = texel.x >= 0.0f && texel.x <= kMaxLight && texel.y >= 0.0f &&
                       texel.y <= kMaxLight && texel.z >= 0.0f && texel.z <= kMaxLight;
    if (!sound) return bad_stream("", "cannot carry light that is not within 0 to 1e14 W/m^2");
  }
  return {};
}

FieldLight measure_light(const LightLayout& layout, std::span<const glm::vec4> tiles) {
  FieldLight light{tiles, 0.0};
  std::size_t lit = 0;
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0) continue;
    ++lit;
    float sum = 0.0f;
    for (const glm::vec4& texel : tiles.subspan(probe * layout.texels, layout.texels)) {
      sum += texel.x + texel.y + texel.z;
    }
    light.mean += sum;
  }
  if (lit > 0) light.mean /= static_cast<double>(lit * layout.numbers());
  return light;
}

std::vector<float> coefficients_of(const LightLayout& layout, const TileBasis& basis,
                                   const FieldLight& light, float unit) {
  std::vector<float> coefficients(layout.probes() * layout.numbers());
  const LightSignal signal(basis, unit);
  parallel_chunks(layout.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t probe = begin; probe < end; ++probe) {
      if (layout.lit[probe] == 0) continue;
      signal.coefficients_of(
          light.tiles.subspan(probe * layout.texels, layout.texels),
          std::span(coefficients).subspan(probe * layout.numbers(), layout.numbers()));
    }
  });
  return coefficients;
}

LightErrors errors_of(const LightLayout& layout, const TileBasis& basis, const FieldLight& light,
                      float unit, std::span<const std::int32_t> coefficients) {
  struct Sums {
    double square = 0.0, dark = 0.0, count = 0.0;
  };
  std::vector<Sums> sums((layout.probes() + kChunk - 1) / kChunk);
  const LightSignal signal(basis, unit);
  const auto added = static_cast<float>(std::max(kDarkShare * light.mean, kLeastLight));
  parallel_chunks(layout.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::array<glm::vec3, kMaxTileTexels> decoded;
    const std::span tile(decoded.data(), layout.texels);
    Sums& sum = sums[begin / kChunk];
    for (std::size_t probe = begin; probe < end; ++probe) {
      if (layout.lit[probe] == 0) continue;
      signal.light_of(coefficients.subspan(probe * layout.numbers(), layout.numbers()), tile);
      float square = 0.0f, dark = 0.0f;
      for (int t = 0; t < layout.texels; ++t) {
        const glm::vec3 truth(light.tiles[probe * layout.texels + t]);
        const glm::vec3 error = tile[t] - truth;
        const glm::vec3 relative = error / (truth + added);
        square += glm::dot(error, error);
        dark += glm::dot(relative, relative);
      }
      sum.square += square;
      sum.dark += dark;
      sum.count += static_cast<double>(layout.numbers());
    }
  });
  Sums all;
  for (const Sums& sum : sums) {
    all.square += sum.square;
    all.dark += sum.dark;
    all.count += sum.count;
  }
  if (all.count == 0.0) return {};
  return {std::sqrt(all.square / all.count) / std::max(light.mean, kLeastLight),
          std::sqrt(all.dark / all.count)};
}

float choose_unit(const FieldLight& light, float target_error) {
  return kUnits * target_error * static_cast<float>(std::sqrt(std::max(light.mean, kLeastLight)));
}

LightState rounded_state(const LightLayout& layout, std::span<const float> coefficients,
                         float unit) {
  LightState state;
  state.unit = unit;
  state.history.resize(layout.probes());
  state.coefficients.reserve(coefficients.size());
  for (const float number : coefficients) {
    state.coefficients.push_back(static_cast<std::int32_t>(std::lround(number)));
  }
  return state;
}

std::vector<std::int32_t> choose_levels(const LightLayout& layout, const LightState& state,
                                        std::span<const float> coefficients, float thrift) {
  std::vector<std::int32_t> levels(coefficients.size());
  parallel_chunks(layout.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::array<float, kChannels * kMaxTileTexels> changes;
    for (std::size_t probe = begin; probe < end; ++probe) {
      if (layout.lit[probe] == 0) continue;
      const std::size_t first = probe * layout.numbers();
      for (std::size_t i = 0; i < layout.numbers(); ++i) {
        changes[i] = coefficients[first + i] - static_cast<float>(state.coefficients[first + i]);
      }
      ProbeLevels(layout, std::span(changes).first(layout.numbers()),
                  std::span(levels).subspan(first, layout.numbers()), thrift)
          .choose();
    }
  });
  return levels;
}

}  // namespace lambent::stream
