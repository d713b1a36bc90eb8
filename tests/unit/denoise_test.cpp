// SPDX-License-Identifier: Apache-2.0
#include "lambent/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "shared/color.h"
#include "shared/random.h"
#include "support/noisy_wall.h"

namespace lambent::denoise_test {
namespace {

using test::kLitShare;
using test::one_in_eight;
using test::Wall;

/// Mean of red, and the standard deviation from a known value.
struct Spread {
  double mean = 0.0, deviation = 0.0;
};
Spread spread_of(const std::vector<vec3>& light, double known) {
  Spread spread;
  for (const vec3& e : light) {
    spread.mean += e.x / static_cast<double>(light.size());
    spread.deviation += (e.x - known) * (e.x - known) / static_cast<double>(light.size());
  }
  spread.deviation = std::sqrt(spread.deviation);
  return spread;
}

TEST(Denoise, TakesNoiseOffAndKeepsTheMean) {
  Wall wall(160, 120);
  wall.set_light([](int, int, float u) { return one_in_eight(u); });
  const Spread before = spread_of(wall.light, 1.0), after = spread_of(wall.filtered(), 1.0);
  EXPECT_GT(before.deviation, 2.0);
  EXPECT_LT(after.deviation, 0.12);
  EXPECT_NEAR(after.mean, before.mean, 0.03 * before.mean);
}

// One bad pixel would make a block of all that the filter reaches.
TEST(Denoise, DoesNotSpreadWhatIsNoNumber) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Wall wall(70, 40);
  wall.set_light([](int, int, float) { return vec3(1.0f); });
  wall.base = wall.light;
  wall.variance.assign(wall.light.size(), 0.01f);
  wall.light[wall.at(20, 10)] = vec3(1.0f, kNan, 1.0f);
  wall.light[wall.at(50, 20)] = vec3(kInfinity);
  wall.base[wall.at(35, 30)] = vec3(-kInfinity);
  wall.variance[wall.at(5, 5)] = kNan;
  const std::vector<vec3> filtered = wall.filtered();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_TRUE(filtered[i].x >= 0.0f && filtered[i].y >= 0.0f && filtered[i].x < 3.0f) << i;
  }
  constexpr int kApart = 3;  // pixels, from where on hardly any of the dark one is left
  EXPECT_NEAR(filtered[wall.at(20 + kApart, 10)].y, 1.0f, 0.1f);
}

TEST(Denoise, LeavesLightWithoutNoiseAsItIs) {
  Wall wall(70, 40);
  wall.set_light(
      [](int x, int y, float) { return vec3(x > 30 ? 2.0f : 0.5f, y > 17 ? 1.0f : 3.0f, 1.0f); });
  wall.variance.assign(wall.light.size(), 0.0f);
  DenoiseSettings settings = emitter_denoising();
  const std::vector<vec3> filtered = wall.filtered(settings);
  for (int y = 0; y < wall.height; ++y) {
    for (int x = 0; x < wall.width; ++x) {
      // The first pass knows no light and takes in the next pixel
      if (std::abs(x - 30) <= 2 || std::abs(y - 17) <= 2) continue;
      EXPECT_NEAR(filtered[wall.at(x, y)].x, wall.light[wall.at(x, y)].x, 1e-4f) << x << " " << y;
    }
  }
}

TEST(Denoise, WithLevelsLeavesLightWithoutNoiseAsItIsUpToItsEdges) {
  Wall wall(70, 40);
  wall.set_light([](int x, int, float) { return vec3(x > 30 ? 1.0f : 0.25f); });
  wall.variance.assign(wall.light.size(), 0.0f);
  wall.levels.assign(wall.light.size(), 2.0f);
  const std::vector<vec3> filtered = wall.filtered(emitter_denoising());
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, wall.light[i].x, 1e-5f) << i;
  }
}

/// A wall of light 1 that is known well, with one pixel of light 100 in its middle whose standard
/// error is `error`.
Wall wall_with_a_bright_pixel(float error) {
  Wall wall(150, 150);
  wall.set_light([](int, int, float u) { return vec3(0.9f + 0.2f * u); });
  wall.levels.assign(wall.light.size(), 1.0f);
  wall.variance.assign(wall.light.size(), 0.01f);
  wall.light[wall.at(75, 75)] = vec3(100.0f);
  wall.variance[wall.at(75, 75)] = error * error;
  return wall;
}

TEST(Denoise, SpreadsWhatASingleRareSampleBrought) {
  // Passes that compare light left 100 in that pixel, whose neighbours are known better
  const std::vector<vec3> filtered = wall_with_a_bright_pixel(100.0f).filtered(emitter_denoising());
  float most = 0.0f;
  for (const vec3& light : filtered) most = std::max(most, light.x);
  EXPECT_LT(most, 3.0f);
  EXPECT_NEAR(spread_of(filtered, 1.0).mean, 1.0 + 99.0 / (150.0 * 150.0), 1e-3);
}

