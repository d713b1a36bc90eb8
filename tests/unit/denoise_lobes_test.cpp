// SPDX-License-Identifier: Apache-2.0
// The filter of light that lobes of coats reflect: as far as neighbours see the same.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lambent/denoise.h"
#include "shared/random.h"

namespace lambent::denoise_lobes_test {
namespace {

constexpr float kPixelAngle = 0.002f;  // between neighbouring pixels' rays [rad]
constexpr float kDepth = 4.0f;         // of the floor along all rays, about [m]

/// A picture of a flat coat, seen at an angle of incidence: the camera looks along -z, x is across
/// the plane of incidence.
struct Coat {
  Coat(int w, int h, float alpha, float cosine = 1.0f, float inverse_distance = 0.0f)
      : width(w), height(h) {
    const vec3 normal(0.0f, std::sqrt(1.0f - cosine * cosine), cosine);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const vec3 ray = normalize(vec3(kPixelAngle * static_cast<float>(x - w / 2),
                                        kPixelAngle * static_cast<float>(h / 2 - y), -1.0f));
        // Where the ray meets the plane through (0, 0, -kDepth)
        const float along = -kDepth * normal.z / dot(ray, normal);
        positions.push_back(ray * along);
        depths.push_back(-ray.z * along);
        normals.push_back(normal);
        to_viewer.push_back(-ray);
        light.emplace_back(0.0f);
      }
    }
    alphas.assign(light.size(), alpha);
    inverse_distances.assign(light.size(), inverse_distance);
  }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
  DenoiseView view() const {
    return {width, height, positions, normals, depths, {to_viewer, alphas, inverse_distances}};
  }
  std::vector<vec3> filtered(const DenoiseSettings& by = geometric_denoising()) const {
    std::vector<vec3> result(light.size());
    EXPECT_TRUE(Denoiser().filter(view(), {light, {}, {}}, by, result));
    return result;
  }
  /// One ray in eight brings light.
  void make_noisy() {
    RandomStream random = make_random_stream(1, 2, 3);
    for (vec3& e : light) e = vec3(next_uniform(random) < 0.125f ? 8.0f : 0.0f);
  }
  /// Filters light of this variance.
  std::vector<vec3> filtered(float variance, const DenoiseSettings& by) const {
    std::vector<vec3> result(light.size());
    const std::vector<float> variances(light.size(), variance);
    EXPECT_TRUE(Denoiser().filter(view(), {.light = light, .variance = variances}, by, result));
    return result;
  }

  int width, height;
  std::vector<vec3> positions, normals, to_viewer, light;
  std::vector<float> depths, alphas, inverse_distances;
};

struct Spread {
  double mean = 0.0, deviation = 0.0;
};
Spread spread_of(const std::vector<vec3>& light) {
  Spread spread;
  for (const vec3& e : light) spread.mean += e.x / static_cast<double>(light.size());
  for (const vec3& e : light) {
    const double off = e.x - spread.mean;
    spread.deviation += off * off / static_cast<double>(light.size());
  }
  spread.deviation = std::sqrt(spread.deviation);
  return spread;
}

/// How far a bright pixel in the middle of a coat is spread to the sides, and up and down: the
/// standard deviation [pixels].
struct Reach {
  double sideways = 0.0, upright = 0.0;
};
Reach reach_of(Coat coat, const DenoiseSettings& by = geometric_denoising()) {
  coat.light[coat.at(coat.width / 2, coat.height / 2)] = vec3(1.0f);
  const std::vector<vec3> filtered = coat.filtered(by);
  double sum = 0.0;
  Reach reach;
  for (int y = 0; y < coat.height; ++y) {
    for (int x = 0; x < coat.width; ++x) {
      const double weight = filtered[coat.at(x, y)].x;
      sum += weight;
      reach.sideways += weight * std::pow(x - coat.width / 2, 2.0);
      reach.upright += weight * std::pow(y - coat.height / 2, 2.0);
    }
  }
  return {std::sqrt(reach.sideways / sum), std::sqrt(reach.upright / sum)};
}

TEST(DenoiseLobes, LeavesMirrorsAsTheyAre) {
  Coat mirror(80, 60, 1e-3f);
  mirror.make_noisy();
  const std::vector<vec3> filtered = mirror.filtered();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, mirror.light[i].x, 1e-6f) << i;
  }
}

