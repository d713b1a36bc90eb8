// SPDX-License-Identifier: Apache-2.0
// Fog along rays against numerical integrals, and how it scatters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scene/media/media.h"
#include "shared/phase.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/chi_squared.h"

namespace lambent::media_test {
namespace {

// Of optical depths in floats against integrals in double.
constexpr double kTolerance = 2e-4;
constexpr int kSteps = 20000;

glm::vec3 random_point(RandomStream& random, float reach) {
  return reach * (2.0f * glm::vec3(next_uniform2(random), next_uniform(random)) - 1.0f);
}

FogVolume turned_box(float density, float scale_height) {
  FogVolume fog;
  fog.centre = {0.3f, -0.2f, 0.5f};
  fog.size = {4.0f, 3.0f, 2.0f};
  fog.axes = sample_uniform_rotation({0.3f, 0.6f, 0.2f});
  fog.density = density;
  fog.scale_height = scale_height;
  return fog;
}

double density_at(const FogVolume& fog, const glm::dvec3& point) {
  const glm::dvec3 local = (point - glm::dvec3(fog.centre)) * glm::dmat3(fog.axes);
  const glm::dvec3 half = 0.5 * glm::dvec3(fog.size);
  if (glm::any(glm::greaterThan(glm::abs(local), half))) return 0.0;
  const double height = fog.scale_height > 0.0f ? (local.y + half.y) / fog.scale_height : 0.0;
  return fog.density * std::exp(-height);
}

double integral(const std::vector<FogVolume>& volumes, const glm::vec3& origin,
                const glm::vec3& direction, double from, double to) {
  const double step = (to - from) / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 point = glm::dvec3(origin) + (from + (i + 0.5) * step) * glm::dvec3(direction);
    for (const FogVolume& fog : volumes) sum += step * density_at(fog, point);
  }
  return sum;
}

TEST(Media, DepthIsTheIntegralOfTheDensity) {
  const std::vector<FogVolume> cases[] = {
      {turned_box(0.4f, 0.0f)},
      {turned_box(3.0f, 0.5f)},
      {turned_box(0.7f, 1e6f)},
      {turned_box(0.4f, 0.0f), turned_box(3.0f, 0.5f)},
  };
  RandomStream random = make_random_stream(1, 2, 3);
  for (const std::vector<FogVolume>& volumes : cases) {
    const Media media(volumes);
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 origin = random_point(random, 3.0f);
      const glm::vec3 direction = sample_uniform_sphere(next_uniform2(random));
      const float from = next_uniform(random), to = from + 5.0f * next_uniform(random);
      const double truth = integral(volumes, origin, direction, from, to);
      EXPECT_NEAR(optical_depth(media, origin, direction, from, to), truth,
                  kTolerance * (1.0 + truth));
    }
  }
}

TEST(Media, DepthOfRaysAlongTheBoxIsFinite) {
  FogVolume fog;
  fog.size = glm::vec3(2.0f);
  fog.density = 0.5f;
  fog.scale_height = 1.0f;
  const Media media({fog});
  // Level rays at the bottom, on a face, and outside
  EXPECT_NEAR(optical_depth(media, {-3, -0.999f, 0}, {1, 0, 0}, 0, 10), 2 * 0.5 * std::exp(-0.001),
              1e-4);
  EXPECT_EQ(optical_depth(media, {-3, 1.0f, 0}, {1, 0, 0}, 0, 10), 0.0f);
  EXPECT_EQ(optical_depth(media, {-3, 1.5f, 0}, {1, 0, 0}, 0, infinity()), 0.0f);
  // Straight up from within, without end
  EXPECT_NEAR(optical_depth(media, {0, -1, 0}, {0, 1, 0}, 0, infinity()), 0.5 * (1 - std::exp(-2)),
              1e-4);
}

TEST(Media, ThinFogKeepsItsDigits) {
  FogVolume fog;
  fog.size = glm::vec3(2.0f);
  fog.density = 1e-9f;
  fog.scale_height = 1e9f;
  EXPECT_NEAR(optical_depth(Media({fog}), {-3, 0, 0}, {1, 0, 0}, 0, 10) / 2e-9, 1.0, 1e-5);
}

