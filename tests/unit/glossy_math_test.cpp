// SPDX-License-Identifier: Apache-2.0
#include "glossy/glossy_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambent::glossy_math_test {
namespace {

bool is_number(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

TEST(CoatSums, OfTheSmallestWeightsAreNumbers) {
  CoatReceiver at{};
  at.lobe.normal_ws = at.lobe.geometric_normal_ws = at.lobe.to_viewer_ws = vec3(0.0f, 0.0f, 1.0f);
  at.lobe.squared_alpha = 0.01f;
  at.reflectance.f0 = vec3(0.04f);
  at.reflectance.f90 = 1.0f;
  at.own.pdf = -1.0f;
  for (const float weight : {1e-10f, 1e-20f, 1e-38f, 1e-45f}) {
    CoatSums sums{};
    sums.light = vec3(weight);
    sums.weight = weight;
    sums.fitting = kRaysOfMean;
    sums.pixels = kLeastPixelWeight;
    const vec3 light = reflected_rays(at, sums).light;
    EXPECT_TRUE(is_number(light)) << weight;
    EXPECT_GE(light.x, 0.0f) << weight;
  }
}

TEST(CoatSums, ExcessIsWhatOneRayBringsAboveHalfOfAllOthers) {
  CoatSums sums = no_coat_sums();
  EXPECT_EQ(excess_of(sums), vec3(0.0f));
  sums.weight = 16.0f;
  sums.brightest_weight = 1.0f;
  sums.light = vec3(3.0f, 6.0f, 1.5f);
  sums.brightest = sums.light / 3.0f;  // half of what the others bring
  EXPECT_NEAR(excess_of(sums).y, 0.0f, 1e-6f);
  sums.brightest = sums.light * 0.75f;  // three times as much
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(excess_of(sums)[c], sums.light[c] * (0.75f - 0.125f), 1e-6f) << c;
  }
  sums.brightest = sums.light;  // no other brings any
  EXPECT_EQ(excess_of(sums), sums.light);
}

// For each direction, whatever the densities are, and where no sample finds the lamp at all.
TEST(CoatShares, RaysAndSamplesOfEmittersShareAllLight) {
  Reflectance metal{};
  metal.f0 = vec3(1.0f);
  metal.f90 = 1.0f;
  metal.alpha = 0.2f;
  const vec3 to_viewer = normalize(vec3(0.3f, 0.1f, 1.0f));
  for (const float fluence : {0.0f, 1e-30f, 0.5f, 40.0f, 1e30f}) {
    const float scale = emitter_density_scale(2u, fluence);
    for (const float emitted : {1e-3f, 1.0f, 1e4f}) {
      for (const vec3& towards : {vec3(0.0f, 0.0f, 1.0f), vec3(-0.3f, -0.1f, 1.0f), vec3(1.0f)}) {
        const vec3 to_light = normalize(towards);
        const float pdf = pdf_ggx_reflection(to_viewer, to_light, metal.alpha);
        const float by_samples =
            sampled_emitter_weight(metal, to_viewer, to_light, 1.0f, emitted * scale);
        const float by_rays = found_light_weight(pdf, sampled_density(emitted, scale));
        EXPECT_NEAR(by_samples + by_rays, 1.0f, 1e-6f) << emitted << ", " << fluence;
        if (fluence == 0.0f) {
          EXPECT_EQ(by_rays, 1.0f);
        }
      }
    }
  }
  EXPECT_EQ(sampled_density(-7.0f, 3.0f), 7.0f);  // of the sky
}

// Where no other lobe fits, nearly all of the light is the own ray's, however even it is.
TEST(CoatSums, HaveNoExcessWhereARayBringsItsShareOfTheWeights) {
  CoatSums sums = no_coat_sums();
  sums.light = vec3(8.0f);
  sums.weight = 4.0f;
  for (const float weight : {0.1f, 1.0f, 3.0f, 3.9f, 4.0f}) {
    sums.brightest_weight = weight;
    sums.brightest = sums.light * (weight / sums.weight);
    EXPECT_NEAR(excess_of(sums).x, 0.0f, 1e-5f) << weight;
  }
}

TEST(CoatDirection, IsADirectionForARoughnessThatRoundingLiftsAboveOne) {
  const vec3 normal(0.0f, 0.0f, 1.0f), to_viewer = normalize(vec3(1.0f, 0.0f, 1.0f));
  const vec3 direction = coat_direction(normal, to_viewer, 1.0f + 1e-6f);
  EXPECT_TRUE(is_number(direction));
  EXPECT_NEAR(glm::distance(direction, normal), 0.0f, 1e-5f);
}

}  // namespace
}  // namespace lambent::glossy_math_test
