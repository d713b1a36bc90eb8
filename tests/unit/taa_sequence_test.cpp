// SPDX-License-Identifier: Apache-2.0
// How temporal anti-aliasing counts the frames of a sequence.
#include <gtest/gtest.h>

#include "temporal/taa.h"

namespace lambent::taa_sequence_test {
namespace {

TEST(TaaSequence, ForgetsOtherSamplesWhereSomethingBeginsToMove) {
  TaaSequence sequence;
  const auto keeps = [&](std::size_t moving) {
    sequence.advance(8, 8, {.edited = moving > 0, .moving = moving});
    return sequence.frame().keeps_others != 0;
  };
  keeps(0);
  EXPECT_TRUE(keeps(0));
  EXPECT_FALSE(keeps(2));
  EXPECT_TRUE(keeps(2)) << "it goes on";
  EXPECT_TRUE(keeps(0)) << "the world is updated in every second frame";
  EXPECT_TRUE(keeps(2));
  EXPECT_FALSE(keeps(4)) << "another thing begins";
  for (unsigned i = 0; i <= kFramesUntilStill; ++i) EXPECT_TRUE(keeps(0));
  EXPECT_FALSE(keeps(2));
}

// What made the scene's pose counts as moved before the first frame, in as many boxes as later.
TEST(TaaSequence, TakesWhatMovesAfterTheFirstFramesToBegin) {
  TaaSequence sequence;
  const auto keeps = [&](const FrameChange& change) {
    sequence.advance(8, 8, change);
    return sequence.frame().keeps_others != 0;
  };
  keeps({.edited = true, .moving = 2});
  EXPECT_TRUE(keeps({}));
  EXPECT_FALSE(keeps({.edited = true, .moving = 2}));
  EXPECT_TRUE(keeps({.edited = true, .moving = 2})) << "it goes on";
  keeps({.same_size = false, .edited = true, .moving = 2});
  EXPECT_FALSE(keeps({.edited = true, .moving = 2})) << "the first frame of another size";
}

TEST(TaaSequence, HoldsTheHistoryLessTheLongerNothingMoves) {
  TaaSequence sequence;
  sequence.advance(8, 8, {});
  EXPECT_EQ(sequence.frame().has_history, 0u);
  for (unsigned i = 1; i <= kFramesUntilStill; ++i) {
    EXPECT_EQ(sequence.frame().clip_deviations, kClipDeviations);
    sequence.advance(8, 8, {});
    EXPECT_EQ(sequence.index(), i);
  }
  EXPECT_EQ(sequence.frame().clip_deviations, 0.0f);
  EXPECT_EQ(sequence.frame().most_frames, kStillHistoryFrames);
  sequence.advance(8, 8, {.moved = true});
  EXPECT_EQ(sequence.frame().clip_deviations, kLooseClipDeviations);
  EXPECT_EQ(sequence.frame().most_frames, kRestingHistoryFrames);
  EXPECT_EQ(sequence.frame().has_history, 1u);
  sequence.advance(8, 8, {.edited = true});
  EXPECT_EQ(sequence.frame().clip_deviations, kClipDeviations);
  EXPECT_EQ(sequence.frame().most_frames, kRestingHistoryFrames);
  sequence.advance(8, 8, {.same_size = false});
  EXPECT_EQ(sequence.frame().has_history, 0u);
  EXPECT_EQ(sequence.index(), 0u);
}

}  // namespace
}  // namespace lambent::taa_sequence_test
