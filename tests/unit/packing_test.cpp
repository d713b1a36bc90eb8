// SPDX-License-Identifier: Apache-2.0
#include "shared/packing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "field/probes/irradiance_encoding.h"
#include "shared/random.h"

namespace lambent::packing_test {
namespace {

// Dither that must not disturb what is exactly a code: the least, the middle, nearly the most.
constexpr float kDithers[] = {0.0f, 0.5f, 0.9999f};

// Numbers of dither that unbiased encoding is averaged over; so fine can its mean be.
constexpr int kDitherSteps = 4096;
// The mean may be off by this share of a step: two steps of the dither.
constexpr double kMaxBias = 2.0 / kDitherSteps;

float dither(int i) {
  return (static_cast<float>(i) + 0.5f) / kDitherSteps;
}

/// Levels from dark to bright, none a round number.
std::vector<float> levels(float lowest, float highest) {
  std::vector<float> list;
  for (float level = lowest; level < highest; level *= 1.37f) list.push_back(level);
  return list;
}

TEST(SmallFloat, EveryCodeDecodesAndEncodesToItself) {
  for (const int bits : {5, 6, 10}) {
    const uint first_normal = 1u << bits, end = 31u << bits;
    for (uint code = 0; code < end; code = next_small_float(code, bits)) {
      const float value = decode_small_float(code, bits);
      EXPECT_EQ(encode_small_float_down(value, bits), code);
      for (const float u : kDithers) EXPECT_EQ(encode_small_float(value, bits, u), code);
      if (code == end - 1) break;
      EXPECT_LT(value, decode_small_float(next_small_float(code, bits), bits));
    }
    EXPECT_EQ(decode_small_float(first_normal, bits), kSmallFloatMin);
    EXPECT_EQ(decode_small_float(end - 1, bits), small_float_max(bits));
  }
}

TEST(SmallFloat, HalvesAgreeWithTheStandardOnes) {
  for (uint code = 1u << 10; code < 31u << 10; ++code) {
    EXPECT_EQ(decode_half2(code | (code << 16u)), glm::unpackHalf2x16(code | (code << 16u)));
  }
}

TEST(SmallFloat, WhatIsTooLargeOrNegativeIsClamped) {
  for (const int bits : {5, 6, 10}) {
    const uint last = (31u << bits) - 1u;
    for (const float value : {65536.0f, 1e30f, INFINITY}) {
      EXPECT_EQ(encode_small_float(value, bits, 0.999f), last) << value;
    }
    EXPECT_EQ(encode_small_float(-1.0f, bits, 0.0f), 0u);
    EXPECT_EQ(encode_small_float(0.0f, bits, 0.0f), 0u);
  }
}

TEST(SmallFloat, DitherIsUnbiasedAndNeverOffByMoreThanAStep) {
  for (const int bits : {5, 6, 10}) {
    for (const float value : levels(1e-5f, 6e4f)) {
      const uint down = encode_small_float_down(value, bits);
      const float low = decode_small_float(down, bits);
      const float high = decode_small_float(next_small_float(down, bits), bits);
      ASSERT_LE(low, value);
      ASSERT_GT(high, value);
      double mean = 0.0;
      for (int i = 0; i < kDitherSteps; ++i) {
        const float stored = decode_small_float(encode_small_float(value, bits, dither(i)), bits);
        EXPECT_TRUE(stored == low || stored == high);
        mean += stored / static_cast<double>(kDitherSteps);
      }
      EXPECT_NEAR(mean, value, kMaxBias * (high - low)) << bits << " bits, " << value;
    }
  }
}

uint rgb9e5_word(uint r, uint g, uint b, uint exponent) {
  return r | (g << 9u) | (b << 18u) | (exponent << 27u);
}

TEST(Rgb9e5, EveryCodeDecodesAndEncodesToItself) {
  // Codes whose largest mantissa has its top bit; below the smallest exponent there are others
  for (uint exponent = 0; exponent < 32; ++exponent) {
    for (uint largest = exponent == 0 ? 0 : 256; largest < 512; ++largest) {
      const uint other = (largest * 7919u) % (largest + 1),
                 third = (largest * 104729u) % (largest + 1);
      for (const uint word : {rgb9e5_word(largest, other, third, exponent),
                              rgb9e5_word(third, largest, other, exponent),
                              rgb9e5_word(other, third, largest, exponent)}) {
        for (const float u : kDithers) {
          EXPECT_EQ(encode_rgb9e5(decode_rgb9e5(word), vec3(u)), word);
        }
      }
    }
  }
}

TEST(Rgb9e5, EveryInputHasACode) {
  constexpr float kHostile[] = {NAN,    -NAN,    INFINITY, -INFINITY, 3.4e38f, -3.4e38f,
                                1e-45f, -1e-45f, 65408.0f, 65409.0f,  0.0f};
  for (const float a : kHostile) {
    for (const float b : kHostile) {
      for (const float u : kDithers) {
        const vec3 decoded = decode_rgb9e5(encode_rgb9e5(vec3(a, b, 1.0f), vec3(u)));
        EXPECT_TRUE(decoded.x >= 0.0f && decoded.x <= kRgb9e5Max) << a << " " << b;
        EXPECT_TRUE(decoded.y >= 0.0f && decoded.y <= kRgb9e5Max) << a << " " << b;
        if (std::isnan(a)) {
          EXPECT_EQ(decoded.x, 0.0f) << b;
        }
        // Channels beside one that is no number keep what they hold
        if (std::isnan(a) && !(b > 1.0f)) {
          EXPECT_EQ(decoded.z, 1.0f) << b;
        }
        const vec3 small = decode_r11g11b10f(encode_r11g11b10f(vec3(a, b, 1.0f), vec3(u)));
        EXPECT_TRUE(std::isfinite(small.x) && small.x >= 0.0f) << a;
        EXPECT_TRUE(std::isfinite(small.y) && small.y >= 0.0f) << b;
      }
    }
  }
}

TEST(Rgb9e5, DitherIsUnbiasedAndNeverOffByMoreThanAStep) {
  for (const float value : levels(1e-6f, 6.5e4f)) {
    const vec3 color(value, 0.31f * value, 0.007f * value);
    const uint exponent = encode_rgb9e5(color, vec3(0.0f)) >> 27u;
    const float step = power_of_two(static_cast<int>(exponent) - kRgb9e5BiasAndBits);
    glm::dvec3 mean(0.0);
    for (int i = 0; i < kDitherSteps; ++i) {
      const vec3 stored = decode_rgb9e5(encode_rgb9e5(color, vec3(dither(i))));
      for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(stored[c] - color[c]), step);
      mean += glm::dvec3(stored) / static_cast<double>(kDitherSteps);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], color[c], kMaxBias * step) << value;
  }
}

