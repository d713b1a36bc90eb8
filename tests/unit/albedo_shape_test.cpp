// SPDX-License-Identifier: Apache-2.0
// Albedos of coated surfaces against integrals of their reflection function.
#include "shared/albedo_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "raytracing/shaded_hit.h"

namespace lambent::albedo_shape_test {
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
  return {vec3(0.8f, 0.4f, 0.2f), roughness * roughness, vec3(0.04f), 1.0f, no_layers(), 1.0f};
}

/// What surfaces of all kinds are held to: base and coat, metal, and a faint coat on little.
std::array<Reflectance, 3> coated_surfaces(float roughness) {
  const float alpha = roughness * roughness;
  return {plastic(roughness),
          {vec3(0.0f), alpha, vec3(0.9f, 0.7f, 0.3f), 1.0f, no_layers(), 1.0f},
          {vec3(0.02f), alpha, vec3(0.02f), 0.5f, no_layers(), 1.0f}};
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

TEST(MeanAlbedo, IsTheMeanOverTheCosine) {
  for (const float roughness : {0.05f, 0.3f, 1.0f}) {
    for (const Reflectance& surface : coated_surfaces(roughness)) {
      vec3 mean(0.0f);
      for (int i = 0; i < kSamples; ++i) {
        const float cosine = (static_cast<float>(i) + 0.5f) / kSamples;
        mean += effective_albedo(surface, cosine) * (2.0f * cosine / kSamples);
      }
      const vec3 found = mean_albedo(surface);
      // The polynomials of albedos are good to 0.002
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], mean[c], 0.003f) << roughness;
    }
  }
}

