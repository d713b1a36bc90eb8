// SPDX-License-Identifier: Apache-2.0
// The noise of light that is averaged over frames, and what the filter makes of it.
#include "compose/history/noise_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "shared/color.h"
#include "support/noisy_wall.h"

namespace lambent::noise_history_test {
namespace {

using test::one_in_eight;
using test::Wall;

constexpr float kMaxFrames = 10.0f;

/// A wall whose light is averaged over frames while it slides through the picture.
class SlidingWall {
 public:
  /// `step`: how far it slides from frame to frame [pixels], 0 to below 1.
  explicit SlidingWall(float step) : step_(step) {
    noise_.resize(wall.light.size(), /*samples_measure=*/false);
    frames_.assign(wall.light.size(), 0.0f);
    wall.history_variance.assign(wall.light.size(), 0.0f);
  }

  /// Adds a frame in which each pixel has a random light of mean `level`; `changes`: it is known
  /// that this is another level than before.
  void add_frame(float level = 1.0f, bool changes = false) {
    const std::vector<vec3> before = wall.light;
    const NoiseHistory last = noise_;
    const std::vector<float> frames_before = frames_;
    wall.set_light([&](int, int, float u) { return level * one_in_eight(u); }, ++frame_);
    for (std::size_t i = 0; i < wall.light.size(); ++i) {
      const HistoryTaps taps = frame_ > 1 ? taps_of(static_cast<int>(i)) : no_history();
      float& frames = frames_[i] = 1.0f;
      if (is_history(taps)) {
        frames = averaged_frames(weighted_sum(frames_before, taps), kMaxFrames);
      }
      vec3& light = wall.light[i];
      const vec3 average = weighted_sum(before, taps);
      const AveragedPixel pixel{i, taps, luminance(light - average), frames, changes};
      average_noise(last, pixel, {measured_, wall.history_variance}, noise_);
      light = mix(average, light, 1.0f / frames);
    }
  }

  /// Standard deviation of red from that of the wall's light, which is 1.
  double deviation_of(const std::vector<vec3>& light) const {
    double sum = 0.0;
    for (const vec3& each : light) sum += (each.x - 1.0) * (each.x - 1.0);
    return std::sqrt(sum / static_cast<double>(light.size()));
  }

  Wall wall{160, 120};

 private:
  HistoryTaps taps_of(int pixel) const {
    HistoryTaps taps = no_history();
    const int x = pixel % wall.width;
    if (step_ > 0.0f && x + 1 == wall.width) return taps;  // what slides into the picture
    taps.pixels[0] = pixel, taps.weights[0] = 1.0f - step_;
    if (step_ > 0.0f) taps.pixels[1] = pixel + 1, taps.weights[1] = step_;
    return taps;
  }

  float step_;
  std::uint32_t frame_ = 0;
  std::vector<float> frames_;  // in the average of each pixel
  NoiseHistory noise_;
  std::vector<float> measured_;  // no samples measure variances
};

TEST(NoiseHistory, KnowsTheVarianceOfAverages) {
  for (const int frames : {2, 5, 40}) {
    SlidingWall still(0.0f);
    for (int i = 0; i < frames; ++i) still.add_frame();
    double estimate = 0.0, spread = 0.0;
    const vec3 mean = vec3(1.0f, 0.5f, 0.25f);
    for (std::size_t i = 0; i < still.wall.light.size(); ++i) {
      const double off = luminance(still.wall.light[i] - mean);
      spread += off * off;
      estimate += still.wall.history_variance[i];
    }
    EXPECT_NEAR(estimate, spread, 0.05 * spread) << frames << " frames";
  }
}

TEST(NoiseHistory, DoesNotTakeLightThatChangesForNoise) {
  SlidingWall wall(0.0f);
  for (int i = 0; i < 40; ++i) wall.add_frame();
  const auto total = [&] {
    double sum = 0.0;
    for (const float variance : wall.wall.history_variance) sum += variance;
    return sum;
  };
  const double before = total();
  wall.add_frame(20.0f, /*changes=*/true);
  EXPECT_NEAR(total(), before, 0.02 * before);
}

TEST(NoiseHistory, IsTheSquaredLuminanceInAFirstFrame) {
  SlidingWall wall(0.0f);
  wall.add_frame();
  for (std::size_t i = 0; i < wall.wall.light.size(); ++i) {
    const float level = luminance(wall.wall.light[i]);
    ASSERT_EQ(wall.wall.history_variance[i], level * level);
  }
}

TEST(NoiseHistory, KeepsMottlesOffWhatSlidesThroughThePicture) {
  SlidingWall sliding(0.5f);
  for (int i = 0; i < 20; ++i) sliding.add_frame();
  const double with = sliding.deviation_of(sliding.wall.filtered());
  sliding.wall.history_variance.clear();
  const double without = sliding.deviation_of(sliding.wall.filtered());
  std::printf("deviation after 20 frames: %.4f, %.4f with noise estimated from neighbours\n", with,
              without);
  EXPECT_LT(with, 0.6 * without);
}

}  // namespace
}  // namespace lambent::noise_history_test
