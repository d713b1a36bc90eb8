// SPDX-License-Identifier: Apache-2.0
#include "shared/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/image/color_map.h"
#include "core/image/tone_map.h"
#include "shared/tone_map.h"

namespace lambent::color_test {
namespace {

TEST(Srgb, RoundTripAndKnownValues) {
  for (int i = 0; i <= 1000; ++i) {
    const float value = static_cast<float>(i) / 1000.0f;
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(value)), value, 1e-5f);
  }
  EXPECT_NEAR(srgb_from_linear(0.18f), 0.4614f, 1e-4f);
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404f, 1e-5f);
}

TEST(ToneMap, LinearShowsExposedRadianceClipped) {
  const vec3 shown = tone_map(2.0f * vec3(0.1f, 0.3f, -1.0f), kToneMapLinear);
  EXPECT_NEAR(shown.x, 0.2f, 1e-6f);
  EXPECT_NEAR(shown.y, 0.6f, 1e-6f);
  EXPECT_EQ(shown.z, 0.0f);
  EXPECT_EQ(tone_map(vec3(5.0f), kToneMapLinear), vec3(1.0f));
}

TEST(ToneMap, EveryCurveRisesWithGreyAndStaysInRangeEvenForInfinity) {
  for (const uint curve : {kToneMapLinear, kToneMapAces, kToneMapNeutral}) {
    float last = -1.0f;
    for (float grey = 0.0f; grey < 20.0f; grey += 0.01f) {
      const vec3 shown = tone_map(vec3(grey), curve);
      EXPECT_GE(shown.y, last) << "curve " << curve << " at " << grey;
      EXPECT_LE(shown.y, 1.0f);
      last = shown.y;
    }
    EXPECT_EQ(tone_map(vec3(0.0f), curve), vec3(0.0f));
    const vec3 brightest = tone_map(vec3(std::numeric_limits<float>::infinity()), curve);
    EXPECT_GT(brightest.x, 0.98f);
    EXPECT_LE(brightest.x, 1.0f);
  }
}

TEST(ToneMap, AcesKeepsGreysGreyAndMatchesItsCurve) {
  const vec3 shown = tone_map_aces(vec3(0.18f));
  EXPECT_NEAR(shown.x, shown.y, 2e-4f);
  EXPECT_NEAR(shown.z, shown.y, 2e-4f);
  // (0.18 (0.18 + 0.0245786) - 0.000090537) / (0.18 (0.983729 * 0.18 + 0.4329510) + 0.238081)
  EXPECT_NEAR(shown.y, 0.10562f, 1e-4f);
}

TEST(ToneMap, AcesKeepsTheHuesOfBrightColors) {
  // A flame is as orange however bright it is, where the curve by itself would show it white
  const vec3 flame(1.0f, 0.3f, 0.02f);
  const vec3 dim = tone_map(kHuePeak * flame, kToneMapAces);
  EXPECT_LT(dim.z, 0.3f * dim.x);
  EXPECT_GT(tone_map_aces(500.0f * flame).z, 0.9f);
  const vec3 bright = tone_map(500.0f * flame, kToneMapAces);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(bright[c], dim[c], 1e-4f);
  // What is no brighter, and greys, are as the curve has them
  for (const vec3& color : {vec3(1.9f, 0.2f, 0.0f), vec3(9.0f)}) {
    EXPECT_EQ(tone_map(color, kToneMapAces), clamp(tone_map_aces(color), vec3(0.0f), vec3(1.0f)));
  }
}

TEST(ToneMap, NeutralReturnsTheBaseColorUnderADielectric) {
  // What a viewer sees of base colour c under uniform white light is c + 0.04; the curve takes 0.04
  // away.
  const vec3 base(0.7f, 0.3f, 0.1f);
  const vec3 shown = tone_map_neutral(base + vec3(0.04f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], base[c], 1e-6f);
  EXPECT_LT(tone_map_neutral(vec3(100.0f)).x, 1.0f);
}

/// A grey picture of these columns, three rows high.
Image columns_of(const std::vector<float>& levels) {
  Image image(static_cast<int>(levels.size()), 3, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = levels[i / 3 % levels.size()];
  }
  return image;
}

TEST(DisplayImage, SmoothsEdgesOfWhatIsFarBrighterThanWhite) {
  // A lamp covers half of a pixel, and a tenth of another
  const Image steep = columns_of({0.05f, 0.05f, 40.0f, 80.0f, 80.0f, 8.0f, 0.05f});
  const Image shown = display_image(steep, ToneMap::aces, 0.0f);
  const auto level = [&](int x) { return linear_from_srgb(vec3(shown.at(x, 1)[0])).x; };
  const float dark = tone_map_aces(vec3(0.05f)).x, white = 1.0f;
  EXPECT_NEAR(level(1), dark, 1e-4f);
  EXPECT_NEAR(level(2), 0.5f * (dark + white), 0.01f);
  EXPECT_NEAR(level(4), white, 1e-4f);
  EXPECT_NEAR(level(5), 0.9f * dark + 0.1f * white, 0.01f);
  EXPECT_NEAR(level(6), dark, 1e-4f);
  // A blue tube, whose luminance is that of a grey a fourteenth as bright
  Image tube = columns_of({0.0f, 6.0f, 12.0f, 12.0f});
  for (std::size_t i = 0; i < tube.pixels.size(); ++i) tube.pixels[i] *= i % 3 == 2 ? 1.0f : 0.0f;
  const Image blue = display_image(tube, ToneMap::linear, 0.0f);
  EXPECT_NEAR(linear_from_srgb(blue.at(1, 1)[2]), 0.5f, 0.01f);
}