TEST(Rgb9e5, WhatIsTooLargeOrNegativeIsClamped) {
  EXPECT_EQ(decode_rgb9e5(encode_rgb9e5(vec3(1e9f, -1.0f, 0.0f), vec3(0.999f))),
            vec3(kRgb9e5Max, 0.0f, 0.0f));
}

TEST(R11g11b10f, EveryCodeDecodesAndEncodesToItself) {
  const auto check = [](uint word) {
    for (const float u : kDithers) {
      EXPECT_EQ(encode_r11g11b10f(decode_r11g11b10f(word), vec3(u)), word);
    }
  };
  // Codes whose light, the fifth power of what they hold, is a normal float
  for (uint code = 1u << 6; code < 31u << 6; ++code) {
    if (linear_from_perceptual(decode_small_float(code, 6)) < 1e-30f) continue;
    check(code);
    check(code << 11u);
  }
  for (uint code = 1u << 5; code < 31u << 5; ++code) {
    if (linear_from_perceptual(decode_small_float(code, 5)) < 1e-30f) continue;
    check(code << 22u);
  }
  check(0u);
}

TEST(R11g11b10f, DitherIsUnbiasedInLinearLightAndNeverOffByMoreThanAStep) {
  for (const float value : levels(1e-6f, 1e6f)) {
    const vec3 color(value);
    const uint word = encode_r11g11b10f(color, vec3(0.99999f));
    glm::dvec3 mean(0.0);
    for (int i = 0; i < kDitherSteps; ++i) {
      mean += glm::dvec3(decode_r11g11b10f(encode_r11g11b10f(color, vec3(dither(i))))) /
              static_cast<double>(kDitherSteps);
    }
    const vec3 low = decode_r11g11b10f(word);
    for (int c = 0; c < 3; ++c) {
      // A step of a channel with m mantissa bits is at most 2^-m of the code: five times of light
      const double step = value * (std::pow(1.0 + std::exp2(c == 2 ? -5.0 : -6.0), 5.0) - 1.0);
      EXPECT_LE(std::abs(low[c] - value), step);
      EXPECT_NEAR(mean[c], value, kMaxBias * step) << value;
    }
  }
}

}  // namespace
}  // namespace lambent::packing_test