TEST(Denoise, KeepsSmallLightsThatSamplesAgreeOn) {
  const Wall wall = wall_with_a_bright_pixel(5.0f);
  EXPECT_GT(wall.filtered(emitter_denoising())[wall.at(75, 75)].x, 90.0f);
}

TEST(Denoise, KeepsGradientsNearLampsThatAreInTheLevels) {
  // A lamp two pixels above the wall, half of whose light is occluded
  Wall wall(96, 64);
  std::vector<float> lamp;
  for (int y = 0; y < wall.height; ++y) {
    for (int x = 0; x < wall.width; ++x) {
      const auto u = static_cast<float>(x - 48), v = static_cast<float>(y - 32);
      lamp.push_back(16.0f / ((u * u + v * v + 4.0f) * (u * u + v * v + 4.0f)));
    }
  }
  RandomStream random = make_random_stream(5, 6, 7);
  for (vec3& e : wall.light) e = vec3(next_uniform(random));  // of what is sent, 0.5 on average
  wall.variance.assign(wall.light.size(), 1.0f / 12.0f);
  Wall plain = wall;
  wall.levels = lamp;
  for (std::size_t i = 0; i < lamp.size(); ++i) {
    plain.light[i] *= lamp[i];
    plain.variance[i] *= lamp[i] * lamp[i];
  }
  const std::vector<vec3> by_levels = wall.filtered(emitter_denoising());
  const std::vector<vec3> without = plain.filtered(emitter_denoising());
  double error = 0.0, error_without = 0.0;
  for (std::size_t i = 0; i < lamp.size(); ++i) {
    error += std::pow(lamp[i] * by_levels[i].x - 0.5f * lamp[i], 2.0);
    error_without += std::pow(without[i].x - 0.5f * lamp[i], 2.0);
  }
  EXPECT_LT(error, 0.4 * error_without);
}

TEST(Denoise, TakesLittleFromWhereTheLevelIsFarLower) {
  // To the left next to nothing arrives, and chance says three times as much
  Wall wall(64, 48);
  wall.levels.assign(wall.light.size(), 1.0f);
  wall.set_light([](int x, int, float) { return vec3(x < 32 ? 3.0f : 1.0f); });
  for (int y = 0; y < wall.height; ++y) {
    for (int x = 0; x < 32; ++x) wall.levels[wall.at(x, y)] = 1e-3f;
  }
  DenoiseSettings geometric = emitter_denoising();
  geometric.geometric_passes = geometric.passes;
  const std::vector<vec3> filtered = wall.filtered(geometric);
  for (int y = 0; y < wall.height; ++y) {
    EXPECT_NEAR(filtered[wall.at(32, y)].x, 1.0f, 0.01f);
    // The other way round it counts fully
    EXPECT_LT(filtered[wall.at(31, y)].x, 2.5f);
  }
}

TEST(Denoise, KeepsLightOfOneSurfaceFromAnother) {
  // A step in depth, a corner, and a hole that shows nothing
  Wall wall(96, 64);
  for (int y = 0; y < wall.height; ++y) {
    for (int x = 0; x < wall.width; ++x) {
      const std::size_t i = wall.at(x, y);
      if (x >= 32) wall.positions[i].z -= 0.1f;
      if (x >= 64) wall.normals[i] = vec3(1.0f, 0.0f, 0.0f);
      if (x < 10 && y < 10) wall.depths[i] = 0.0f;
    }
  }
  wall.set_light(
      [](int x, int, float u) { return x >= 32 && x < 64 ? one_in_eight(u) : vec3(0.0f); });
  wall.light[0] = vec3(7.0f);
  const std::vector<vec3> filtered = wall.filtered();
  for (int y = 0; y < wall.height; ++y) {
    for (int x = 0; x < wall.width; ++x) {
      const float red = filtered[wall.at(x, y)].x;
      if (x == 0 && y == 0) {
        EXPECT_EQ(red, 7.0f);
      } else if (x < 32 || x >= 64) {
        EXPECT_EQ(red, 0.0f) << x << " " << y;
      } else {
        EXPECT_GT(red, 0.3f);
      }
    }
  }
}