TEST(BoundedAlbedo, BoundsTheMeanAndNotGrazingDirections) {
  constexpr float kBound = 0.95f;
  // The mean of smooth plastic is below the bound, its albedo at grazing angles above 1
  const vec3 grazing = bounded_albedo(plastic(0.1f), 0.1f, kBound);
  EXPECT_GT(grazing.x, 1.2f);
  EXPECT_EQ(grazing, effective_albedo(plastic(0.1f), 0.1f));

  Reflectance white = plastic(0.1f);
  white.diffuse = vec3(1.0f);
  ASSERT_GT(mean_albedo(white).x, 1.0f);
  double mean = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const float cosine = (static_cast<float>(i) + 0.5f) / kSamples;
    mean += 2.0 * cosine * bounded_albedo(white, cosine, kBound).x / kSamples;
  }
  EXPECT_NEAR(mean, kBound, 0.003);

  const Reflectance matte = {vec3(1.0f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
  EXPECT_FLOAT_EQ(bounded_albedo(matte, 0.5f, kBound).x, kBound);
  const Reflectance black = {vec3(0.0f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
  EXPECT_EQ(bounded_albedo(black, 0.5f, kBound), vec3(0.0f));
}

TEST(AlbedoTowards, HasAMeanOfOne) {
  for (const float roughness : {0.05f, 0.2f, 0.5f, 0.8f, 1.0f}) {
    for (const Reflectance& surface : coated_surfaces(roughness)) {
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
  const uint shape = encode_albedo_shape({vec3(0.7f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f});
  EXPECT_EQ(shape, 0u);
  EXPECT_EQ(albedo_towards(shape, 0.2f), 1.0f);
}

/// reflected_cosine() on a surface that faces up and whose base receives this cosine.
float reflected(uint shape, const vec3& to_viewer, const vec3& to_light, float received) {
  const vec3 up(0.0f, 0.0f, 1.0f);
  return reflected_cosine(seen_shape(shape, up, to_viewer), up, to_viewer, to_light, received);
}

/// reflected_cosine() over the cosine.
float reflected(uint shape, const vec3& to_viewer, const vec3& to_light) {
  return reflected(shape, to_viewer, to_light, to_light.z) / to_light.z;
}

TEST(ReflectedCosine, HasAMeanOfOneForEveryViewer) {
  for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f}) {
    for (const Reflectance& surface : coated_surfaces(roughness)) {
      const uint shape = encode_albedo_shape(surface);
      for (const float cosine : {0.15f, 0.5f, 0.95f}) {
        double mean = 0.0;
        for (int i = 0; i < kSamples; ++i) {
          const vec3 to_light = sample_cosine_hemisphere(point_of(i));
          mean += reflected(shape, direction_at(cosine), to_light) / kSamples;
        }
        // The polynomials of albedos are good to 6 % of a coat of f0 = 0.04
        EXPECT_NEAR(mean, 1.0, 0.06) << roughness << ", " << surface.f0.x << ", " << cosine;
      }
    }
  }
}

TEST(ReflectedCosine, IsTheReflectionFunctionOfRoughCoats) {
  const Reflectance gray = {vec3(0.3f), 0.49f, vec3(0.04f), 1.0f, no_layers(), 1.0f};
  const uint shape = encode_albedo_shape(gray);
  for (const float cosine : {0.2f, 0.7f}) {
    const vec3 to_viewer = direction_at(cosine);
    for (int i = 0; i < 64; ++i) {
      const vec3 to_light = sample_cosine_hemisphere(point_of(i * 61));
      const ReflectedPair pair = evaluate_reflectance(gray, to_viewer, to_light);
      const float expected =
          kPi * (pair.diffuse + pair.specular).x / (to_light.z * effective_albedo(gray, cosine).x);
      const float found = reflected(shape, to_viewer, to_light);
      EXPECT_NEAR(found / expected, 1.0f, 0.02f) << cosine << ", " << i;
    }
  }
}

// So weak a coat has no light left in the eight bits of its shape.
TEST(ReflectedCosine, IsFiniteForCoatsThatReflectAlmostNothing) {
  const Reflectance faint = {vec3(0.5f), 0.04f, vec3(1e-6f), 1e-3f, no_layers(), 1.0f};
  const uint shape = encode_albedo_shape(faint);
  ASSERT_NE(shape, 0u);
  EXPECT_NEAR(reflected(shape, direction_at(0.5f), direction_at(0.7f)), 1.0f, 0.01f);
}

// Bumps receive light from the horizon of their mean normal, where a strip of light may lie on the
// floor that it lights. A single such sample made the field of a hangar diverge.
TEST(ReflectedCosine, OfCoatsEndsAtTheHorizon) {
  const Reflectance metal = {vec3(0.0f), 0.1f, vec3(0.1f), 1.0f, no_layers(), 1.0f};
  const Reflectance plastic = {vec3(0.5f), 0.1f, vec3(0.04f), 1.0f, no_layers(), 1.0f};
  constexpr float kReceived = 0.05f;
  const auto towards = [&](const Reflectance& surface, float cosine, float n_dot_l) {
    const vec3 to_light(-std::sqrt(1.0f - n_dot_l * n_dot_l), 0.0f, n_dot_l);
    return reflected(encode_albedo_shape(surface), direction_at(cosine), to_light, kReceived);
  };
  for (const float cosine : {0.01f, 0.3f, 0.9f}) {
    for (const float n_dot_l : {1e-6f, 1e-9f, 1e-14f, 1e-30f, -0.01f}) {
      EXPECT_LT(towards(metal, cosine, n_dot_l), 0.02f) << cosine << ", " << n_dot_l;
      const float of_base = towards(plastic, cosine, n_dot_l);
      EXPECT_LT(of_base, 1.1f * kReceived) << cosine << ", " << n_dot_l;
    }
  }
  EXPECT_GT(towards(plastic, 0.9f, 1e-9f), 0.5f * kReceived);
}

TEST(SeenThroughGlass, LowersNoAlbedoThatIsHighTowardsTheViewerAlone) {
  ShadedHitRecord hit = shaded_sky(vec3(0.0f));
  hit.albedo_over_pi = vec3(1.3f * kInvPi);
  const vec3 share(0.5f);
  EXPECT_EQ(seen_through_glass(hit, share, 1.0f, 0.95f).albedo_over_pi, share * hit.albedo_over_pi);
  EXPECT_EQ(seen_through_glass(hit, share, 2.0f, 0.95f).albedo_over_pi, share * hit.albedo_over_pi);
  hit.albedo_over_pi = vec3(0.6f * kInvPi);
  EXPECT_FLOAT_EQ(seen_through_glass(hit, share, 2.0f, 0.95f).albedo_over_pi.x,
                  0.5f * 0.95f * kInvPi);
}

TEST(ReflectedCosine, WidensTheLobesOfMirrors) {
  const Reflectance mirror = {vec3(0.0f), kMinGgxAlpha, vec3(1.0f), 1.0f, no_layers(), 1.0f};
  const vec3 to_viewer = direction_at(0.7f);
  const vec3 mirrored(-to_viewer.x, 0.0f, to_viewer.z);
  const uint shape = encode_albedo_shape(mirror);
  EXPECT_GT(reflected(shape, to_viewer, mirrored), 5.0f);
  EXPECT_LT(reflected(shape, to_viewer, mirrored), 20.0f);
  EXPECT_LT(reflected(shape, to_viewer, to_viewer), 0.5f);
}

}  // namespace
}  // namespace lambent::albedo_shape_test
