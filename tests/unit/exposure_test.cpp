// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/lang.h"

namespace lambent::exposure_test {
namespace {

/// The factor that display_stops() stands for.
template <class Picture>
double display_exposure(const Picture& picture) {
  return std::exp2(static_cast<double>(display_stops(picture)));
}

Image grey(float value, int size = 16) {
  Image image(size, size, 3);
  for (float& channel : image.pixels) channel = value;
  return image;
}

TEST(Exposure, BringsAnEvenPictureToMidGrey) {
  for (const float value : {1e-6f, 0.18f, 1.0f, 1e6f}) {
    // A bin of the histogram is an eighth of a stop wide
    EXPECT_NEAR(std::log2(display_exposure(grey(value)) * value / 0.18), 0.0, 0.07) << value;
  }
}

TEST(Exposure, IsNotDrivenByASmallBrightEmitter) {
  Image image = grey(1.0f);
  const double before = display_exposure(image);
  for (int c = 0; c < 3; ++c) image.at(3, 3)[c] = 1e6f;
  EXPECT_NEAR(std::log2(display_exposure(image) / before), 0.0, 0.03);
}

TEST(Exposure, IsNotDrivenByBlackPixels) {
  Image image = grey(1.0f);
  const double before = display_exposure(image);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = 0.0f;
    }
  }
  EXPECT_DOUBLE_EQ(display_exposure(image), before);
}

TEST(Exposure, IsNotDrivenByWhatIsAMillionTimesDarker) {
  Image image = grey(1e-9f);
  std::fill_n(image.pixels.begin(), image.pixels.size() / 10, 1.0f);
  LayeredImage frame;
  frame.require("albedo", 3) = grey(0.1f);
  frame.require("", 3) = image;
  // Bins of an eighth of a stop, twice
  EXPECT_NEAR(std::log2(display_exposure(frame) / display_exposure(grey(1.0f))), 0.0, 0.125);
}

