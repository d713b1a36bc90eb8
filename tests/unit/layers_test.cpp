// SPDX-License-Identifier: Apache-2.0
// Sheen and clearcoat: their lobes against integrals, and what they leave to what is under them.
#include "shared/layers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "shared/albedo_shape.h"
#include "shared/brdf.h"
#include "shared/random.h"

namespace lambent::layers_test {
namespace {

constexpr int kSamples = 1 << 15;
// The project's bar for energy.
constexpr float kEnergy = 0.005f;
// The albedo of a coat of F0 = 0.04 is fitted within this share of it (brdf_test.cpp).
constexpr float kOfCoat = 0.012f;

/// Points of a lattice, of `count` in all.
vec3 point_of(int i, int count = kSamples) {
  const auto turned = [i](double step) { return static_cast<float>(std::fmod(i * step, 1.0)); };
  return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count), turned(0.6180339887498949),
          turned(0.7548776662466927)};
}

vec3 direction_at(float cosine) {
  return {std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
}

SurfaceLayers sheen(float roughness, const vec3& color = vec3(1.0f)) {
  SurfaceLayers layers = no_layers();
  layers.sheen = color;
  layers.sheen_roughness = roughness;
  return layers;
}

SurfaceLayers clearcoat(float roughness, float share = 1.0f) {
  SurfaceLayers layers = no_layers();
  layers.clearcoat = share;
  layers.clearcoat_alpha = std::max(roughness * roughness, kMinGgxAlpha);
  return layers;
}

/// Layers on it, seen at a cosine to all its normals.
Reflectance layered(Reflectance surface, SurfaceLayers layers, float cosine) {
  layers.clearcoat_cosine = cosine;
  surface.layers = layers;
  return surface;
}

Reflectance white() {
  return {vec3(1.0f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
}
Reflectance plastic(float roughness) {
  return {vec3(0.8f, 0.4f, 0.2f), roughness * roughness, vec3(0.04f), 1.0f, no_layers(), 1.0f};
}
Reflectance metal(float roughness) {
  return {vec3(0.0f), roughness * roughness, vec3(1.0f), 1.0f, no_layers(), 1.0f};
}

/// Share of light from a uniform sky that a surface reflects, by its own sampling.
vec3 reflected_share(const Reflectance& surface, float cosine) {
  const vec3 to_viewer = direction_at(cosine);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    const vec3 to_light = sample_reflectance(surface, to_viewer, point_of(i));
    const float pdf = pdf_reflectance(surface, to_viewer, to_light);
    if (!(pdf > 0.0f)) continue;
    const ReflectedPair reflected = evaluate_reflectance(surface, to_viewer, to_light);
    sum += (reflected.diffuse + reflected.specular) / pdf;
  }
  return vec3(sum / static_cast<double>(kSamples));
}

TEST(Sheen, ItsAlbedoIsTheIntegralOfItsLobe) {
  for (const float roughness : {0.25f, 0.33f, 0.5f, 0.7f, 0.86f, 1.0f}) {
    for (const float cosine : {0.04f, 0.1f, 0.25f, 0.5f, 0.8f, 0.97f}) {
      // Grazing light counts most: points are spread evenly in the square root of the cosine
      double sum = 0.0;
      for (int i = 0; i < kSamples; ++i) {
        const vec3 u = point_of(i);
        const float z = u.x * u.x, r = std::sqrt(1.0f - z * z), angle = kTwoPi * u.y;
        const vec3 to_light(r * std::cos(angle), r * std::sin(angle), z);
        sum += sheen_lobe(direction_at(cosine), to_light, roughness) * kTwoPi * 2.0f * u.x;
      }
      EXPECT_NEAR(sheen_albedo(cosine, roughness), sum / kSamples, kEnergy)
          << "roughness " << roughness << ", cosine " << cosine;
    }
  }
}

TEST(Sheen, NeverReflectsMoreThanArrives) {
  for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.05f) {
    for (float cosine = 0.0f; cosine <= 1.0f; cosine += 0.01f) {
      EXPECT_LE(sheen_albedo(cosine, roughness), 1.0f);
    }
  }
}

TEST(Sheen, ItsMeanAlbedoIsTheMeanOfItsAlbedo) {
  for (float roughness = kMinSheenRoughness; roughness <= 1.0f; roughness += 0.05f) {
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const float cosine = (static_cast<float>(i) + 0.5f) / kSamples;
      sum += 2.0 * cosine * sheen_albedo(cosine, roughness) / kSamples;
    }
    EXPECT_NEAR(mean_sheen_albedo(roughness), sum, 0.002) << roughness;
  }
}

