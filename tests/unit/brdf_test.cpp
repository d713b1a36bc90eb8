// SPDX-License-Identifier: Apache-2.0
#include "shared/brdf.h"

#include <gtest/gtest.h>

#include <vector>

#include "shared/random.h"
#include "support/chi_squared.h"

namespace lambent::brdf_test {
namespace {

constexpr int kSamples = 200000;
// Cells of the (z, angle) grid over the hemisphere, and midpoints a side that integrate a density
// over a cell.
constexpr int kCellsZ = 16;
constexpr int kCellsAngle = 32;
constexpr int kMidpoints = 8;

vec3 from_z_angle(float z, float angle) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

vec3 viewer(float degrees) {
  const float angle = degrees * kPi / 180.0f;
  return {std::sin(angle), 0.0f, std::cos(angle)};
}

Reflectance dielectric(float roughness, const vec3& albedo = vec3(0.6f)) {
  return {albedo, std::max(roughness * roughness, kMinGgxAlpha), vec3(0.04f), 1.0f, no_layers(),
          1.0f};
}
Reflectance metal(float roughness) {
  return {vec3(0.0f), std::max(roughness * roughness, kMinGgxAlpha), vec3(1.0f), 1.0f, no_layers(),
          1.0f};
}

vec3 reflected_share(const Reflectance& surface, const vec3& to_viewer) {
  RandomStream random = make_random_stream(1u, 2u, 3u);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    const vec2 u = next_uniform2(random);
    const vec3 to_light = sample_reflectance(surface, to_viewer, vec3(u, next_uniform(random)));
    const float pdf = pdf_reflectance(surface, to_viewer, to_light);
    if (pdf <= 0.0f) continue;
    const ReflectedPair reflected = evaluate_reflectance(surface, to_viewer, to_light);
    sum += (reflected.diffuse + reflected.specular) / pdf;
  }
  return vec3(sum / static_cast<double>(kSamples));
}

TEST(Brdf, ReflectsNoMoreThanArrives) {
  for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f}) {
    for (const float degrees : {0.0f, 45.0f, 80.0f}) {
      // glTF's coat does not darken the base at grazing view, so only darker bases stay below 1
      EXPECT_LE(reflected_share(dielectric(roughness), viewer(degrees)).x, 1.0f);
      EXPECT_LE(reflected_share(metal(roughness), viewer(degrees)).x, 1.01f);
    }
  }
}

TEST(Brdf, SmoothMetalReflectsEverything) {
  EXPECT_NEAR(reflected_share(metal(0.05f), viewer(30.0f)).x, 1.0f, 0.01f);
}