TEST(DenoiseLobes, TakesTheNoiseOffRoughCoatsAndKeepsTheMean) {
  Coat rough(160, 120, 0.16f);
  rough.make_noisy();
  const Spread before = spread_of(rough.light), after = spread_of(rough.filtered());
  EXPECT_GT(before.deviation, 2.5);
  EXPECT_LT(after.deviation, 0.15);
  EXPECT_NEAR(after.mean, before.mean, 0.03 * before.mean);
}

TEST(DenoiseLobes, BlursLessThanTheLobeItself) {
  // The lobe's own deviation is that of its slopes doubled: 2 alpha / sqrt(2), were it a Gaussian
  for (const float alpha : {0.02f, 0.04f, 0.09f}) {
    const Reach reach = reach_of(Coat(160, 120, alpha));
    EXPECT_LT(reach.sideways * kPixelAngle, 0.25f * std::sqrt(2.0f) * alpha) << alpha;
    EXPECT_GT(reach.sideways * kPixelAngle, 0.15f * std::sqrt(2.0f) * alpha) << alpha;
    EXPECT_NEAR(reach.sideways, reach.upright, 0.02 * reach.upright);
  }
}

TEST(DenoiseLobes, SpreadsExcessBeyondTheLobe) {
  const Coat coat(200, 160, 0.02f);
  const double of_light = reach_of(coat).sideways;
  const double of_excess = reach_of(coat, excess_denoising()).sideways;
  EXPECT_NEAR(of_excess / of_light, 3.0, 0.3);
  Coat bright = coat;
  bright.light[bright.at(100, 80)] = vec3(1.0f);
  double sum = 0.0;
  for (const vec3& e : bright.filtered(excess_denoising())) sum += e.x;
  EXPECT_NEAR(sum, 1.0, 0.02);
  // Beside what is close, half as far as other light where nothing is
  const Coat near(200, 160, 0.02f, 1.0f, 1.0f / 0.02f);
  EXPECT_NEAR(reach_of(near, excess_denoising()).sideways, 0.5 * of_light, 0.05 * of_light);
}

TEST(DenoiseLobes, KeepsWhatStandsCloseToTheCoat) {
  const float alpha = 0.09f;
  const Reach far = reach_of(Coat(160, 120, alpha));
  const Reach near = reach_of(Coat(160, 120, alpha, 1.0f, 1.0f / kDepth));
  const Reach closest = reach_of(Coat(160, 120, alpha, 1.0f, 1.0f / 0.02f));
  EXPECT_NEAR(near.sideways, 0.5 * far.sideways, 0.15 * far.sideways);
  EXPECT_LT(closest.sideways, 0.1);
}

TEST(DenoiseLobes, TakesNoiseOffWhatIsCloseToTheCoat) {
  Coat coat(160, 120, 0.09f, 1.0f, 1.0f / 0.02f);
  coat.make_noisy();
  const Spread before = spread_of(coat.light);
  EXPECT_GT(spread_of(coat.filtered()).deviation, 0.9 * before.deviation);
  // Each pixel's light is as noisy as the mean of 16 rays
  constexpr float kVarianceOfRay = 16.0f * 7.0f;
  const Spread after = spread_of(coat.filtered(kVarianceOfRay, reflection_denoising(1)));
  EXPECT_LT(after.deviation, 0.1 * before.deviation);
  EXPECT_NEAR(after.mean, before.mean, 0.03 * before.mean);
  // Of several pictures, whose mean has less noise, each keeps more
  const Spread of_many = spread_of(coat.filtered(kVarianceOfRay, reflection_denoising(64)));
  EXPECT_GT(of_many.deviation, 3.0 * after.deviation);
}

TEST(DenoiseLobes, KeepsWhatIsCloseToTheCoatAndStandsOutFromTheNoise) {
  Coat coat(160, 120, 0.09f, 1.0f, 1.0f / 0.02f);
  for (std::size_t i = 0; i < coat.light.size(); ++i) {
    coat.light[i] = vec3(i % static_cast<std::size_t>(coat.width) < 80 ? 0.5f : 1.5f);
  }
  const std::vector<vec3> filtered = coat.filtered(0.01f, reflection_denoising(1));
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, coat.light[i].x, 1e-3f) << i;
  }
}

