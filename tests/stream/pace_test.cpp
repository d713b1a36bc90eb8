// SPDX-License-Identifier: Apache-2.0
// How pictures follow the pace of clients and of this machine.
#include "stream/pace/pace.h"

#include <gtest/gtest.h>

#include "stream/server/rate_limit.h"

namespace lambent::stream::pace_test {
namespace {

const PaceLimits kLimits{{1280, 720}, 30.0f, 20'000'000, 250.0};
// Time of a pixel on a machine that all sizes are fast enough for [ms].
constexpr double kFast = 1e-5;

/// Reports pictures of any size that took as long as this.
void make(Pace& pace, int pictures, double ms) {
  for (int i = 0; i < pictures; ++i) pace.made(pace.size(), ms);
}

/// Reports pictures whose pixels take as long as this [ms].
void make_by_pixels(Pace& pace, int pictures, double ms_a_pixel) {
  for (int i = 0; i < pictures; ++i) {
    const glm::dvec2 size(pace.size());
    pace.made(pace.size(), ms_a_pixel * size.x * size.y);
  }
}

TEST(Pace, HoldsWhatIsAskedForToTheLimits) {
  const Pace pace(kLimits, {4000, 2250}, 120.0f, kFast);
  EXPECT_EQ(pace.size(), glm::uvec2(1280, 720));
  EXPECT_EQ(pace.rate(), 30.0f);
  const Pace small(kLimits, {101, 55}, 5.0f);
  EXPECT_EQ(small.size() % 2u, glm::uvec2(0));
  EXPECT_EQ(small.rate(), 5.0f);
}

TEST(Pace, SpendsFewerBitsWhilePicturesWaitInLine) {
  Pace pace(kLimits, {640, 360}, 30.0f, kFast);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 20.0);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 5; ++i) pace.delivered(500.0, 500.0);
  EXPECT_LT(pace.bitrate(), before / 2);
  for (int i = 0; i < 100; ++i) pace.delivered(20.0, 20.0);
  EXPECT_GT(pace.bitrate(), before / 2);
  EXPECT_LE(pace.bitrate(), kLimits.bitrate);
}

TEST(Pace, ALongPathIsNoReasonToSpendFewer) {
  Pace pace(kLimits, {640, 360}, 30.0f, kFast);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 20; ++i) pace.delivered(300.0, 300.0);
  EXPECT_GE(pace.bitrate(), before);
}

TEST(Pace, AMachineThatIsBusyIsNoReasonToSpendFewer) {
  Pace pace(kLimits, {640, 360}, 30.0f, kFast);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 2.0);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 50; ++i) {
    // The client decodes late, and its system tells late of what has come
    pace.delivered(800.0, 44.0);
    make(pace, 1, 20.0);
  }
  EXPECT_GE(pace.bitrate(), before);
  EXPECT_EQ(pace.size(), glm::uvec2(640, 360));
  EXPECT_GT(pace.round_trip_ms(), 700.0);
}

TEST(Pace, APathWithoutRoomMakesPicturesSmaller) {
  Pace pace(kLimits, {640, 360}, 30.0f, kFast);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 2.0);
  for (int i = 0; i < 50; ++i) {
    pace.delivered(800.0, 780.0);
    make(pace, 1, 20.0);
  }
  EXPECT_LT(pace.size().x, 640u);
}

TEST(Pace, PicturesShrinkWhereRenderingIsSlowAndGrowAgain) {
  Pace pace(kLimits, {1280, 720}, 30.0f, kFast);
  make(pace, 20, 1000.0);
  EXPECT_LT(pace.size().x, 640u);
  for (int i = 0; i < 1000; ++i) {
    make(pace, 1, 10.0);
    pace.delivered(20.0, 20.0);
  }
  EXPECT_EQ(pace.size(), glm::uvec2(1280, 720));
}