TEST(Exposure, PassesOverWhatIsNoNumber) {
  Image image = grey(1.0f);
  const double before = display_exposure(image);
  image.at(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  image.at(1, 0)[1] = std::numeric_limits<float>::infinity();
  EXPECT_DOUBLE_EQ(display_exposure(image), before);
}

TEST(Exposure, IsOneForBlackPictures) {
  EXPECT_EQ(display_exposure(grey(0.0f)), 1.0);
  EXPECT_EQ(display_exposure(Image()), 1.0);
}

// Lit alike, a white surface is shown lighter than a mid-grey one, by half as many stops as it is.
TEST(Exposure, ShowsWhatIsWhiteAsLighterThanWhatIsGrey) {
  const auto shown = [](float albedo) {
    LayeredImage frame;
    frame.require("", 3) = grey(3.0f * albedo);
    frame.require("albedo", 3) = grey(albedo);
    return 3.0 * albedo * display_exposure(frame);
  };
  EXPECT_NEAR(std::log2(shown(0.8f) / 0.18), 0.5 * std::log2(0.8 / 0.18), 0.07);
  // What is dark, or of no albedo that is known, is brought to mid-grey
  EXPECT_NEAR(std::log2(shown(0.05f) / 0.18), 0.0, 0.07);
  LayeredImage sky;
  sky.require("", 3) = grey(2.0f);
  sky.require("albedo", 3) = grey(0.0f);
  EXPECT_EQ(display_exposure(sky), display_exposure(grey(2.0f)));
  sky.layers.pop_back();
  EXPECT_EQ(display_exposure(sky), display_exposure(grey(2.0f)));
}

// Metal, which has no albedo, is a surface; a lamp or what is seen through glass is not.
TEST(Exposure, CountsMetalAsASurface) {
  // Half of the picture is 3 stops darker, and counts in full where it is a surface
  const auto exposure = [](float albedo, float emission, float transmission, float normal = 0.5f) {
    LayeredImage frame;
    frame.require("", 3) = grey(1.0f);
    frame.require("albedo", 3) = grey(0.5f);
    frame.require("normal", 3) = grey(normal);
    frame.require("emission", 3) = grey(0.0f);
    frame.require("transmission", 3) = grey(0.0f);
    constexpr std::size_t kHalf = std::size_t{3} * 16 * 8;
    std::fill_n(frame.find("")->pixels.begin(), kHalf, 0.125f);
    std::fill_n(frame.find("albedo")->pixels.begin(), kHalf, albedo);
    std::fill_n(frame.find("emission")->pixels.begin(), kHalf, emission);
    std::fill_n(frame.find("transmission")->pixels.begin(), kHalf, transmission);
    return std::log2(display_exposure(frame));
  };
  const double surface = exposure(0.5f, 0.0f, 0.0f);
  EXPECT_EQ(exposure(0.0f, 0.0f, 0.0f), surface) << "metal";
  EXPECT_LT(exposure(0.0f, 0.125f, 0.0f), surface - 0.5) << "lamp";
  EXPECT_LT(exposure(0.0f, 0.0f, 0.1f), surface - 0.5) << "glass";
  EXPECT_LT(exposure(0.0f, 0.0f, 0.0f, 0.0f), surface - 0.5) << "fog before a black sky";
  // Nearly no albedo is that of metal, too
  EXPECT_NEAR(exposure(1e-4f, 0.0f, 0.0f), surface, 0.01);
  // Of a surface that glows, the greater part of its light decides: most lamps have an albedo
  EXPECT_EQ(exposure(0.5f, 0.05f, 0.0f), surface);
  EXPECT_LT(exposure(0.5f, 0.125f, 0.0f), surface - 0.5) << "lamp of a white material";
}

/// A dark stage, this share of which stands in light that is 7 stops brighter.
LayeredImage stage(double lit_share, float albedo) {
  constexpr int kEdge = 40;
  LayeredImage frame;
  frame.require("", 3) = grey(0.01f, kEdge);
  frame.require("albedo", 3) = grey(0.1f, kEdge);
  const auto lit = static_cast<std::size_t>(3 * lit_share * kEdge * kEdge);
  std::fill_n(frame.find("")->pixels.begin(), lit, 1.28f);
  std::fill_n(frame.find("albedo")->pixels.begin(), lit, albedo);
  return frame;
}

// What stands in a spot light is not burnt out; a small patch of sun may be, and so may the sky.
TEST(Exposure, ShowsWhatStandsInSpotLights) {
  const auto shown = [](const LayeredImage& frame) { return 1.28 * display_exposure(frame); };
  const double patch = shown(stage(0.08, 0.1f)), spot = shown(stage(0.12, 0.1f));
  EXPECT_NEAR(std::log2(shown(stage(0.08, 0.0f)) / patch), 0.0, 0.01) << "small";
  // What it would be above 3 stops over mid-grey lowers the exposure: by 2 stops, and half of the
  // rest
  const double lowered = 2.0 + 0.5 * (7.0 - 3.0 * 0.12 - 3.0 - 2.0);
  EXPECT_NEAR(std::log2(shown(stage(0.12, 0.0f)) / spot), lowered, 0.1) << "sky";
  EXPECT_NEAR(std::log2(spot / patch), -lowered - 3.0 * 0.04, 0.1);
  EXPECT_GE(std::log2(spot / 0.18), 3.0 - 0.07);
}

/// Makes the first `share` of a dark stage shine `stops` more than it, and send light in `layer`.
LayeredImage dark_stage_with(double share, double stops, const char* layer, float normal = 0.5f) {
  LayeredImage frame = stage(0.0, 0.1f);
  const int edge = frame.find("")->width;
  frame.require("normal", 3) = grey(normal, edge);
  frame.require("emission", 3) = grey(0.0f, edge);
  frame.require("transmission", 3) = grey(0.0f, edge);
  const auto count = 3 * static_cast<std::size_t>(share * edge * edge);
  const float bright = 0.01f * static_cast<float>(std::exp2(stops));
  std::fill_n(frame.find("")->pixels.begin(), count, bright);
  std::fill_n(frame.find(layer)->pixels.begin(), count, bright);
  std::fill_n(frame.find("albedo")->pixels.begin(), count, 0.0f);
  return frame;
}

// Signs that shine in the night leave it dark; a bulb, a lit room's tubes, and a sky do not.
TEST(Exposure, LeavesAStreetOfNeonSignsDark) {
  // What counts as 3 stops brighter than the median raises the typical luminance
  const auto lowered = [](double share, double stops, float normal = 0.5f) {
    return -std::log2(0.01 / 0.18 *
                      display_exposure(dark_stage_with(share, stops, "emission", normal))) -
           3.0 * share;
  };
  EXPECT_NEAR(lowered(0.03, 7.5 + 0.09), 0.5 * (7.5 - 5.0), 0.1);
  EXPECT_NEAR(lowered(0.03, 11.0 + 0.09), 2.0 + 0.5, 0.1) << "half of what is beyond 2 stops";
  EXPECT_NEAR(lowered(0.03, 25.0), 3.5, 0.1) << "at most 3.5 stops";
  EXPECT_NEAR(lowered(0.015, 7.5), 0.0, 0.1) << "bulb";
  EXPECT_NEAR(lowered(0.03, 5.0), 0.0, 0.1) << "tubes";
  EXPECT_NEAR(lowered(0.03, 7.5, 0.0f), 0.0, 0.1) << "sky";
}

// Coloured lamps are to be looked at, and fewer of them leave a room dark than of those that light
// it.
TEST(Exposure, IsLowerWhereASmallShareOfColoredLampsShines) {
  const auto lowered = [](const vec3& color, double share) {
    LayeredImage frame = dark_stage_with(share, 9.0, "emission");
    Image& picture = *frame.find("");
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      if (picture.pixels[i] > 1.0f) picture.pixels[i] *= color[static_cast<int>(i % 3)];
    }
    return -std::log2(0.01 / 0.18 * display_exposure(frame));
  };
  const vec3 white(1.0f), bulb(1.0f, 0.42f, 0.1f), candle(1.0f, 0.24f, 0.0f);
  const vec3 neon(1.0f, 0.1f, 0.4f), moss(0.3f, 1.0f, 0.5f);
  for (const vec3& color : {white, bulb, candle}) EXPECT_LT(lowered(color, 0.015), 0.1);
  for (const vec3& color : {neon, moss}) {
    EXPECT_GT(lowered(color, 0.015), 0.5);
    EXPECT_LT(lowered(color, 0.004), 0.1);
  }
}