TEST(DisplayImage, ShowsAllElseAsTheCurveHasIt) {
  // Edges of what is hardly white, a wall beside a lamp, a thin line, and what is no number
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float endless = std::numeric_limits<float>::infinity();
  for (const auto& levels : {std::vector{0.1f, 1.9f, 1.0f, 0.3f},
                             {0.2f, 0.15f, 50.0f, 0.25f, 0.2f},
                             {0.1f, 30.0f, 0.1f},
                             {nan, 0.3f, endless, endless, 3.0f, -1.0f}}) {
    const Image picture = columns_of(levels);
    const Image shown = display_image(picture, ToneMap::aces, 0.0f);
    for (int x = 0; x < picture.width; ++x) {
      const float value = std::isnan(levels[x]) ? 0.0f : levels[x];
      const vec3 alone = srgb_from_linear(tone_map(vec3(value), kToneMapAces));
      // Of 3 beside what is endless, nothing is covered
      const vec3 expected = levels[x] == 3.0f ? vec3(0.0f) : alone;
      EXPECT_NEAR(shown.at(x, 1)[1], expected.y, 1e-2f) << levels[x];
    }
  }
}

TEST(DisplayImage, LeavesEdgesOfDataAlone) {
  const Image depths = columns_of({0.05f, 6.0f, 12.0f});
  const Image shown = display_image(depths, ToneMap::linear, -4.0f, Edges::as_averaged);
  for (int x = 0; x < depths.width; ++x) {
    EXPECT_FLOAT_EQ(shown.at(x, 1)[0], srgb_from_linear(depths.at(x, 1)[0] / 16.0f));
  }
  const Image white = display_image(depths, ToneMap::linear, 0.0f, Edges::as_averaged);
  EXPECT_FLOAT_EQ(white.at(1, 1)[0], 1.0f);
}

TEST(DisplayImage, IsTheSameByRows) {
  Image picture(5, 7, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    picture.pixels[i] = std::exp2(static_cast<float>(i * 7 % 13) - 6.0f);
  }
  const Image whole = display_image(picture, ToneMap::neutral, 0.5f);
  for (int y = 0; y < picture.height; ++y) {
    const Image row = display_rows(picture, y, 1, ToneMap::neutral, 0.5f);
    EXPECT_TRUE(std::ranges::equal(row.pixels, std::span(whole.at(0, y), 15))) << y;
  }
}

TEST(ToneMap, HasNames) {
  EXPECT_EQ(tone_map_from_name("aces"), ToneMap::aces);
  EXPECT_EQ(tone_map_from_name("neutral"), ToneMap::neutral);
  EXPECT_EQ(tone_map_from_name("linear"), ToneMap::linear);
  EXPECT_FALSE(tone_map_from_name("filmic"));
}

TEST(DisplayImage, EncodesColorKeepsAlphaAndShowsNanAsBlack) {
  Image image(1, 1, 4);
  image.pixels = {0.09f, std::nanf(""), 7.0f, 0.25f};
  const Image shown = display_image(image, ToneMap::linear, 1.0f);
  ASSERT_EQ(shown.channels, 4);
  EXPECT_NEAR(shown.pixels[0], srgb_from_linear(0.18f), 1e-6f);
  EXPECT_EQ(shown.pixels[1], 0.0f);
  EXPECT_NEAR(shown.pixels[2], 1.0f, 1e-6f);
  EXPECT_EQ(shown.pixels[3], 0.25f);
  Image grey(1, 1, 1);
  grey.pixels = {0.18f};
  EXPECT_EQ(display_image(grey, ToneMap::linear, 0.0f).channels, 3);
}

/// CIE lightness of an encoded colour: a measure of our order other than the one the maps were
/// built in.
float lightness(const glm::vec3& encoded) {
  return 116.0f * std::cbrt(luminance(linear_from_srgb(encoded))) - 16.0f;
}

TEST(ColorMap, SequentialLightnessRisesAllTheWay) {
  float last = -100.0f;
  for (int i = 0; i <= 100; ++i) {
    const float now = lightness(sequential_color(static_cast<float>(i) / 100.0f));
    EXPECT_GT(now, last);
    last = now;
  }
  EXPECT_EQ(sequential_color(-3.0f), sequential_color(0.0f));
  EXPECT_EQ(sequential_color(3.0f), sequential_color(1.0f));
}

TEST(ColorMap, DivergingIsPalestAtZeroAndTellsTheSign) {
  for (int i = 1; i <= 100; ++i) {
    const float value = static_cast<float>(i) / 100.0f, less = value - 0.01f;
    EXPECT_LT(lightness(diverging_color(value)), lightness(diverging_color(less)));
    EXPECT_LT(lightness(diverging_color(-value)), lightness(diverging_color(-less)));
    EXPECT_GT(diverging_color(value).x, diverging_color(value).z);
    EXPECT_LT(diverging_color(-value).x, diverging_color(-value).z);
  }
}

}  // namespace
}  // namespace lambent::color_test
