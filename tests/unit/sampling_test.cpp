// SPDX-License-Identifier: Apache-2.0
#include "shared/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "reference/sampler.h"
#include "shared/random.h"
#include "support/chi_squared.h"

namespace lambent::sampling_test {
namespace {

TEST(Sampling, FrameIsOrthonormalForEveryNormal) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Frame f = make_frame(spherical_fibonacci(i, 1000));
    EXPECT_NEAR(dot(f.tangent, f.bitangent), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(f.tangent, f.normal), 0.0f, 1e-6f);
    EXPECT_NEAR(length(f.tangent), 1.0f, 1e-6f);
    EXPECT_GT(dot(cross(f.tangent, f.bitangent), f.normal), 0.999f);
  }
  EXPECT_NEAR(length(make_frame(vec3(0.0f, 0.0f, -1.0f)).tangent), 1.0f, 1e-6f);
}

TEST(Sampling, FrameRoundTrips) {
  RandomStream random = make_random_stream(1u, 0u, 0u);
  for (int i = 0; i < 100; ++i) {
    const Frame frame = make_frame(sample_uniform_sphere(next_uniform2(random)));
    const vec3 v = sample_uniform_sphere(next_uniform2(random));
    EXPECT_NEAR(length(to_world(frame, to_local(frame, v)) - v), 0.0f, 1e-6f);
  }
}

TEST(Sampling, CosineHemisphereRoundTrips) {
  RandomStream random = make_random_stream(2u, 0u, 0u);
  for (int i = 0; i < 1000; ++i) {
    const vec2 u = next_uniform2(random);
    const vec3 direction = sample_cosine_hemisphere(u);
    EXPECT_NEAR(length(direction), 1.0f, 1e-6f);
    EXPECT_NEAR(length(invert_cosine_hemisphere(direction) - u), 0.0f, 1e-4f);
  }
}

TEST(Sampling, CosineHemisphereHasTheMeansOfItsDensity) {
  RandomStream random = make_random_stream(3u, 0u, 0u);
  constexpr int kCount = 100000;
  double cosine = 0.0, inverse_density = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const float z = sample_cosine_hemisphere(next_uniform2(random)).z;
    cosine += z;
    inverse_density += z / pdf_cosine_hemisphere(z);
  }
  EXPECT_NEAR(cosine / kCount, 2.0 / 3.0, 0.003);
  EXPECT_NEAR(inverse_density / kCount, kPi, 1e-4);
}

TEST(Sampling, UniformConeHasItsDensityInAllRings) {
  constexpr float kLeastCosine = 0.9f;
  constexpr std::size_t kRings = 16, kCount = 4096;
  RandomStream random = make_random_stream(1u, 1u, 1u);
  std::vector<double> observed(kRings), expected(kRings);
  // Rings between evenly spaced cosines have the same solid angle
  const double of_ring = kTwoPi * (1.0 - kLeastCosine) / kRings;
  for (double& count : expected) count = kCount * of_ring * pdf_uniform_cone(kLeastCosine);
  for (std::size_t i = 0; i < kCount; ++i) {
    const vec3 w = sample_uniform_cone(next_uniform2(random), kLeastCosine);
    EXPECT_NEAR(length(w), 1.0f, 1e-5f);
    EXPECT_GE(w.z, kLeastCosine);
    const float place = (1.0f - w.z) / (1.0f - kLeastCosine);
    ++observed[std::min(static_cast<std::size_t>(place * kRings), kRings - 1)];
  }
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
}

TEST(Sampling, UniformSphereHasNoPreferredDirection) {
  RandomStream random = make_random_stream(4u, 0u, 0u);
  constexpr int kCount = 100000;
  glm::dvec3 mean(0.0), squares(0.0);
  for (int i = 0; i < kCount; ++i) {
    const glm::dvec3 w(sample_uniform_sphere(next_uniform2(random)));
    mean += w;
    squares += w * w;
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k] / kCount, 0.0, 0.008);
    EXPECT_NEAR(squares[k] / kCount, 1.0 / 3.0, 0.004);
  }
  EXPECT_FLOAT_EQ(pdf_uniform_sphere() * 4.0f * kPi, 1.0f);
}