TEST(Brdf, LambertReflectsExactlyItsAlbedo) {
  const Reflectance surface = {vec3(0.2f, 0.5f, 0.8f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
  const vec3 share = reflected_share(surface, viewer(60.0f));
  EXPECT_NEAR(share.x, 0.2f, 1e-5f);
  EXPECT_NEAR(share.y, 0.5f, 1e-5f);
  EXPECT_NEAR(share.z, 0.8f, 1e-5f);
}

TEST(Brdf, IsReciprocal) {
  RandomStream random = make_random_stream(5u, 0u, 0u);
  for (int i = 0; i < 1000; ++i) {
    const Reflectance surface = dielectric(0.1f + 0.9f * next_uniform(random));
    const vec3 a = sample_cosine_hemisphere(next_uniform2(random));
    const vec3 b = sample_cosine_hemisphere(next_uniform2(random));
    const ReflectedPair ab = evaluate_reflectance(surface, a, b);
    const ReflectedPair ba = evaluate_reflectance(surface, b, a);
    EXPECT_NEAR(ab.diffuse.x / b.z, ba.diffuse.x / a.z, 1e-4f);
    EXPECT_NEAR(ab.specular.x / b.z, ba.specular.x / a.z, 1e-3f * (1.0f + ab.specular.x / b.z));
  }
}

TEST(Brdf, IsDarkBelowTheHorizon) {
  const ReflectedPair below =
      evaluate_reflectance(dielectric(0.5f), viewer(30.0f), {0.0f, 0.6f, -0.8f});
  EXPECT_EQ(below.diffuse + below.specular, vec3(0.0f));
  EXPECT_EQ(pdf_ggx_reflection(viewer(30.0f), {0.0f, 0.6f, -0.8f}, 0.5f), 0.0f);
}

TEST(Brdf, SpecularAlbedoFollowsTheReflectedLight) {
  // The fits are good to 0.3 % of what a coat reflects, and to 0.7 % where f0 = 0.04
  for (const float roughness : {0.05f, 0.2f, 0.5f, 0.9f, 1.0f}) {
    for (const float degrees : {5.0f, 40.0f, 70.0f, 85.0f}) {
      const vec3 to_viewer = viewer(degrees);
      const Reflectance coat = dielectric(roughness, vec3(0.0f));
      const float share = reflected_share(coat, to_viewer).x;
      EXPECT_NEAR(specular_albedo(coat, to_viewer.z).x, share, 0.012f * share);
      EXPECT_NEAR(specular_albedo(metal(roughness), to_viewer.z).x,
                  reflected_share(metal(roughness), to_viewer).x, 0.005f);
    }
  }
}

struct SamplerCase {
  float roughness;
  float degrees;
  bool is_metal;
  float clearcoat_roughness = -1.0f;  // less than 0: there is no clearcoat
};

class BrdfSampling : public testing::TestWithParam<SamplerCase> {};

// Counts samples a cell beside what the density, integrated over the cell, promises. The rest of
// the samples, below the horizon, counts as one more cell.
TEST_P(BrdfSampling, FollowsItsDensity) {
  Reflectance surface =
      GetParam().is_metal ? metal(GetParam().roughness) : dielectric(GetParam().roughness);
  if (GetParam().clearcoat_roughness >= 0.0f) {
    surface.layers.clearcoat = 1.0f;
    surface.layers.clearcoat_alpha = std::pow(GetParam().clearcoat_roughness, 2.0f);
    surface.layers.clearcoat_normal = normalize(vec3(0.2f, -0.1f, 1.0f));
  }
  const vec3 to_viewer = viewer(GetParam().degrees);
  std::vector<double> observed(kCellsZ * kCellsAngle + 1), expected(observed.size());

  RandomStream random = make_random_stream(11u, 0u, 0u);
  for (int i = 0; i < kSamples; ++i) {
    const vec2 u = next_uniform2(random);
    const vec3 w = sample_reflectance(surface, to_viewer, vec3(u, next_uniform(random)));
    // A clearcoat has a horizon of its own
    if (w.z <= 0.0f || pdf_reflectance(surface, to_viewer, w) <= 0.0f) {
      observed.back() += 1.0;
      continue;
    }
    const float turn = std::atan2(w.y, w.x) / kTwoPi;
    const int cell_z = std::min(static_cast<int>(w.z * kCellsZ), kCellsZ - 1);
    const int cell_angle = static_cast<int>((turn - std::floor(turn)) * kCellsAngle) % kCellsAngle;
    observed[cell_z * kCellsAngle + cell_angle] += 1.0;
  }

  double total = 0.0;
  const float kStepZ = 1.0f / (kCellsZ * kMidpoints);
  const float kStepAngle = kTwoPi / (kCellsAngle * kMidpoints);
  for (int z = 0; z < kCellsZ * kMidpoints; ++z) {
    for (int a = 0; a < kCellsAngle * kMidpoints; ++a) {
      const vec3 w = from_z_angle((static_cast<float>(z) + 0.5f) * kStepZ,
                                  (static_cast<float>(a) + 0.5f) * kStepAngle);
      const double share = pdf_reflectance(surface, to_viewer, w) * kStepZ * kStepAngle;
      expected[(z / kMidpoints) * kCellsAngle + a / kMidpoints] += share * kSamples;
      total += share;
    }
  }
  expected.back() = std::max(0.0, 1.0 - total) * kSamples;
  EXPECT_LE(total, 1.002);
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

INSTANTIATE_TEST_SUITE_P(
    Brdf, BrdfSampling,
    testing::Values(SamplerCase{1.0f, 0.0f, false}, SamplerCase{1.0f, 70.0f, true},
                    SamplerCase{0.6f, 45.0f, false}, SamplerCase{0.6f, 80.0f, true},
                    SamplerCase{0.5f, 20.0f, true}, SamplerCase{0.6f, 45.0f, false, 0.5f},
                    SamplerCase{0.8f, 30.0f, true, 0.6f}));

}  // namespace
}  // namespace lambent::brdf_test
