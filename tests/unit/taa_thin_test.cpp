// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing of things thinner than a pixel, which some frames' samples miss.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "temporal/taa.h"

namespace lambent::taa_thin_test {
namespace {

constexpr int kSide = 9;
constexpr int kColumn = 4;
constexpr float kCovered = 0.4f;  // share of that column's pixels
constexpr float kPost = 1.0f, kWall = 0.1f, kPostDepth = 2.0f, kWallDepth = 5.0f;

/// Frames of a bright post in front of a dark wall, seen by a camera at rest.
class PostSequence {
 public:
  /// The next frame, whose light differs from the previous one's if `relit`: what it shows where
  /// the post stands.
  float next(float light, bool relit) {
    sequence_.advance(kSide, kSide, {.edited = relit, .relit = relit});
    const bool met = jitter_position(sequence_.index()).x < kCovered;
    Image picture(kSide, kSide, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), light * kWall);
    std::vector<PixelMotion> motion(kSide * kSide, {glm::vec2(0.0f), kWallDepth, kWallDepth, 1u});
    for (int y = 0; met && y < kSide; ++y) {
      std::fill_n(picture.at(kColumn, y), 3, light * kPost);
      motion[y * kSide + kColumn].depth = motion[y * kSide + kColumn].depth_before = kPostDepth;
    }
    antialiasing_.resolve(sequence_.frame(), motion, picture);
    return picture.at(kColumn, kSide / 2)[1];
  }

 private:
  TaaSequence sequence_;
  TemporalAntialiasing antialiasing_;
};

TEST(ThinThings, HardlyFlickersWhileLightChangesSlowly) {
  PostSequence post;
  float least = 1e9f, most = 0.0f, light = 1.0f;
  for (int i = 0; i < 64; ++i) {
    light *= 0.99f;
    const float shown = post.next(light, true) / light;
    if (i < 16) continue;
    least = std::min(least, shown);
    most = std::max(most, shown);
  }
  const float right = kCovered * kPost + (1.0f - kCovered) * kWall;
  EXPECT_GT(least, 0.75f * right);
  EXPECT_LT(most, 1.3f * right);
}

TEST(ThinThings, FollowsLightThatGoesOut) {
  // The post or the wall, which the last frame in the light met
  for (int frames = 16; frames < 32; ++frames) {
    PostSequence post;
    float lit = 0.0f, dark = 0.0f;
    for (int i = 0; i < frames; ++i) lit = post.next(1.0f, i % 2 == 0);
    for (int i = 0; i < 4; ++i) dark = post.next(0.01f, i == 0);
    EXPECT_LT(dark, 0.03f * lit) << frames;
  }
}

TEST(ThinThings, FollowsLightThatComesOn) {
  for (int frames = 16; frames < 32; ++frames) {
    PostSequence post;
    float shown = 0.0f;
    for (int i = 0; i < frames; ++i) post.next(0.01f, i % 2 == 0);
    for (int i = 0; i < 6; ++i) shown = post.next(1.0f, i == 0);
    EXPECT_GT(shown, 0.9f * kWall) << frames;
  }
}

TEST(ThinThings, OutliveLightThatFlickers) {
  PostSequence post;
  float least = 1e9f;
  for (int i = 0; i < 64; ++i) {
    const float light = i % 3 == 1 ? 0.3f : 1.0f;
    const float shown = post.next(light, true) / light;
    if (i >= 32) least = std::min(least, shown);
  }
  EXPECT_GT(least, 1.2f * kWall);
}

// A lamp rests before a wall, so that pixels at its edges have met both, and then moves away.
TEST(ThinThings, LeaveNoOutlineWhereTheyBeginToMove) {
  constexpr float kLamp = 40.0f, kEdge = 3.4f, kStep = 4.0f;
  TaaSequence sequence;
  TemporalAntialiasing antialiasing;
  const auto next = [&](float right, bool moves) {
    sequence.advance(kSide, kSide, {.edited = moves, .moving = moves ? 1u : 0u});
    const float jitter = jitter_position(sequence.index()).x;
    Image picture(kSide, kSide, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), kWall);
    std::vector<PixelMotion> motion(kSide * kSide, {glm::vec2(0.0f), kWallDepth, kWallDepth, 1u});
    for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
      if (static_cast<float>(pixel % kSide) + jitter >= right) continue;
      std::fill_n(&picture.pixels[3 * static_cast<std::size_t>(pixel)], 3, kLamp);
      motion[pixel] = {glm::vec2(moves ? kStep : 0.0f, 0.0f), kPostDepth, kPostDepth,
                       moves ? kObjectMotion : 1u};
    }
    antialiasing.resolve(sequence.frame(), motion, picture);
    float brightest = 0.0f;
    for (int x = std::max(0, static_cast<int>(right) + 1); x < kSide; ++x) {
      brightest = std::max(brightest, picture.at(x, kSide / 2)[1]);
    }
    return brightest;
  };
  for (int i = 0; i < 7; ++i) next(kEdge, false);
  for (int i = 1; i < 4; ++i) {
    EXPECT_LT(next(kEdge - kStep * static_cast<float>(i), true), 1.05f * kWall) << i;
  }
}