// What stands in a case of glass that fills the picture is what the picture shows; windows are not.
TEST(Exposure, ShowsWhatIsInACaseOfGlass) {
  const auto shown = [](double share) {
    const LayeredImage frame = dark_stage_with(share, 6.0, "transmission");
    return std::log2(0.64 / 0.18 * display_exposure(frame));
  };
  // Half as many pixels as surfaces at most, each 3 stops brighter than the median
  EXPECT_NEAR(shown(0.4), 6.0 - 3.0 / 3.0, 0.1);
  // The median is in the case, and the stage counts as 5 stops darker
  EXPECT_NEAR(shown(0.6), 0.4 * 5.0, 0.1);
}

// However wide a sky is, it counts at most half as much as the land below it.
TEST(Exposure, DoesNotFollowAWideSky) {
  // The sky is 7 stops brighter, and counts as 3 stops brighter than the median
  const auto exposure = [](double sky_share) {
    return std::log2(display_exposure(stage(sky_share, 0.0f)));
  };
  EXPECT_NEAR(exposure(0.25), exposure(0.0) - 0.25 * 3.0, 0.07);
  EXPECT_NEAR(exposure(0.5), exposure(0.0) - 3.0 / 3.0, 0.07);
  EXPECT_NEAR(exposure(0.9), exposure(0.5), 0.07);
}

TEST(Exposure, TakesLampsOfAGreyPictureForWhite) {
  LayeredImage frame = dark_stage_with(0.015, 9.0, "emission");
  const float stops = display_stops(frame);
  Image& picture = *frame.find("");
  Image grey_picture(picture.width, picture.height, 1);
  for (std::size_t i = 0; i < grey_picture.pixels.size(); ++i) {
    grey_picture.pixels[i] = picture.pixels[3 * i];
  }
  picture = grey_picture;
  EXPECT_EQ(display_stops(frame), stops);
}

TEST(Exposure, IsTheSameByBands) {
  Image image(4, 8, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.1f * (i % 37);
  LuminanceHistogram histogram;
  for (int y = 0; y < image.height; ++y) {
    Image row(4, 1, 3);
    std::copy_n(image.at(0, y), 12, row.at(0, 0));
    histogram.add(row);
  }
  EXPECT_EQ(histogram.stops(), display_stops(image));
}

}  // namespace
}  // namespace lambent::exposure_test
