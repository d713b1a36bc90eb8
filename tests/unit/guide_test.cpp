// SPDX-License-Identifier: Apache-2.0
#include "gather/guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "compose/gbuffer.h"
#include "gather/gather.h"
#include "gather/gather_math.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/field_scenes.h"

namespace lambent::guide_test {
namespace {

constexpr int kSide = 5;  // of the pilots below [pixels]
constexpr std::size_t kPoints = kSide * kSide;
constexpr std::size_t kRays = 16;

/// The guide of a floor at the origin under a dome of radius 1 m with this luminance, of which each
/// ray knows the product with a random number of mean 1.
template <class Luminance>
GatherGuide guide_under(Luminance luminance_of) {
  GatherGuide guide{kSide, kSide, {}, {}};
  guide.points.assign(kPoints, GuidePoint{vec3(0.0f, 0.0f, 1.0f), 1.0f, 0.0f});
  const std::vector<vec3> positions_ws(kPoints, vec3(0.0f));
  std::vector<PilotHit> hits;
  RandomStream random = make_random_stream(1u, 2u, 3u);
  for (std::size_t i = 0; i < kPoints * kRays; ++i) {
    const vec3 direction = sample_cosine_hemisphere(next_uniform2(random));
    hits.push_back({direction, luminance_of(direction, next_uniform(random))});
  }
  place_guide(hits, positions_ws, 1, guide);
  return guide;
}

/// A patch of a hundredth of the hemisphere, halfway up.
bool is_in_patch(const vec3& direction) {
  return dot(direction, normalize(vec3(1.0f, 0.0f, 1.0f))) > 0.99f;
}

TEST(Guide, SendsHalfOfTheRaysToASmallPatchThatBringsMostLight) {
  const GatherGuide guide = guide_under(
      [](const vec3& direction, float) { return is_in_patch(direction) ? 200.0f : 1.0f; });
  for (const GuidePoint& point : guide.points) EXPECT_EQ(point.share, kMaxGuidedShare);
  // The cones of the point in the middle have six hemispheres' 400th parts
  EXPECT_FLOAT_EQ(guide.points[kPoints / 2].least_cosine, 1.0f - 6.0f / (kPoints * kRays));
  EXPECT_TRUE(std::ranges::all_of(guide.places, is_in_patch));
}

TEST(Guide, SendsNoRaysWhereLightIsTheSameAllAround) {
  const GatherGuide guide = guide_under([](const vec3&, float) { return 1.0f; });
  for (const GuidePoint& point : guide.points) EXPECT_EQ(point.share, 0.0f);
}

TEST(Guide, DoesNotTakeNoiseForLight) {
  // One ray in ten brings ten times the mean, wherever it goes
  const GatherGuide guide =
      guide_under([](const vec3&, float drawn) { return drawn < 0.1f ? 10.0f : 0.0f; });
  for (const GuidePoint& point : guide.points) EXPECT_LT(point.share, 0.5f * kMaxGuidedShare);
}

TEST(Guide, WeightsOfRaysAreThatOfBothKindsTogether) {
  // Drawn by the cosine and by the guide in parts, directions have the mean of both densities
  EXPECT_FLOAT_EQ(guided_weight(0.5f, 7.0f, 0.0f), 1.0f);
  const float by_cosine = 0.5f / kPi;
  EXPECT_FLOAT_EQ(guided_weight(0.5f, 3.0f * by_cosine, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(guided_weight(0.5f, 0.0f, 0.5f), 2.0f);
  EXPECT_EQ(guided_weight(-0.1f, 1.0f, 0.5f), 0.0f);
  EXPECT_EQ(guided_rays(0.5f, 1), 0u);
  EXPECT_EQ(guided_rays(0.5f, 7), 3u);
  EXPECT_EQ(guided_rays(0.125f, 8), 1u);
}

TEST(Guide, DirectionsInConesAreUniform) {
  const vec3 axis = normalize(vec3(0.3f, -0.8f, 0.5f));
  constexpr float kLeastCosine = 0.9f;
  constexpr int kDirections = 4096;
  RandomStream random = make_random_stream(1u, 1u, 1u);
  std::array<int, 16> in_ring{};
  for (int i = 0; i < kDirections; ++i) {
    const vec3 direction = direction_in_cone(axis, kLeastCosine, next_uniform2(random));
    EXPECT_NEAR(length(direction), 1.0f, 1e-5f);
    EXPECT_TRUE(is_in_cone(direction, 2.5f * axis, 0.9999f * kLeastCosine));
    const float place = (1.0f - dot(direction, axis)) / (1.0f - kLeastCosine);
    ++in_ring.at(std::min(static_cast<std::size_t>(16.0f * place), std::size_t{15}));
  }
  // Rings of equal solid angle, within four standard errors
  for (const int directions : in_ring) EXPECT_NEAR(directions, kDirections / 16, 4 * 16);
  EXPECT_FALSE(is_in_cone(-axis, axis, kLeastCosine));
  EXPECT_FLOAT_EQ(guided_density(kBrightPlaces, kLeastCosine), 1.0f / (0.1f * kTwoPi));
}

TEST(Guide, DifferencesBetweenBothKindsOfRaysAreNoNoise) {
  // Two guided rays of 8 each, and two others of 1 and 3
  const RaySums guided = {2u, 16.0f, 128.0f}, others = {2u, 4.0f, 10.0f};
  EXPECT_FLOAT_EQ(variance_of_rays(guided, others), 4.0f);
  const RaySums none = {0u, 0.0f, 0.0f}, one = {1u, 8.0f, 64.0f};
  EXPECT_FLOAT_EQ(variance_of_rays(none, others), 4.0f);
  EXPECT_FLOAT_EQ(variance_of_rays(one, others), variance_of_sum(12.0f, 74.0f, 3u));
}

/// Gathered light of a picture, over many samples.
struct Gathered {
  double light = 0.0;     ///< Mean luminance.
  double variance = 0.0;  ///< Of a pixel's samples, the mean of all pixels.
};

Gathered gather_often(const test::Stage& stage, const IrradianceField& field,
                      const FrameSettings& frame, const GatherGuide* guide) {
  GBuffer gbuffer;
  trace_gbuffer(stage.world, stage.scene.cameras.at(0), frame, {0, frame.height}, 0, gbuffer);
  GatherRequest request{gbuffer.surfaces, gbuffer.hit, frame.width, 0, 8};
  request.guide = guide;
  if (guide != nullptr) request.guide_size = guide->size(frame.width, frame.height);
  constexpr uint kSamples = 32;
  std::vector<double> sums(gbuffer.size()), squares(gbuffer.size());
  GatheredLight light;
  for (request.sample = 0; request.sample < kSamples; ++request.sample) {
    gather_irradiance(stage.world, field, request, light);
    for (std::size_t i = 0; i < gbuffer.size(); ++i) {
      const double level = luminance(light.irradiance[i]);
      sums[i] += level;
      squares[i] += level * level;
    }
  }
  Gathered all;
  const double count = kSamples * static_cast<double>(gbuffer.size());
  for (std::size_t i = 0; i < gbuffer.size(); ++i) {
    all.light += sums[i] / count;
    all.variance += (squares[i] - sums[i] * sums[i] / kSamples) / count;
  }
  return all;
}

TEST(Guide, LeavesTheLightAsItIsAndTakesNoiseAway) {
  const test::Stage stage("cornell-spot");
  FieldSettings settings;
  settings.probe_count = glm::ivec3(6);
  const IrradianceField field = test::make_field(stage, settings, 4);
  FrameSettings frame;
  frame.width = frame.height = 24;
  FrameSettings small;
  small.width = small.height = 14;
  GBuffer pilot;
  trace_gbuffer(stage.world, stage.scene.cameras.at(0), small, {0, small.height}, 0, pilot);
  GatherGuide guide;
  const PilotView view{small.width, small.height, pilot.surfaces, pilot.hit};
  EXPECT_GT(make_guide(stage.world, field, view, 1, guide), 16 * pilot.size());
  const Gathered plain = gather_often(stage, field, frame, nullptr);
  const Gathered guided = gather_often(stage, field, frame, &guide);
  EXPECT_NEAR(guided.light, plain.light, 0.01 * plain.light);
  EXPECT_LT(guided.variance, 0.5 * plain.variance);
}

}  // namespace
}  // namespace lambent::guide_test
