// SPDX-License-Identifier: Apache-2.0
#include "gather/guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gather/gather_math.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/many_gathers.h"

namespace lambent::guide_test {
namespace {

constexpr int kSide = 5;  // of the pilots below [pixels]
constexpr std::size_t kPoints = kSide * kSide;
constexpr std::size_t kRays = 16;

/// The guide of a floor at the origin under a dome of radius 1 m. Its luminance is a function of
/// the direction and of a number that is uniform at random for each ray.
template <class Luminance>
GatherGuide guide_under(Luminance luminance_of) {
  GatherGuide guide{{kSide, kSide, kSide, kSide}, {}, {}};
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

TEST(Guide, PoolsRaysOfFartherPointsThatFaceTheSameWay) {
  // Of a row of points, all rays of the first one meet a bright patch, and no others do. Only
  // points with more rays than the fewest pool farther ones
  constexpr int kRow = 12;
  for (const std::size_t rays : {kRays, 2 * kRays}) {
    GatherGuide guide{{kRow, 1, kRow, 1}, {}, {}};
    guide.points.assign(kRow, GuidePoint{vec3(0.0f, 0.0f, 1.0f), 1.0f, 0.0f});
    guide.points[4].normal_ws = vec3(1.0f, 0.0f, 0.0f);
    std::vector<PilotHit> hits;
    for (std::size_t i = 0; i < kRow * rays; ++i) {
      hits.push_back(i < rays ? PilotHit{vec3(0.0f, 0.0f, 1.0f), 9.0f}
                              : PilotHit{vec3(0.6f, 0.0f, 0.8f), 0.1f});
    }
    place_guide(hits, std::vector<vec3>(kRow, vec3(0.0f)), 1, guide);
    for (int x = 0; x < kRow; ++x) {
      const bool pooled = x <= 2 || (x == 8 && rays > kRays);  // at 4, the point faces elsewhere
      EXPECT_EQ(guide.points[x].share > 0.0f, pooled) << x;
    }
  }
}

TEST(Guide, DoesNotTakeNoiseForLight) {
  // One ray in ten brings ten times the mean, wherever it goes
  const GatherGuide guide =
      guide_under([](const vec3&, float drawn) { return drawn < 0.1f ? 10.0f : 0.0f; });
  float mean = 0.0f;
  for (const GuidePoint& point : guide.points) {
    EXPECT_LE(point.share, 0.5f * kMaxGuidedShare);
    mean += point.share / static_cast<float>(kPoints);
  }
  EXPECT_LT(mean, 0.06f * kMaxGuidedShare);
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

TEST(Guide, DensityIsThatOfTheConesAroundADirection) {
  constexpr float kLeastCosine = 0.9f;
  const vec3 axis = normalize(vec3(0.3f, -0.8f, 0.5f));
  const Frame frame = make_frame(axis);
  const vec3 inside = to_world(frame, sample_uniform_cone(vec2(0.99f, 0.2f), kLeastCosine));
  const vec3 outside = to_world(frame, sample_uniform_cone(vec2(0.99f, 0.2f), 0.88f));
  EXPECT_TRUE(is_in_cone(inside, 2.5f * axis, kLeastCosine));
  EXPECT_FALSE(is_in_cone(outside, 2.5f * axis, kLeastCosine));
  EXPECT_FALSE(is_in_cone(-axis, axis, kLeastCosine));
  EXPECT_FLOAT_EQ(guided_density(kBrightPlaces, kLeastCosine), 1.0f / (0.1f * kTwoPi));
  EXPECT_FLOAT_EQ(guided_density(kBrightPlaces / 2, kLeastCosine), 0.5f / (0.1f * kTwoPi));
}

TEST(Guide, DifferencesBetweenBothKindsOfRaysAreNoNoise) {
  // Two guided rays of 8 each, and two others of 1 and 3
  const RaySums guided = {16.0f, 128.0f}, others = {4.0f, 10.0f};
  EXPECT_FLOAT_EQ(variance_of_rays(guided, others, 2u, 4u), 4.0f);
  const RaySums none = {0.0f, 0.0f}, one = {8.0f, 64.0f};
  EXPECT_FLOAT_EQ(variance_of_rays(none, others, 0u, 2u), 4.0f);
  EXPECT_FLOAT_EQ(variance_of_rays(one, others, 1u, 3u), variance_of_sum(12.0f, 74.0f, 3u));
  EXPECT_EQ(variance_of_rays(none, none, 0u, 4u), 0.0f);
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
  const GBuffer pilot = test::seen_of(stage, small), seen = test::seen_of(stage, frame);
  GatherGuide guide{{frame.width, frame.height, small.width, small.height}, {}, {}};
  EXPECT_GT(make_guide(stage.world, field, {pilot.surfaces, pilot.hit}, 1, guide),
            16 * pilot.size());
  GatherRequest request{seen.surfaces, seen.hit, frame.width, 0, 8};
  const test::ManyGathers plain = test::gather_often(stage, field, request, 32);
  request.guide = &guide;
  const test::ManyGathers guided = test::gather_often(stage, field, request, 32);
  EXPECT_NEAR(guided.luminance, plain.luminance, 0.01 * plain.luminance);
  EXPECT_LT(guided.variance, 0.5 * plain.variance);
}

}  // namespace
}  // namespace lambent::guide_test