TEST(Denoise, SeesAStripBesideASurfaceOnceOnly) {
  // A bright strip along a wall's lower edge that stands out by 0.7 of the plane's tolerance
  Wall wall(40, 120);
  constexpr int kStrip = 110;
  for (int x = 0; x < wall.width; ++x) wall.positions[wall.at(x, kStrip)].z = 0.007f;
  for (int y = kStrip + 1; y < wall.height; ++y) {
    for (int x = 0; x < wall.width; ++x) wall.positions[wall.at(x, y)].z = -1.0f;
  }
  wall.set_light([](int, int y, float) { return vec3(y == kStrip ? 1.0f : 0.0f); });
  const std::vector<vec3> filtered = wall.filtered(geometric_denoising());
  // The farther from the strip, the darker
  for (int y = 20; y < kStrip; ++y) {
    const float here = filtered[wall.at(20, y)].x, farther = filtered[wall.at(20, y - 1)].x;
    EXPECT_LT(farther, here + 2e-3f) << y;
  }
}

TEST(Denoise, SeesNoStepTowardsPixelsWithoutASurface) {
  // Where there is none, positions may be anything
  std::vector<vec3> filtered[2];
  for (const bool unknown : {false, true}) {
    Wall wall(40, 40);
    for (int x = 0; x < wall.width; ++x) {
      const std::size_t sky = wall.at(x, 20);
      wall.depths[sky] = 0.0f;
      wall.positions[sky] = vec3(unknown ? std::numeric_limits<float>::quiet_NaN() : 0.0f);
    }
    wall.set_light([](int, int, float u) { return one_in_eight(u); });
    filtered[unknown ? 1 : 0] = wall.filtered(geometric_denoising());
  }
  EXPECT_EQ(filtered[0], filtered[1]);
}

TEST(Denoise, AddsTheDetailOfTheBase) {
  Wall wall(80, 60);
  wall.base.resize(wall.light.size());
  const auto detail = [](int x, int y) {
    return vec3(1.0f + 0.5f * static_cast<float>((x + y) % 2));
  };
  wall.set_light([&](int x, int y, float u) {
    wall.base[wall.at(x, y)] = detail(x, y);
    return detail(x, y) - 0.5f + one_in_eight(u) * 0.25f;
  });
  const std::vector<vec3> filtered = wall.filtered();
  const Spread all = spread_of(filtered, 0.0);
  double step = 0.0;
  for (int x = 20; x < 60; x += 2) {
    step += (filtered[wall.at(x + 1, 30)].x - filtered[wall.at(x, 30)].x) / 20.0;
  }
  EXPECT_NEAR(all.mean, 1.0, 0.05);
  // Light is 0.8 of the base, and its detail so much fainter
  EXPECT_NEAR(step, 0.5 * 0.8, 0.05);
}

/// Gathered light that is 1 as the lookup has it, but in one column and one pixel, with their
/// variances; elsewhere it is known to a tenth.
Wall gathered_wall(float column, float pixel, float variance_of_pixel) {
  Wall wall(96, 64);
  wall.base.assign(wall.light.size(), vec3(1.0f));
  wall.variance.assign(wall.light.size(), 0.01f);
  wall.set_light([&](int x, int, float) { return vec3(x == 30 ? column : 1.0f); });
  wall.light[wall.at(70, 32)] = vec3(pixel);
  wall.variance[wall.at(70, 32)] = variance_of_pixel;
  return wall;
}

TEST(Denoise, KeepsLinesOfGatheredLightThatItsRaysAgreeOn) {
  const Wall wall = gathered_wall(6.0f, 1.0f, 0.01f);
  const std::vector<vec3> filtered = wall.filtered();
  // The first pass leaves 3.5 in the line and 2.25 beside it, and a second one that ignored
  // differences of light left 2.25 and 1.94
  EXPECT_NEAR(filtered[wall.at(30, 32)].x, 3.5f, 0.1f);
  EXPECT_NEAR(filtered[wall.at(33, 32)].x, 1.0f, 0.1f);
}

TEST(Denoise, SpreadsWhatABrightRayOfGatheredLightBrought) {
  const Wall wall = gathered_wall(1.0f, 2.0f, 1.0f);
  EXPECT_LT(wall.filtered()[wall.at(70, 32)].x, 1.1f);
}

TEST(Denoise, KeepsAnEdgeOfLightThatStandsOutFromTheNoise) {
  Wall wall(128, 64);
  constexpr float kNoise = 0.1f;
  wall.set_light([](int x, int, float u) {
    return vec3((x >= 64 ? 2.0f : 1.0f) + kNoise * std::sqrt(12.0f) * (u - 0.5f));
  });
  wall.variance.assign(wall.light.size(), kNoise * kNoise);
  const std::vector<vec3> filtered = wall.filtered(emitter_denoising());
  for (int y = 20; y < 44; ++y) {
    EXPECT_NEAR(filtered[wall.at(60, y)].x, 1.0f, 0.06f);
    EXPECT_NEAR(filtered[wall.at(67, y)].x, 2.0f, 0.06f);
  }
}