TEST(DenoiseLobes, TakesNothingFromWhereSomethingStandsClose) {
  // To the left the coat reflects what stands a centimetre away and is dark, to the right the sky
  Coat coat(120, 60, 0.16f);
  for (int y = 0; y < coat.height; ++y) {
    for (int x = 0; x < coat.width; ++x) {
      const bool close = x < coat.width / 2;
      coat.light[coat.at(x, y)] = vec3(close ? 0.0f : 1.0f);
      coat.inverse_distances[coat.at(x, y)] = close ? 100.0f : 0.0f;
    }
  }
  const std::vector<vec3> filtered = coat.filtered();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, coat.light[i].x, 1e-3f) << i;
  }
}

TEST(DenoiseLobes, KeepsRoughCoatsApartFromSmoothOnesBesideThem) {
  // Strips of six pixels, the smooth ones of which show something dark
  Coat coat(120, 60, 0.36f);
  for (int y = 0; y < coat.height; ++y) {
    for (int x = 0; x < coat.width; ++x) {
      const bool smooth = x / 6 % 2 == 0;
      coat.light[coat.at(x, y)] = vec3(smooth ? 0.0f : 1.0f);
      if (smooth) coat.alphas[coat.at(x, y)] = 0.01f;
    }
  }
  const std::vector<vec3> filtered = coat.filtered();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, coat.light[i].x, 1e-3f) << i;
  }
}

TEST(DenoiseLobes, GivesBackTheLightThatItTakes) {
  // Roughness and distance change over the coat: what differs in weight is lost or made
  Coat coat(160, 120, 0.1f);
  for (int y = 0; y < coat.height; ++y) {
    for (int x = 0; x < coat.width; ++x) {
      const float along = static_cast<float>(x) / static_cast<float>(coat.width);
      coat.light[coat.at(x, y)] = vec3(0.2f + along + 0.5f * std::sin(0.4f * x));
      coat.alphas[coat.at(x, y)] = 0.06f + 0.1f * along;
      coat.inverse_distances[coat.at(x, y)] = 0.5f - 0.5f * along;
    }
  }
  const Spread before = spread_of(coat.light), after = spread_of(coat.filtered());
  EXPECT_NEAR(after.mean, before.mean, 0.002 * before.mean);
}

TEST(DenoiseLobes, IsNarrowerSidewaysWhereTheCoatIsSeenFromTheSide) {
  const Reach reach = reach_of(Coat(160, 120, 0.09f, 0.35f));
  EXPECT_NEAR(reach.sideways, 0.35 * reach.upright, 0.1 * reach.upright);
}

TEST(DenoiseLobes, LeavesOutPixelsWithoutALobe) {
  Coat coat(64, 48, 0.16f);
  for (std::size_t i = 0; i < coat.light.size(); ++i) {
    const bool matte = i % 3 == 0;
    coat.light[i] = vec3(matte ? 100.0f : 1.0f);
    if (matte) coat.alphas[i] = 0.0f;
  }
  const std::vector<vec3> filtered = coat.filtered();
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    EXPECT_NEAR(filtered[i].x, coat.light[i].x, 1e-4f * coat.light[i].x) << i;
  }
}

TEST(DenoiseLobes, RefusesWhatDoesNotFit) {
  const Coat coat(16, 8, 0.1f);
  std::vector<vec3> result(coat.light.size());
  DenoiseView view = coat.view();
  view.lobes.to_viewer_ws = view.lobes.to_viewer_ws.first(5);
  EXPECT_FALSE(Denoiser().filter(view, {coat.light, {}, {}}, geometric_denoising(), result));
  view = coat.view();
  view.lobes.inverse_distances = {};
  EXPECT_FALSE(Denoiser().filter(view, {coat.light, {}, {}}, geometric_denoising(), result));
  EXPECT_FALSE(
      Denoiser().filter(coat.view(), {coat.light, coat.light, {}}, geometric_denoising(), result));
  EXPECT_FALSE(Denoiser().filter(coat.view(), {coat.light, {}, {}, coat.depths},
                                 geometric_denoising(), result));
}

}  // namespace
}  // namespace lambent::denoise_lobes_test
