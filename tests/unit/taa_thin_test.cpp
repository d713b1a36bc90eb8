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

// The sky has no motion before a camera that walks.
TEST(ThinThings, LeaveNoLinesInTheSkyThatTheyPass) {
  constexpr float kSky = 1.0f, kDark = 0.1f;
  const PixelMotion sky{glm::vec2(0.0f), infinity(), infinity(), 1u};
  const PixelMotion passing{glm::vec2(2.0f, 0.0f), kPostDepth, kPostDepth, 1u};
  TaaSequence sequence;
  TemporalAntialiasing antialiasing;
  for (int i = 0; i < 12; ++i) {
    sequence.advance(kSide, kSide, {.moved = true, .edited = true});
    Image picture(kSide, kSide, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), kSky);
    std::vector<PixelMotion> motion(kSide * kSide, sky);
    const int column = kSide + 2 - 2 * i;
    for (int y = 0; y < kSide && column >= 0 && column < kSide; ++y) {
      std::fill_n(picture.at(column, y), 3, kDark);
      motion[y * kSide + column] = passing;
    }
    antialiasing.resolve(sequence.frame(), motion, picture);
    for (int x = std::max(column + 4, 0); x < kSide; ++x) {
      EXPECT_NEAR(picture.at(x, kSide / 2)[1], kSky, 0.02f) << i << ", " << x;
    }
  }
}

}  // namespace
}  // namespace lambent::taa_thin_test