// Narrower lobes than can be had are wider and fainter, and reflect as much in all.
TEST(Sheen, FadesWhereItIsNarrow) {
  EXPECT_EQ(narrow_sheen_factor(0.0f), 0.0f);
  EXPECT_NEAR(narrow_sheen_factor(kMinSheenRoughness), 1.0f, 0.01f);
  for (const float roughness : {0.1f, 0.2f}) {
    double sum = 0.0;
    for (int i = 0; i < 4 * kSamples; ++i) {
      // Both cosines are drawn: the mean albedo
      const vec3 u = point_of(i, 4 * kSamples);
      const float third = u.z;
      const float z = u.x * u.x, r = std::sqrt(1.0f - z * z), angle = kTwoPi * u.y;
      const float cosine = third * third;
      sum += sheen_lobe(direction_at(cosine), {r * std::cos(angle), r * std::sin(angle), z},
                        roughness) *
             kTwoPi * 2.0f * u.x * 2.0f * cosine * 2.0f * third;
    }
    const double mean = sum / (4 * kSamples);
    EXPECT_NEAR(narrow_sheen_factor(roughness) * mean_sheen_albedo(kMinSheenRoughness) / mean, 1.0,
                0.05)
        << roughness;
  }
}

// Over a white base, what a layer reflects and what it leaves to the base is all light but for what
// the clearcoat's own microfacets lose: of a sheen 1, of a clearcoat 1 - F(v) + its albedo.
TEST(Layers, OverAWhiteBaseReflectAllLight) {
  for (const float cosine : {0.1f, 0.3f, 0.6f, 0.95f}) {
    for (const float roughness : {0.3f, 0.6f, 1.0f}) {
      EXPECT_NEAR(reflected_share(layered(white(), sheen(roughness), cosine), cosine).x, 1.0f,
                  kEnergy)
          << "sheen " << roughness << ", cosine " << cosine;
    }
    for (const float roughness : {0.05f, 0.3f, 0.7f}) {
      const Reflectance surface = layered(white(), clearcoat(roughness), cosine);
      const float own = clearcoat_albedo(surface.layers);
      const float found = reflected_share(surface, cosine).x;
      EXPECT_LE(found, 1.0f + kEnergy);
      EXPECT_NEAR(found, clearcoat_transmittance(surface.layers, cosine) + own,
                  kEnergy + kOfCoat * own)
          << "clearcoat " << roughness << ", cosine " << cosine;
    }
  }
}

TEST(Layers, TheAlbedoIsTheIntegralOfAllLobes) {
  const std::array<SurfaceLayers, 4> all = {clearcoat(0.1f), clearcoat(0.5f, 0.5f),
                                            sheen(0.5f, {0.9f, 0.5f, 0.2f}), [] {
                                              SurfaceLayers both = sheen(0.8f, vec3(0.3f));
                                              both.clearcoat = 1.0f;
                                              both.clearcoat_alpha = 0.04f;
                                              return both;
                                            }()};
  for (const SurfaceLayers& layers : all) {
    for (const Reflectance& under :
         {plastic(0.5f), plastic(0.9f), metal(0.1f), metal(0.4f), metal(0.8f)}) {
      for (const float cosine : {0.15f, 0.4f, 0.7f, 0.98f}) {
        const Reflectance surface = layered(under, layers, cosine);
        const vec3 found = reflected_share(surface, cosine);
        const vec3 expected = effective_albedo(surface, cosine);
        // Metals have the errors of three fits: of their albedo, of the clearcoat's, and of what it
        // leaves to them. Under a sheen theirs is an interpolation
        const bool is_metal = under.f0.x == 1.0f;
        const float own = clearcoat_albedo(surface.layers);
        const float tolerance = kOfCoat * own + (!is_metal           ? 2.0f * kEnergy
                                                 : has_sheen(layers) ? 0.035f
                                                                     : 0.015f);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(expected[c], found[c], tolerance)
              << "cosine " << cosine << ", f0 " << under.f0.x << ", alpha " << under.alpha
              << ", clearcoat " << layers.clearcoat << ", sheen " << layers.sheen.x;
        }
        EXPECT_LE(found.x, is_metal ? 1.0f + kEnergy : 2.0f);
      }
    }
  }
}

