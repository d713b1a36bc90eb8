// SPDX-License-Identifier: Apache-2.0
#include "core/cross_bilateral.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/large_pages.h"
#include "shared/cross_bilateral.h"
#include "shared/random.h"

namespace lambent::cross_bilateral_test {
namespace {

constexpr int kWidth = 256;

// Half a unit in the last place of what is blurred, and of what comes out: 8 bits of mantissa.
constexpr float kHalfRounding = 1.0f / 256.0f;

/// Two values in the place of a float, as the filter reads them.
float packed(float upper, float lower) {
  const std::uint32_t up = (std::bit_cast<std::uint32_t>(upper) + 0x8000u) & 0xFFFF0000u;
  return std::bit_cast<float>(up | ((std::bit_cast<std::uint32_t>(lower) + 0x8000u) >> 16u));
}

float upper_half(float word) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(word) & 0xFFFF0000u);
}

/// A row of pixels a centimetre apart, seen from 1 m.
struct Row {
  explicit Row(int width)
      : guides(width, 1, kGuidePlanes),
        lights(width, 1, kLightPlanes),
        guide(guides.size),
        light(lights.size),
        out(lights.size) {
    for (int i = 0; i < width; ++i) {
      position(i, 0) = 0.01f * static_cast<float>(i);
      normal(i, 2) = 1.0f;
      guide_at(kInverseDepthPlane, i) = 1.0f;
    }
  }
  float& guide_at(int plane, int i) {
    return guide.data()[guides.row(0) + static_cast<std::size_t>(plane * guides.stride + i)];
  }
  float& position(int i, int axis) { return guide_at(kPositionPlane + axis, i); }
  float& normal(int i, int axis) { return guide_at(kNormalPlane + axis, i); }
  /// Light of one channel, which is what all normals receive.
  void set_light(int i, int channel, float value) { word(light, i, channel) = packed(value, 0.0f); }
  float& word(AlignedFloats& planes, int i, int channel) {
    return planes.data()[lights.row(0) + static_cast<std::size_t>(channel * lights.stride + i)];
  }
  float blurred(int i, int channel) { return upper_half(word(out, i, channel)); }
  BlurSource source(int step, float weight) {
    return {{guide.data() + guides.row(0) + step, guides.stride},
            {light.data() + lights.row(0) + step, lights.stride},
            weight};
  }
  void blur(const std::vector<BlurTap>& taps, float tolerance) {
    std::vector<BlurSource> neighbours;
    for (const BlurTap& tap : taps) {
      neighbours.push_back(source(-tap.distance, tap.weight));
      neighbours.push_back(source(tap.distance, tap.weight));
    }
    cross_bilateral_row(source(0, 1.0f), neighbours, {out.data() + lights.row(0), lights.stride},
                        lights.width, tolerance);
  }
  PlaneLayout guides, lights;
  AlignedFloats guide, light, out;
};

TEST(CrossBilateral, KeepsAStepAtADepthEdge) {
  Row row(kWidth);
  for (int i = 0; i < kWidth; ++i) {
    row.position(i, 2) = i < kWidth / 2 ? 0.0f : -0.5f;
    row.set_light(i, 0, i < kWidth / 2 ? 1.0f : 5.0f);
  }
  row.blur(box_taps(4), 0.02f);
  for (int i = 0; i < kWidth; ++i) EXPECT_EQ(row.blurred(i, 0), i < kWidth / 2 ? 1.0f : 5.0f) << i;
}

TEST(CrossBilateral, KeepsAStepAtACrease) {
  Row row(kWidth);
  for (int i = kWidth / 2; i < kWidth; ++i) {
    row.normal(i, 2) = 0.0f;
    row.normal(i, 0) = -1.0f;
  }
  for (int i = 0; i < kWidth; ++i) row.set_light(i, 1, i < kWidth / 2 ? 1.0f : 5.0f);
  row.blur(box_taps(4), 0.5f);
  for (int i = 0; i < kWidth; ++i) EXPECT_EQ(row.blurred(i, 1), i < kWidth / 2 ? 1.0f : 5.0f) << i;
}

TEST(CrossBilateral, FlattensNoiseByTheNumberOfItsTaps) {
  // The mean of k independent values has 1 / k of their variance
  Row row(4096);
  RandomStream random = make_random_stream(1, 2, 3);
  for (int i = 0; i < 4096; ++i) row.set_light(i, 2, next_uniform(random));
  for (const int radius : {1, 2, 4}) {
    row.blur(box_taps(radius), 0.5f);
    double sum = 0.0, square = 0.0;
    const int count = 4096 - 2 * radius;
    for (int i = radius; i < 4096 - radius; ++i) {
      const double value = row.blurred(i, 2);
      sum += value;
      square += value * value;
    }
    const double variance = square / count - sum * sum / count / count;
    const double predicted = 1.0 / 12.0 / (2 * radius + 1);
    EXPECT_NEAR(variance / predicted, 1.0, 0.15) << radius;  // 3 sigma of 4096 correlated samples
  }
}

TEST(CrossBilateral, AveragesAPatternOfItsPeriodAway) {
  for (const int period : {2, 3, 4, 5, 8}) {
    Row row(kWidth);
    for (int i = 0; i < kWidth; ++i) row.set_light(i, 0, static_cast<float>(i % period));
    row.blur(period_taps(period), 0.5f);
    const float mean = 0.5f * static_cast<float>(period - 1);
    for (int i = period; i < kWidth - period; ++i) {
      EXPECT_NEAR(row.blurred(i, 0), mean, kHalfRounding * mean) << period << " at " << i;
    }
  }
}

TEST(CrossBilateral, TakesNothingFromPixelsThatSeeNothing) {
  Row row(kWidth);
  for (int i = 0; i < kWidth; ++i) row.set_light(i, 0, i % 2 == 0 ? 1.0f : 1000.0f);
  for (int i = 1; i < kWidth; i += 2) row.normal(i, 2) = 0.0f;
  row.blur(box_taps(3), 0.5f);
  for (int i = 0; i < kWidth; i += 2) EXPECT_EQ(row.blurred(i, 0), 1.0f);
}

TEST(CrossBilateral, WeighsLanesAsTheSharedFunctionDoes) {
  Row row(kWidth);
  RandomStream random = make_random_stream(5, 6, 7);
  for (int i = 0; i < kWidth; ++i) {
    const vec3 n = normalize(vec3(next_uniform2(random) * 0.6f - 0.3f, 1.0f));
    for (int c = 0; c < 3; ++c) row.normal(i, c) = n[c];
    row.position(i, 2) = 0.02f * next_uniform(random);
    row.set_light(i, 0, next_uniform(random));
  }
  constexpr float kTolerance = 0.03f;
  row.blur({{2, 0.7f}}, kTolerance);
  const auto at = [&](int i) {
    return std::pair(vec3(row.position(i, 0), row.position(i, 1), row.position(i, 2)),
                     vec3(row.normal(i, 0), row.normal(i, 1), row.normal(i, 2)));
  };
  for (int i = 2; i + 2 < kWidth; ++i) {
    float sum = upper_half(row.word(row.light, i, 0)), weights = 1.0f;
    for (const int j : {i - 2, i + 2}) {
      const float weight = 0.7f * relit_bilateral_weight(at(i).first - at(j).first, at(i).second,
                                                         at(j).second, 1.0f / kTolerance);
      sum += weight * upper_half(row.word(row.light, j, 0));
      weights += weight;
    }
    EXPECT_NEAR(row.blurred(i, 0), sum / weights, kHalfRounding * sum / weights);
  }
}

}  // namespace
}  // namespace lambent::cross_bilateral_test