// Samples of a lamp about two pixels wide meet it or the wall behind, and what is around them may
// look like an edge in the frame that comes back to it. Once it is dimmed, pixels that show it must
// not keep their old light.
TEST(ThinThings, DimWithTheirLightBesideEdges) {
  constexpr float kLamp = 100.0f, kDimmed = 0.2f;
  // Clipping leaves up to mean + kClipDeviations standard deviations: of any share of lit pixels in
  // the neighbourhood at most 1.3 times the lamp
  constexpr float kMostOverLamp = 1.31f;
  for (int frames = 8; frames < 40; ++frames) {
    TaaSequence sequence;
    TemporalAntialiasing antialiasing;
    float brightest = 0.0f;
    for (int i = 0; i <= frames; ++i) {
      const float light = i == frames ? kDimmed : 1.0f;
      sequence.advance(kSide, kSide, {.edited = true, .relit = true});
      const glm::vec2 jitter = jitter_position(sequence.index());
      Image picture(kSide, kSide, 3);
      std::fill(picture.pixels.begin(), picture.pixels.end(), light * kWall);
      std::vector<PixelMotion> motion(kSide * kSide, {glm::vec2(0.0f), kWallDepth, kWallDepth, 1u});
      for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
        const glm::vec2 place = glm::vec2(pixel % kSide, pixel / kSide) + jitter;
        if (place.x < 3.3f || place.x > 5.1f || place.y < 2.4f || place.y > 5.6f) continue;
        std::fill_n(&picture.pixels[3 * static_cast<std::size_t>(pixel)], 3, light * kLamp);
        motion[pixel].depth = motion[pixel].depth_before = kPostDepth;
      }
      antialiasing.resolve(sequence.frame(), motion, picture);
      brightest = 0.0f;
      for (int pixel = 0; pixel < kSide * kSide; ++pixel) {
        if (motion[pixel].depth != kPostDepth) continue;
        brightest = std::max(brightest, picture.pixels[3 * static_cast<std::size_t>(pixel)]);
      }
    }
    EXPECT_LT(brightest, kMostOverLamp * kDimmed * kLamp) << frames;
  }
}

// The sky has no motion before a camera that walks. A post passes by many pixels a frame, and the
// samples at its edges meet either.
TEST(ThinThings, LeaveNoLinesInTheSkyThatTheyPass) {
  constexpr int kWide = 160, kRows = 5;
  constexpr float kSky = 1.0f, kDark = 0.1f, kStep = 11.3f, kPostWidth = 3.5f;
  const PixelMotion sky{glm::vec2(0.0f), infinity(), infinity(), 1u};
  const PixelMotion passing{glm::vec2(kStep, 0.0f), kPostDepth, kPostDepth, 1u};
  TaaSequence sequence;
  TemporalAntialiasing antialiasing;
  for (int i = 0; i < 16; ++i) {
    sequence.advance(kWide, kRows, {.moved = true, .edited = true});
    const float left = static_cast<float>(kWide) - kStep * static_cast<float>(i);
    const float jitter = jitter_position(sequence.index()).x;
    Image picture(kWide, kRows, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), kSky);
    std::vector<PixelMotion> motion(kWide * kRows, sky);
    for (int pixel = 0; pixel < kWide * kRows; ++pixel) {
      const float place = static_cast<float>(pixel % kWide) + jitter;
      if (place < left || place >= left + kPostWidth) continue;
      std::fill_n(&picture.pixels[3 * static_cast<std::size_t>(pixel)], 3, kDark);
      motion[pixel] = passing;
    }
    antialiasing.resolve(sequence.frame(), motion, picture);
    for (int x = static_cast<int>(left + kPostWidth) + 4; x < kWide; ++x) {
      EXPECT_NEAR(picture.at(x, kRows / 2)[1], kSky, 0.02f) << i << ", " << x;
    }
  }
}

}  // namespace
}  // namespace lambent::taa_thin_test
