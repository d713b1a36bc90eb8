// SPDX-License-Identifier: Apache-2.0
#include "field/transport/blend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "field/probes/tile.h"
#include "shared/random.h"

namespace lambent::blend_test {
namespace {

// The kernel adds floats in the order of the rays, as the plain loop in double does not.
constexpr double kRelativeTolerance = 2e-5;

struct Case {
  int texels;  // along an edge: 4 to 1024 in all, whole and broken blocks of the kernel
  int rays;
  float exponent;
};

class Blend : public testing::TestWithParam<Case> {};

/// Sums over rays, texel by texel, as the paper writes them.
std::vector<double> plain_sums(const Case& c, std::span<const vec3> directions,
                               const std::vector<float>& values, int channels) {
  std::vector<double> sums(c.texels * c.texels * channels, 0.0);
  for (int t = 0; t < c.texels * c.texels; ++t) {
    const glm::dvec3 normal(tile_direction({t % c.texels, t / c.texels}, c.texels));
    for (int i = 0; i < c.rays; ++i) {
      const double cosine = std::max(0.0, glm::dot(normal, glm::dvec3(directions[i])));
      const double weight = std::pow(cosine, c.exponent);
      for (int k = 0; k < channels; ++k) {
        sums[t * channels + k] += weight * values[i * channels + k];
      }
    }
  }
  return sums;
}

TEST_P(Blend, EqualsTheLoopOverRaysTexelByTexel) {
  const Case c = GetParam();
  const std::vector<vec3> directions = probe_ray_directions(c.rays, 3, 5);
  const BlendMatrix blend(c.texels, c.exponent, directions);
  ASSERT_EQ(blend.texels(), c.texels * c.texels);
  ASSERT_EQ(blend.rays(), c.rays);
  RandomStream random = make_random_stream(c.texels, c.rays, 0);
  for (const int channels : {2, 4}) {
    std::vector<float> values(c.rays * channels);
    for (float& value : values) value = 10.0f * next_uniform(random);
    const std::vector<double> expected = plain_sums(c, directions, values, channels);

    // What lies beyond the sums must stay as it is
    constexpr float kUntouched = -7.0f;
    std::vector<float> sums(expected.size() + 64, kUntouched);
    if (channels == 2) {
      blend.apply2(values.data(), sums.data());
    } else {
      blend.apply4(values.data(), sums.data());
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(sums[i], expected[i], kRelativeTolerance * expected[i] + 1e-6) << i;
    }
    for (std::size_t i = expected.size(); i < sums.size(); ++i) EXPECT_EQ(sums[i], kUntouched);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Blend,
                         testing::Values(Case{4, 144, 1.0f}, Case{14, 144, 50.0f},
                                         Case{2, 16, 1.0f}, Case{3, 17, 1.0f}, Case{5, 100, 50.0f},
                                         Case{6, 33, 1.0f}, Case{7, 257, 50.0f},
                                         Case{32, 64, 50.0f}));

TEST(BlendMatrix, TakesAnyMatrixByColumns) {
  constexpr int kTexels = 5, kRays = 3;
  std::vector<float> columns(kTexels * kRays);
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = static_cast<float>(i) - 6.0f;
  const BlendMatrix matrix(kTexels, kRays, columns);
  const float values[2 * kRays] = {1.0f, 0.5f, -2.0f, 3.0f, 4.0f, -1.0f};
  float sums[2 * kTexels];
  matrix.apply2(values, sums);
  for (int t = 0; t < kTexels; ++t) {
    float expected[2] = {0.0f, 0.0f};
    for (int i = 0; i < kRays; ++i) {
      EXPECT_EQ(matrix.weight(t, i), columns[i * kTexels + t]);
      for (int k = 0; k < 2; ++k) expected[k] += columns[i * kTexels + t] * values[2 * i + k];
    }
    EXPECT_FLOAT_EQ(sums[2 * t], expected[0]);
    EXPECT_FLOAT_EQ(sums[2 * t + 1], expected[1]);
  }
}

TEST(ProbeRays, AreUnitEvenAndDifferForEachUpdateAndSeed) {
  constexpr int kRays = 144;
  const std::vector<vec3> directions = probe_ray_directions(kRays, 0, 1);
  ASSERT_EQ(directions.size(), static_cast<std::size_t>(kRays));
  glm::dvec3 mean(0.0);
  glm::dmat3 second(0.0);
  for (const vec3& d : directions) {
    EXPECT_NEAR(length(d), 1.0f, 1e-6f);
    mean += glm::dvec3(d) / static_cast<double>(kRays);
    second += glm::outerProduct(glm::dvec3(d), glm::dvec3(d)) / static_cast<double>(kRays);
  }
  // A lattice integrates linear and quadratic functions far better than 144 random rays would
  EXPECT_LT(glm::length(mean), 0.01);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(second[i][j], i == j ? 1.0 / 3.0 : 0.0, 0.01);
  }
  EXPECT_EQ(directions, probe_ray_directions(kRays, 0, 1));
  EXPECT_NE(directions, probe_ray_directions(kRays, 1, 1));
  EXPECT_NE(directions, probe_ray_directions(kRays, 0, 2));
}

}  // namespace
}  // namespace lambent::blend_test