TEST(Sampling, TriangleBarycentricsAreUniform) {
  RandomStream random = make_random_stream(5u, 0u, 0u);
  constexpr int kCount = 100000;
  glm::dvec2 mean(0.0);
  int in_corner = 0;  // the quarter of the area next to the first vertex
  for (int i = 0; i < kCount; ++i) {
    const vec2 b = sample_uniform_triangle(next_uniform2(random));
    ASSERT_GE(std::min(b.x, b.y), 0.0f);
    ASSERT_LE(b.x + b.y, 1.0f + 1e-6f);
    mean += b;
    in_corner += b.x + b.y < 0.5f ? 1 : 0;
  }
  EXPECT_NEAR(mean.x / kCount, 1.0 / 3.0, 0.003);
  EXPECT_NEAR(mean.y / kCount, 1.0 / 3.0, 0.003);
  EXPECT_NEAR(static_cast<double>(in_corner) / kCount, 0.25, 0.006);
}

TEST(Sampling, SphericalFibonacciIsEven) {
  constexpr std::uint32_t kCount = 512;
  std::vector<vec3> points;
  vec3 sum(0.0f);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    points.push_back(spherical_fibonacci(i, kCount));
    sum += points.back();
  }
  EXPECT_LT(length(sum) / kCount, 1e-3f);
  // Every point's nearest neighbour is about as far as in a hexagonal lattice of that density
  const float hexagonal = std::sqrt(8.0f * kPi / (std::sqrt(3.0f) * kCount));
  for (const vec3& p : points) {
    float nearest = 2.0f;
    for (const vec3& q : points) {
      if (p != q) nearest = std::min(nearest, length(p - q));
    }
    EXPECT_GT(nearest, 0.7f * hexagonal);
    EXPECT_LT(nearest, 1.1f * hexagonal);
  }
}

TEST(Sampling, RotationsArePureAndUniform) {
  RandomStream random = make_random_stream(6u, 0u, 0u);
  constexpr int kCount = 20000;
  glm::dvec3 mean(0.0);
  for (int i = 0; i < kCount; ++i) {
    const vec2 u = next_uniform2(random);
    const mat3 r = sample_uniform_rotation(vec3(u, next_uniform(random)));
    EXPECT_NEAR(glm::determinant(r), 1.0f, 1e-5f);
    mean += glm::dvec3(r * vec3(0.0f, 0.6f, 0.8f));
  }
  EXPECT_LT(glm::length(mean) / kCount, 0.02);
}

TEST(Sampling, PowerHeuristicWeightsSumToOne) {
  EXPECT_FLOAT_EQ(mis_power_weight(0.3f, 2.0f) + mis_power_weight(2.0f, 0.3f), 1.0f);
  EXPECT_FLOAT_EQ(mis_power_weight(1.0f, 0.0f), 1.0f);
  EXPECT_FLOAT_EQ(mis_power_weight(1.0f, std::numeric_limits<float>::infinity()), 0.0f);
}

TEST(SobolSampler, PutsOnePointInEveryElementaryInterval) {
  // 256 points: every cell of every 2^a x 2^(8-a) grid holds exactly one
  constexpr int kLog = 8;
  for (int pair = 0; pair < 3; ++pair) {
    std::vector<glm::vec2> points;
    for (std::uint32_t i = 0; i < (1u << kLog); ++i) {
      reference::SobolSampler sampler(1234u, i);
      for (int skip = 0; skip < pair; ++skip) sampler.next2();
      points.push_back(sampler.next2());
    }
    for (int a = 0; a <= kLog; ++a) {
      std::vector<int> counts(1u << kLog, 0);
      for (const glm::vec2& p : points) {
        const int x = static_cast<int>(p.x * static_cast<float>(1 << a));
        const int y = static_cast<int>(p.y * static_cast<float>(1 << (kLog - a)));
        ++counts[(y << a) | x];
      }
      EXPECT_EQ(std::count(counts.begin(), counts.end(), 1), 1 << kLog) << pair << " " << a;
    }
  }
}

TEST(SobolSampler, IsUniformOverSeeds) {
  // One sample each of many pixels: nothing but the scrambling makes it random
  constexpr int kCount = 100000;
  glm::dvec2 mean(0.0);
  double product = 0.0, across_pairs = 0.0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    reference::SobolSampler sampler(hash_pcg(i), 0u);
    const glm::dvec2 u(sampler.next2()), v(sampler.next2());
    mean += u;
    product += u.x * u.y;
    across_pairs += u.x * v.x;
  }
  EXPECT_NEAR(mean.x / kCount, 0.5, 0.004);
  EXPECT_NEAR(mean.y / kCount, 0.5, 0.004);
  EXPECT_NEAR(product / kCount, 0.25, 0.003);
  EXPECT_NEAR(across_pairs / kCount, 0.25, 0.003);
}

}  // namespace
}  // namespace lambent::sampling_test