TEST(Denoise, FiltersAPartWithItsSurroundingsAsItDoesTheWhole) {
  Wall whole(40, 200), part(40, 150);
  whole.set_light([](int, int, float u) { return one_in_eight(u); });
  for (const vec3& light : whole.light) whole.variance.push_back(light.x * light.x);
  whole.levels.assign(whole.light.size(), 1.0f);
  const DenoiseSettings settings;
  constexpr int kReach = 63;
  ASSERT_EQ(denoise_reach(settings), kReach);
  constexpr int kFirst = 30;  // row of the whole that the part begins with
  for (std::size_t i = 0; i < part.light.size(); ++i) {
    const std::size_t of_whole = i + static_cast<std::size_t>(kFirst * whole.width);
    part.light[i] = whole.light[of_whole];
    part.positions[i] = whole.positions[of_whole];
    part.variance.push_back(whole.variance[of_whole]);
    part.levels.push_back(1.0f);
  }
  const std::vector<vec3> expected = whole.filtered(), filtered = part.filtered();
  for (int y = kReach; y < part.height - kReach; ++y) {
    for (int x = 0; x < part.width; ++x) {
      EXPECT_EQ(filtered[part.at(x, y)], expected[whole.at(x, y + kFirst)]);
    }
  }
}

TEST(Denoise, GivesTheSameBitsWhateverItFilteredBefore) {
  Wall wall(50, 30), other(77, 41);
  wall.set_light([](int, int, float u) { return one_in_eight(u); });
  other.set_light([](int, int, float u) { return vec3(100.0f * u); });
  Denoiser denoiser;
  std::vector<vec3> expected(wall.light.size()), again(wall.light.size()),
      between(other.light.size());
  ASSERT_TRUE(denoiser.filter(wall.view(), {wall.light, {}, {}}, {}, expected));
  ASSERT_TRUE(denoiser.filter(other.view(), {other.light, {}, {}}, {}, between));
  ASSERT_TRUE(denoiser.filter(wall.view(), {wall.light, {}, {}}, {}, again));
  EXPECT_EQ(expected, again);
}

TEST(Denoise, RefusesWhatIsOutOfRange) {
  const auto refused = [](auto change) {
    DenoiseSettings settings;
    change(settings);
    const Expected<void> fine = check(settings);
    return fine ? "" : fine.error().place;
  };
  EXPECT_EQ(refused([](DenoiseSettings&) {}), "");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.passes = 7; }), "denoise passes");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.geometric_passes = 0; }), "geometric passes");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.geometric_passes = 7; }), "geometric passes");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.normal_sharpness = -1.0f; }), "normal sharpness");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.plane_tolerance = 0.0f; }), "plane tolerance");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.noise_tolerance = NAN; }), "noise tolerance");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.lobe_share = 1e-30f; }), "lobe share");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.lobe_share = 17.0f; }), "lobe share");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.far_lobe_share = -0.1f; }), "far lobe share");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.far_lobe_share = 1e-30f; }), "far lobe share");
  EXPECT_EQ(refused([](DenoiseSettings& s) { s.far_lobe_share = 17.0f; }), "far lobe share");

  const Wall wall(8, 8);
  std::vector<vec3> result(wall.light.size()), too_few(63);
  const auto place_of = [](const Expected<void>& fine) { return fine ? "" : fine.error().place; };
  Denoiser denoiser;
  EXPECT_EQ(place_of(denoiser.filter(wall.view(), {.light = wall.light}, {}, too_few)),
            "filtered light");
  EXPECT_EQ(place_of(denoiser.filter(wall.view(), {wall.light, too_few}, {}, result)), "base");
  EXPECT_EQ(place_of(denoiser.filter(wall.view(), {.light = too_few}, {}, result)), "light");
  const std::vector<float> variances(wall.light.size()), few_variances(63);
  EXPECT_EQ(place_of(denoiser.filter(
                wall.view(), {.light = wall.light, .history_variance = few_variances}, {}, result)),
            "variance of the history");
  const NoisyLight both{.light = wall.light, .variance = variances, .history_variance = variances};
  EXPECT_EQ(place_of(denoiser.filter(wall.view(), both, {}, result)), "noisy light");
  DenoiseView view = wall.view();
  view.normals_ws = too_few;
  EXPECT_EQ(place_of(denoiser.filter(view, {.light = wall.light}, {}, result)), "normals");
  EXPECT_EQ(place_of(denoiser.filter({}, {}, {}, {})), "denoise view");
}

}  // namespace
}  // namespace lambent::denoise_test
