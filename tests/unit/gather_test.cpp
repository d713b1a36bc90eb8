// SPDX-License-Identifier: Apache-2.0
#include "gather/gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "gather/gather_math.h"
#include "support/many_gathers.h"

namespace lambent::gather_test {
namespace {

TEST(Gather, HilbertsCurveGoesFromPixelToNeighbourAndMeetsEachOnce) {
  constexpr uint kSide = 64;
  std::vector<ivec2> places(kSide * kSide, ivec2(-1));
  for (uint y = 0; y < kSide; ++y) {
    for (uint x = 0; x < kSide; ++x) {
      const uint index = hilbert_index(x, y);
      ASSERT_LT(index, kSide * kSide);
      EXPECT_EQ(places[index], ivec2(-1));
      places[index] = ivec2(static_cast<int>(x), static_cast<int>(y));
    }
  }
  for (std::size_t i = 1; i < places.size(); ++i) {
    const ivec2 step = glm::abs(places[i] - places[i - 1]);
    EXPECT_EQ(step.x + step.y, 1) << i;
  }
}

/// Cells of a grid of n x n that hold one of the points.
std::size_t cells_met(const std::vector<vec2>& points, int n) {
  std::set<int> cells;
  for (const vec2& p : points) {
    cells.insert(static_cast<int>(p.y * static_cast<float>(n)) * n +
                 static_cast<int>(p.x * static_cast<float>(n)));
  }
  return cells.size();
}

TEST(Gather, RaysCoverTheHemisphereInSpaceAndInTime) {
  // Points at random meet 63 % of as many cells
  constexpr std::size_t kEnough = 52;
  for (const uint seed : {1u, 2u, 77u}) {
    std::vector<vec2> of_block, of_time, of_pixel;
    for (uint i = 0; i < 64; ++i) {
      of_block.push_back(pixel_point(8 + i % 8, 40 + i / 8, 0, 1, 3, seed));
      of_time.push_back(pixel_point(13, 7, 0, 1, i, seed));
      of_pixel.push_back(pixel_point(13, 7, i, 64, 0, seed));
    }
    EXPECT_GE(cells_met(of_block, 8), kEnough);
    EXPECT_GE(cells_met(of_time, 8), kEnough);
    EXPECT_GE(cells_met(of_pixel, 8), kEnough);
  }
}

IrradianceField coarse_field(const test::Stage& stage) {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(4);
  return test::make_field(stage, settings, 2);
}

TEST(Gather, WhatRareBrightRaysBringIsKeptApartAndNotLost) {
  const test::Stage stage("cornell");
  const IrradianceField field = coarse_field(stage);
  FrameSettings frame;
  frame.width = frame.height = 40;
  const GBuffer gbuffer = test::seen_of(stage, frame);
  GatherRequest request{gbuffer.surfaces, gbuffer.hit, frame.width, 0, 1};
  GatheredLight whole, apart, of_several, several_apart;
  gather_irradiance(stage.world, field, request, whole);
  EXPECT_TRUE(whole.excess.empty());
  // What the field knows is made so dark that many rays are far brighter
  const std::vector<vec3> known(gbuffer.size(), vec3(0.005f));
  request.known = known;
  gather_irradiance(stage.world, field, request, apart);
  vec3 kept(0.0f), excess(0.0f), all(0.0f);
  for (std::size_t i = 0; i < gbuffer.size(); ++i) {
    EXPECT_LE(luminance(apart.irradiance[i]), kBrightestRay * 0.005f * 1.001f);
    kept += apart.irradiance[i];
    excess += apart.excess[i];
    all += whole.irradiance[i];
  }
  EXPECT_GT(luminance(excess), 0.1f * luminance(all));
  EXPECT_NEAR(luminance(kept + excess), luminance(all), 1e-4f * luminance(all));

  // Of eight rays, most bring as much as the others, and nothing is lost either
  request.rays_per_pixel = 8;
  gather_irradiance(stage.world, field, request, several_apart);
  request.known = {};
  gather_irradiance(stage.world, field, request, of_several);
  vec3 sum(0.0f), sum_of_excess(0.0f), of_all(0.0f);
  for (std::size_t i = 0; i < gbuffer.size(); ++i) {
    sum += several_apart.irradiance[i] + several_apart.excess[i];
    sum_of_excess += several_apart.excess[i];
    of_all += of_several.irradiance[i];
  }
  EXPECT_NEAR(luminance(sum), luminance(of_all), 1e-4f * luminance(of_all));
  EXPECT_LT(luminance(sum_of_excess), 0.01f * luminance(of_all));
}

TEST(Gather, WhatSeveralOfAPixelsRaysBringIsNotRare) {
  EXPECT_EQ(known_level(vec3(2.0f), 100.0f, 90.0f, 1), luminance(vec3(2.0f)));
  EXPECT_EQ(known_level(vec3(2.0f), 100.0f, 90.0f, 11), luminance(vec3(2.0f)));
  EXPECT_EQ(known_level(vec3(0.5f), 100.0f, 90.0f, 11), 1.0f);
  EXPECT_EQ(known_level(vec3(0.0f), 180.0f, 90.0f, 2), 90.0f);
}

TEST(Gather, SecondaryGathersEndWithinASpacing) {
  EXPECT_EQ(secondary_probability(0.0f, 2.0f), 1.0f);
  EXPECT_EQ(secondary_probability(1.0f, 2.0f), 1.0f);
  EXPECT_FLOAT_EQ(secondary_probability(1.5f, 2.0f), 0.5f);
  EXPECT_EQ(secondary_probability(2.0f, 2.0f), 0.0f);
  EXPECT_EQ(secondary_probability(100.0f, 2.0f), 0.0f);
}

/// Light that pixels of "cornell" gather in all from a field of so many probes along each side,
/// after so many updates. With few probes nearly all gathers are secondary.
float gathered_light(int probes, int updates) {
  const test::Stage stage("cornell");
  FrameSettings frame;
  frame.width = frame.height = 24;
  const GBuffer gbuffer = test::seen_of(stage, frame);
  const GatherRequest request{gbuffer.surfaces, gbuffer.hit, frame.width, 0, 64};
  FieldSettings settings;
  settings.probe_count = glm::ivec3(probes);
  GatheredLight light;
  gather_irradiance(stage.world, test::make_field(stage, settings, updates), request, light);
  float sum = 0.0f;
  for (const vec3& irradiance : light.irradiance) sum += luminance(irradiance);
  return sum;
}

TEST(Gather, SecondaryGathersSupplyLightThatTheFieldLacks) {
  // Fields without light leave that of one bounce, and of further ones in secondary gathers
  const float dense = gathered_light(48, 0), sparse = gathered_light(2, 0);
  EXPECT_GT(sparse, 1.2f * dense);
  EXPECT_LT(sparse, 2.0f * dense);
}

TEST(Gather, SecondaryGathersTakeThePlaceOfLookups) {
  const float dense = gathered_light(16, 2), sparse = gathered_light(3, 16);
  EXPECT_NEAR(sparse, dense, 0.03f * dense);
}

TEST(Gather, TellsHowNoisyItsLightIs) {
  const test::Stage stage("cornell");
  const IrradianceField field = coarse_field(stage);
  FrameSettings frame;
  frame.width = frame.height = 24;
  const GBuffer gbuffer = test::seen_of(stage, frame);
  GatherRequest request{gbuffer.surfaces, gbuffer.hit, frame.width, 0, 16};
  const test::ManyGathers gathers = test::gather_often(stage, field, request, 12);
  // Points that cover the hemisphere evenly are less noisy than independent ones
  EXPECT_LT(gathers.variance, gathers.told_variance);
  EXPECT_GT(gathers.variance, 0.1 * gathers.told_variance);
  GatheredLight light;
  request.rays_per_pixel = 1;
  gather_irradiance(stage.world, field, request, light);
  EXPECT_TRUE(light.variance.empty());
}

}  // namespace
}  // namespace lambent::gather_test