TEST(Pace, PicturesShrinkWhereBitsAreTooFew) {
  Pace pace({{1280, 720}, 30.0f, 300'000, 250.0}, {1280, 720}, 30.0f, kFast);
  make(pace, 10, 20.0);
  EXPECT_LT(pace.size().x, 1280u);
  EXPECT_LE(pace.bitrate(), 300'000u);
}

TEST(Pace, ClientsBeginSmallWhereNothingIsKnownAndGrowAsSoonAsLargerPicturesFit) {
  Pace pace(kLimits, {1280, 720}, 30.0f);
  EXPECT_EQ(pace.size(), glm::uvec2(320, 180));
  // What is asked for takes 92 ms
  make_by_pixels(pace, 5, 1e-4);
  EXPECT_EQ(pace.size(), glm::uvec2(1280, 720));
  const Pace little(kLimits, {64, 48}, 30.0f);
  EXPECT_EQ(little.size(), glm::uvec2(64, 48));
}

TEST(Pace, ClientsBeginWithTheSizeThatFitsByWhatIsKnownOfOthers) {
  // 640x360 takes 115 ms, which leaves as much for other clients
  const Pace pace(kLimits, {1280, 720}, 30.0f, 5e-4);
  EXPECT_EQ(pace.size(), glm::uvec2(640, 360));
}

TEST(Pace, GoesToTheSizeThatFitsInOneStep) {
  Pace pace(kLimits, {1280, 720}, 30.0f, kFast);
  ASSERT_EQ(pace.size(), glm::uvec2(1280, 720));
  // 1280x720 takes 9.2 s, and 320x180 0.6 s
  make_by_pixels(pace, 1, 0.01);
  EXPECT_EQ(pace.size(), glm::uvec2(320, 180));
  Pace larger(kLimits, {1280, 720}, 30.0f, kFast);
  // 960x540 takes 259 ms, 640x360 115 ms
  make_by_pixels(larger, 1, 5e-4);
  EXPECT_EQ(larger.size(), glm::uvec2(640, 360));
}

TEST(Pace, GrowsSoonAfterLoadHasEnded) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  make_by_pixels(pace, 100, 3e-4);
  ASSERT_EQ(pace.size(), glm::uvec2(640, 360));
  make_by_pixels(pace, 20, 0.01);
  ASSERT_EQ(pace.size(), glm::uvec2(160, 90));
  // What the load took is forgotten after some pictures, even if one of them is slow by chance
  make_by_pixels(pace, 8, 3e-4);
  make_by_pixels(pace, 1, 2e-3);
  make_by_pixels(pace, 16, 3e-4);
  EXPECT_EQ(pace.size(), glm::uvec2(640, 360));
}

TEST(Pace, SizesDoNotGoUpAndDownWhereLoadDoes) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  int changes = 0;
  for (int second = 0; second < 60; ++second) {
    const glm::uvec2 before = pace.size();
    make_by_pixels(pace, 10, second % 2 == 0 ? 1e-4 : 5e-3);
    if (pace.size() != before) ++changes;
  }
  EXPECT_LT(changes, 20) << "of 120 where pictures grew after a few";
}

TEST(Pace, AnotherRequestIsServedInTheSizeThatFits) {
  Pace pace(kLimits, {64, 48}, 30.0f);
  make_by_pixels(pace, 10, 0.01);
  ASSERT_EQ(pace.size(), glm::uvec2(64, 48));
  pace.ask({1280, 720}, 30.0f);
  EXPECT_EQ(pace.size(), glm::uvec2(320, 180));
  EXPECT_EQ(pace.asked_size(), glm::uvec2(1280, 720));
  pace.ask({64, 48}, 30.0f);
  EXPECT_EQ(pace.size(), glm::uvec2(64, 48));
}

TEST(RateLimit, LetsBurstsPassAndThenTheRate) {
  const Clock::time_point start;
  RateLimit limit(10.0, 5.0, start);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(limit.pass(start));
  EXPECT_FALSE(limit.pass(start));
  EXPECT_TRUE(limit.pass(start + std::chrono::milliseconds(110)));
  EXPECT_FALSE(limit.pass(start + std::chrono::milliseconds(120)));
  // However long nothing came
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(limit.pass(start + std::chrono::hours(1)));
  EXPECT_FALSE(limit.pass(start + std::chrono::hours(1)));
}

}  // namespace
}  // namespace lambent::stream::pace_test