TEST(Layers, AreReciprocal) {
  RandomStream random = make_random_stream(5u, 0u, 0u);
  for (int i = 0; i < 1000; ++i) {
    SurfaceLayers layers = sheen(0.25f + 0.75f * next_uniform(random), vec3(0.7f));
    layers.clearcoat = next_uniform(random);
    layers.clearcoat_alpha = 0.01f + 0.5f * next_uniform(random);
    layers.clearcoat_normal = normalize(vec3(0.1f, 0.2f, 1.0f));
    const Reflectance surface = layered(plastic(0.5f), layers, 1.0f);
    const vec3 a = sample_cosine_hemisphere(next_uniform2(random));
    const vec3 b = sample_cosine_hemisphere(next_uniform2(random));
    const ReflectedLobes ab = evaluate_lobes(surface, a, b);
    const ReflectedLobes ba = evaluate_lobes(surface, b, a);
    const auto expect_same = [](float x, float y) { EXPECT_NEAR(x, y, 1e-3f * (1.0f + x)); };
    expect_same(ab.diffuse.x / b.z, ba.diffuse.x / a.z);
    expect_same(ab.specular.x / b.z, ba.specular.x / a.z);
    expect_same(ab.clearcoat / dot(layers.clearcoat_normal, b),
                ba.clearcoat / dot(layers.clearcoat_normal, a));
  }
}

// A surface without layers is what it was before there were any, to the bit.
TEST(Layers, ThatAreAbsentChangeNothing) {
  RandomStream random = make_random_stream(7u, 0u, 0u);
  for (int i = 0; i < 100; ++i) {
    const Reflectance surface = plastic(0.1f + 0.9f * next_uniform(random));
    const vec3 a = sample_cosine_hemisphere(next_uniform2(random));
    const vec3 b = sample_cosine_hemisphere(next_uniform2(random));
    const ReflectedPair bare = evaluate_under_layers(surface, a, b);
    const ReflectedPair pair = evaluate_reflectance(surface, a, b);
    EXPECT_EQ(pair.diffuse, bare.diffuse);
    EXPECT_EQ(pair.specular, bare.specular);
    EXPECT_EQ(pdf_clearcoat(surface.layers, a, b) * lobe_shares(surface, a.z).clearcoat, 0.0f);
  }
}

TEST(Layers, AlbedoTowardsLightFollowsTheAlbedo) {
  const std::array<Reflectance, 4> surfaces = {
      layered(plastic(0.6f), clearcoat(0.05f), 1.0f), layered(metal(0.6f), clearcoat(0.3f), 1.0f),
      layered(white(), sheen(0.5f), 1.0f),
      layered({vec3(0.02f), 1.0f, vec3(0.04f), 1.0f, no_layers(), 1.0f}, sheen(1.0f), 1.0f)};
  for (const Reflectance& surface : surfaces) {
    const uint shape = encode_albedo_shape(surface);
    double mean = 0.0, expected_mean = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const float cosine = (static_cast<float>(i) + 0.5f) / 1000.0f;
      mean += 2.0 * cosine * albedo_towards(shape, cosine) / 1000.0;
      expected_mean +=
          2.0 * cosine *
          luminance(effective_albedo(layered(surface, surface.layers, cosine), cosine)) / 1000.0;
    }
    EXPECT_NEAR(mean, 1.0, kEnergy);
    for (const float cosine : {0.2f, 0.5f, 0.8f, 1.0f}) {
      const double expected =
          luminance(effective_albedo(layered(surface, surface.layers, cosine), cosine)) /
          expected_mean;
      EXPECT_NEAR(albedo_towards(shape, cosine), expected, 0.05 * expected + 0.02) << cosine;
    }
  }
}

}  // namespace
}  // namespace lambent::layers_test
