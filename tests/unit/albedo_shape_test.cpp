// SPDX-License-Identifier: Apache-2.0
// Albedos of coated surfaces against integrals of their reflection function.
#include "shared/albedo_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lambent {
namespace {

constexpr int kSamples = 4096;

vec2 point_of(int i) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  return {(static_cast<float>(i) + 0.5f) / kSamples,
          static_cast<float>(std::fmod(i * kGoldenRatio, 1.0))};
}

vec3 direction_at(float cosine) {
  return {std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
}

Reflectance plastic(float roughness) {
  return {vec3(0.8f, 0.4f, 0.2f), roughness * roughness, vec3(0.04f), 1.0f, no_layers()};
}

TEST(BaseAlbedo, IsTheIntegralOfTheBase) {
  for (const float cosine : {0.05f, 0.3f, 0.6f, 0.95f}) {
    vec3 sum(0.0f);
    for (int i = 0; i < kSamples; ++i) {
      const vec3 to_light = sample_cosine_hemisphere(point_of(i));
      const vec3 value =
          evaluate_reflectance(plastic(0.5f), direction_at(cosine), to_light).diffuse;
      sum += value / pdf_cosine_hemisphere(to_light.z);
    }
    const vec3 expected = sum / static_cast<float>(kSamples);
    const vec3 found = base_albedo(plastic(0.5f), cosine);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1.0f, 0.001f) << cosine;
  }
}

TEST(AlbedoTowards, HasAMeanOfOne) {
  for (const float roughness : {0.05f, 0.2f, 0.5f, 0.8f, 1.0f}) {
    const std::array<Reflectance, 3> surfaces = {
        plastic(roughness),
        Reflectance{vec3(0.0f), roughness * roughness, vec3(0.9f, 0.7f, 0.3f), 1.0f, no_layers()},
        Reflectance{vec3(0.02f), roughness * roughness, vec3(0.02f), 0.5f, no_layers()}};
    for (const Reflectance& surface : surfaces) {
      const uint shape = encode_albedo_shape(surface);
      double mean = 0.0;
      for (int i = 0; i < kSamples; ++i) {
        const float cosine = (static_cast<float>(i) + 0.5f) / kSamples;
        mean += 2.0 * cosine * albedo_towards(shape, cosine) / kSamples;
      }
      EXPECT_NEAR(mean, 1.0, 0.02) << "roughness " << roughness << ", f0 " << surface.f0.x;
    }
  }
}

TEST(AlbedoTowards, SendsMoreOfGrazingLightBack) {
  const uint shape = encode_albedo_shape(plastic(0.3f));
  EXPECT_LT(albedo_towards(shape, 0.9f), 0.98f);
  EXPECT_GT(albedo_towards(shape, 0.1f), 1.2f);
}

TEST(AlbedoTowards, IsOneWithoutACoat) {
  const uint shape = encode_albedo_shape({vec3(0.7f), 1.0f, vec3(0.0f), 0.0f, no_layers()});
  EXPECT_EQ(shape, 0u);
  EXPECT_EQ(albedo_towards(shape, 0.2f), 1.0f);
}

}  // namespace
}  // namespace lambent
