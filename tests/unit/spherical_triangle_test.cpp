// SPDX-License-Identifier: Apache-2.0
// Solid angles of triangles, and points drawn from them.
#include "shared/spherical_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "raytracing/emitter_sampling.h"
#include "shared/constants.h"
#include "shared/random.h"
#include "support/chi_squared.h"

namespace lambent::spherical_triangle_test {
namespace {

struct Corners {
  glm::vec3 a, b, c;
};

SphericalTriangle seen_from_origin(const Corners& t) {
  return spherical_triangle(glm::normalize(t.a), glm::normalize(t.b), glm::normalize(t.c));
}

// Round, thin and close triangles, one around the nearest point of its plane, and a small one.
const std::vector<Corners> kTriangles = {
    {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}},
    {{-3.0f, -2.0f, 0.05f}, {4.0f, -2.0f, 0.05f}, {0.3f, 5.0f, 0.05f}},
    {{1.0f, -2.0f, 1.0f}, {1.0f, 2.0f, 1.0f}, {1.02f, 2.0f, 1.01f}},
    {{0.1f, 0.2f, 0.5f}, {0.5f, 0.1f, 0.4f}, {-2.0f, 0.3f, 0.1f}},
    {{0.5f, 0.5f, 9.0f}, {0.6f, 0.5f, 9.0f}, {0.5f, 0.62f, 9.0f}},
};

/// Part (x, y) of a triangle cut into `n` squared equal ones.
Corners part_of(const Corners& t, int n, int x, int y, bool upper) {
  const auto at = [&](int i, int j) {
    return t.a + (t.b - t.a) * (static_cast<float>(i) / static_cast<float>(n)) +
           (t.c - t.a) * (static_cast<float>(j) / static_cast<float>(n));
  };
  if (upper) return {at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)};
  return {at(x, y), at(x + 1, y), at(x, y + 1)};
}

TEST(SphericalTriangle, OfAnOctantHasAnEighthOfTheSphere) {
  EXPECT_NEAR(seen_from_origin(kTriangles[0]).solid_angle, 4.0f * kPi / 8.0f, 1e-5f);
}

TEST(SphericalTriangle, IsAsLargeAsItsParts) {
  constexpr int kParts = 16;
  for (const Corners& whole : kTriangles) {
    double sum = 0.0;
    for (int y = 0; y < kParts; ++y) {
      for (int x = 0; x + y < kParts; ++x) {
        sum += seen_from_origin(part_of(whole, kParts, x, y, false)).solid_angle;
        if (x + y + 1 == kParts) continue;
        sum += seen_from_origin(part_of(whole, kParts, x, y, true)).solid_angle;
      }
    }
    EXPECT_NEAR(seen_from_origin(whole).solid_angle, sum, 1e-3 * sum);
  }
}

TEST(SphericalTriangle, PointsAreSpreadOverItsSolidAngle) {
  constexpr int kParts = 8, kSamples = 200000;
  for (const Corners& t : kTriangles) {
    std::vector<double> observed(2 * kParts * kParts), expected(2 * kParts * kParts);
    const double whole = seen_from_origin(t).solid_angle;
    for (int i = 0; i < 2 * kParts * kParts; ++i) {
      const int x = i / 2 % kParts, y = i / 2 / kParts, upper = i % 2;
      if (x + y + upper >= kParts) continue;
      const Corners part = part_of(t, kParts, x, y, upper == 1);
      expected[i] = kSamples * seen_from_origin(part).solid_angle / whole;
    }
    RandomStream random = make_random_stream(1u, 2u, 3u);
    double sum_of_inverse_pdfs = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const glm::vec2 u = next_uniform2(random);
      const TrianglePointSeen seen = draw_on_triangle(t.a, t.b - t.a, t.c - t.a, u);
      ASSERT_GT(seen.pdf, 0.0f);
      sum_of_inverse_pdfs += 1.0 / seen.pdf;
      const glm::vec3 point = seen.distance * seen.to_point;
      const glm::vec3 expected_point =
          t.a + seen.barycentrics.x * (t.b - t.a) + seen.barycentrics.y * (t.c - t.a);
      ASSERT_LT(glm::length(point - expected_point), 1e-4f * glm::length(expected_point));
      const glm::vec2 scaled = seen.barycentrics * static_cast<float>(kParts);
      const int x = std::min(static_cast<int>(scaled.x), kParts - 1);
      const int y = std::min(static_cast<int>(scaled.y), kParts - 1);
      const bool upper = scaled.x - std::floor(scaled.x) + scaled.y - std::floor(scaled.y) > 1.0f;
      observed[2 * (x + kParts * y) + (upper && x + y + 1 < kParts ? 1 : 0)] += 1.0;
    }
    EXPECT_NEAR(sum_of_inverse_pdfs / kSamples, whole, 1e-3 * whole);
    EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation)
        << "solid angle " << whole;
  }
}

TEST(SphericalTriangle, IsNotSeenFromItself) {
  const glm::vec3 edge1(1.0f, 0.0f, 0.0f), edge2(0.0f, 0.0f, 1.0f);
  for (const glm::vec3& a :
       {glm::vec3(-0.2f, 0.0f, -0.3f), glm::vec3(0.0f), glm::vec3(-0.5f, 0.0f, -0.5f)}) {
    EXPECT_EQ(draw_on_triangle(a, edge1, edge2, {0.3f, 0.6f}).pdf, 0.0f);
  }
}

}  // namespace
}  // namespace lambent::spherical_triangle_test