TEST(Media, EventsAreWhereTheirDepthIs) {
  const std::vector<FogVolume> volumes = {turned_box(0.4f, 0.0f), turned_box(3.0f, 0.5f)};
  const Media media(volumes);
  RandomStream random = make_random_stream(4, 5, 6);
  int events = 0;
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 origin = random_point(random, 3.0f);
    const glm::vec3 direction = sample_uniform_sphere(next_uniform2(random));
    const float all = optical_depth(media, origin, direction, 0.0f, infinity());
    if (all <= 0.0f) continue;
    const float depth = next_uniform(random) * all;
    const MediumEvent event = media.event_at(origin, direction, infinity(), depth, 0.5f);
    EXPECT_NEAR(optical_depth(media, origin, direction, 0.0f, event.distance), depth,
                1e-4 * (1.0 + depth));
    EXPECT_EQ(event.albedo, volumes[0].albedo);
    ++events;
  }
  EXPECT_GT(events, 20);
}

TEST(Media, EventsPickBoxesByTheirDensity) {
  FogVolume thin, dense;
  thin.size = dense.size = glm::vec3(2.0f);
  thin.density = 1.0f;
  thin.albedo = glm::vec3(0.25f);
  dense.density = 3.0f;
  dense.albedo = glm::vec3(0.75f);
  const Media media({thin, dense});
  const auto albedo = [&](float u) {
    return media.event_at({0, 0, 0}, {0, 0, 1}, 10.0f, 1.0f, u).albedo.x;
  };
  EXPECT_EQ(albedo(0.24f), 0.25f);
  EXPECT_EQ(albedo(0.26f), 0.75f);
  // What both scatter of light is the mean of their albedos by density
  EXPECT_NEAR(scattering(media, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}).x * 4.0f * kPi,
              0.25 * 0.25 + 0.75 * 0.75, 1e-5);
}

class Phase : public testing::TestWithParam<float> {};

TEST_P(Phase, IsDrawnByItsDensity) {
  constexpr int kSamples = 200000, kCells = 50;
  const float g = GetParam();
  std::vector<double> counts(kCells), expected(kCells);
  RandomStream random = make_random_stream(7, 8, 9);
  double mean = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const float cosine = sample_phase(g, next_uniform(random));
    mean += cosine / kSamples;
    ++counts[std::min(kCells - 1, static_cast<int>(0.5f * (cosine + 1.0f) * kCells))];
  }
  for (int cell = 0; cell < kCells; ++cell) {
    constexpr int kPoints = 2000;
    for (int i = 0; i < kPoints; ++i) {
      const double cosine = -1.0 + 2.0 * (cell + (i + 0.5) / kPoints) / kCells;
      expected[cell] += phase(g, static_cast<float>(cosine)) * 2.0 * kPi * 2.0 / kCells / kPoints;
    }
    expected[cell] *= kSamples;
  }
  EXPECT_LT(test::chi_squared_deviation(counts, expected), test::kMaxChiSquaredDeviation);
  EXPECT_NEAR(mean, g, 0.01);
}

TEST_P(Phase, IsInverted) {
  for (float u = 0.05f; u < 1.0f; u += 0.1f) {
    EXPECT_NEAR(invert_phase(GetParam(), sample_phase(GetParam(), u)), u, 2e-3);
  }
}

TEST(Fog, IsValidatedWithItsScene) {
  const auto flaw_with = [](void (*spoil)(FogVolume&)) {
    Scene scene;
    scene.fog.resize(2);
    spoil(scene.fog[1]);
    const Expected<void> fine = validate(scene);
    return fine ? std::string() : fine.error().message();
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(flaw_with([](FogVolume&) {}), "");
  void (*spoils[])(FogVolume&) = {
      [](FogVolume& fog) { fog.density = -1.0f; },
      [](FogVolume& fog) { fog.density = kNan; },
      [](FogVolume& fog) { fog.albedo.y = 1.1f; },
      [](FogVolume& fog) { fog.anisotropy = 1.0f; },
      [](FogVolume& fog) { fog.scale_height = 1e-5f; },
      [](FogVolume& fog) { fog.size.x = -1.0f; },
      [](FogVolume& fog) { fog.centre.z = kNan; },
      [](FogVolume& fog) { fog.axes[0] *= 2.0f; },
      [](FogVolume& fog) { fog.axes[0] = fog.axes[1]; },
  };
  for (const auto& spoil : spoils) {
    EXPECT_NE(flaw_with(spoil).find("fog[1]"), std::string::npos) << flaw_with(spoil);
  }
  Scene crowded;
  crowded.fog.resize(kMaxFogVolumes + 1);
  EXPECT_FALSE(validate(crowded));
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, Phase, testing::Values(0.0f, 0.3f, -0.6f, 0.95f));

}  // namespace
}  // namespace lambent::media_test
