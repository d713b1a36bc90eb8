// SPDX-License-Identifier: Apache-2.0
// How pictures follow the pace of clients and of this machine.
#include "stream/pace/pace.h"

#include <gtest/gtest.h>

#include "stream/server/rate_limit.h"

namespace lambent::stream::pace_test {
namespace {

const PaceLimits kLimits{{1280, 720}, 30.0f, 20'000'000, 250.0};

TEST(Pace, HoldsWhatIsAskedForToTheLimits) {
  const Pace pace(kLimits, {4000, 2250}, 120.0f);
  EXPECT_EQ(pace.size(), glm::uvec2(1280, 720));
  EXPECT_EQ(pace.rate(), 30.0f);
  const Pace small(kLimits, {101, 55}, 5.0f);
  EXPECT_EQ(small.size() % 2u, glm::uvec2(0));
  EXPECT_EQ(small.rate(), 5.0f);
}

TEST(Pace, SpendsFewerBitsWhilePicturesWaitInLine) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 20.0);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 5; ++i) pace.delivered(500.0, 500.0);
  EXPECT_LT(pace.bitrate(), before / 2);
  for (int i = 0; i < 100; ++i) pace.delivered(20.0, 20.0);
  EXPECT_GT(pace.bitrate(), before / 2);
  EXPECT_LE(pace.bitrate(), kLimits.bitrate);
}

TEST(Pace, ALongPathIsNoReasonToSpendFewer) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 20; ++i) pace.delivered(300.0, 300.0);
  EXPECT_GE(pace.bitrate(), before);
}

TEST(Pace, AMachineThatIsBusyIsNoReasonToSpendFewer) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 2.0);
  const std::uint32_t before = pace.bitrate();
  for (int i = 0; i < 50; ++i) {
    // The client decodes late, and its system tells late of what has come
    pace.delivered(800.0, 44.0);
    pace.made(20.0);
  }
  EXPECT_GE(pace.bitrate(), before);
  EXPECT_EQ(pace.size(), glm::uvec2(640, 360));
  EXPECT_GT(pace.round_trip_ms(), 700.0);
}

TEST(Pace, APathWithoutRoomMakesPicturesSmaller) {
  Pace pace(kLimits, {640, 360}, 30.0f);
  for (int i = 0; i < 10; ++i) pace.delivered(20.0, 2.0);
  for (int i = 0; i < 50; ++i) {
    pace.delivered(800.0, 780.0);
    pace.made(20.0);
  }
  EXPECT_LT(pace.size().x, 640u);
}

TEST(Pace, PicturesShrinkWhereRenderingIsSlowAndGrowAgain) {
  Pace pace(kLimits, {1280, 720}, 30.0f);
  for (int i = 0; i < 20; ++i) pace.made(1000.0);
  EXPECT_LT(pace.size().x, 640u);
  for (int i = 0; i < 1000; ++i) {
    pace.made(10.0);
    pace.delivered(20.0, 20.0);
  }
  EXPECT_EQ(pace.size(), glm::uvec2(1280, 720));
}

TEST(Pace, PicturesShrinkWhereBitsAreTooFew) {
  Pace pace({{1280, 720}, 30.0f, 300'000, 250.0}, {1280, 720}, 30.0f);
  for (int i = 0; i < 10; ++i) pace.made(20.0);
  EXPECT_LT(pace.size().x, 1280u);
  EXPECT_LE(pace.bitrate(), 300'000u);
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
