// SPDX-License-Identifier: Apache-2.0
#include "core/cross_bilateral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shared/cross_bilateral.h"
#include "shared/random.h"

namespace lambent {
namespace {

constexpr int kWidth = 256;

/// A row of pixels a centimetre apart, seen from 1 m.
struct Row {
  explicit Row(int width) : layout(width, 1) {
    for (std::vector<float>* plane :
         {&x, &y, &z, &nx, &ny, &nz, &inverse_depth, &r, &g, &b, &out_r, &out_g, &out_b}) {
      plane->assign(layout.size, 0.0f);
    }
    for (int i = 0; i < width; ++i) {
      const std::size_t at = layout.row(0) + i;
      x[at] = 0.01f * static_cast<float>(i);
      nz[at] = 1.0f;
      inverse_depth[at] = 1.0f;
    }
  }
  BlurSource source(int step, float weight) {
    const std::size_t at = layout.row(0) + static_cast<std::size_t>(step);
    BlurSource s;
    s.guide.position.at = {&x[at], &y[at], &z[at]};
    s.guide.normal.at = {&nx[at], &ny[at], &nz[at]};
    s.guide.inverse_depth = &inverse_depth[at];
    s.value.at = {&r[at], &g[at], &b[at]};
    s.weight = weight;
    return s;
  }
  void blur(const std::vector<BlurTap>& taps, float tolerance) {
    std::vector<BlurSource> neighbours;
    for (const BlurTap& tap : taps) {
      neighbours.push_back(source(-tap.distance, tap.weight));
      neighbours.push_back(source(tap.distance, tap.weight));
    }
    const std::size_t at = layout.row(0);
    Planes3 out;
    out.at = {&out_r[at], &out_g[at], &out_b[at]};
    cross_bilateral_row(source(0, 1.0f), neighbours, out, layout.width, tolerance);
  }
  PlaneLayout layout;
  std::vector<float> x, y, z, nx, ny, nz, inverse_depth, r, g, b, out_r, out_g, out_b;
};

TEST(CrossBilateral, KeepsAStepAtADepthEdge) {
  Row row(kWidth);
  const std::size_t first = row.layout.row(0);
  for (int i = 0; i < kWidth; ++i) {
    row.z[first + i] = i < kWidth / 2 ? 0.0f : -0.5f;
    row.r[first + i] = i < kWidth / 2 ? 1.0f : 5.0f;
  }
  row.blur(box_taps(4), 0.02f);
  for (int i = 0; i < kWidth; ++i) EXPECT_FLOAT_EQ(row.out_r[first + i], row.r[first + i]) << i;
}

TEST(CrossBilateral, KeepsAStepAtACrease) {
  Row row(kWidth);
  const std::size_t first = row.layout.row(0);
  for (int i = kWidth / 2; i < kWidth; ++i) {
    row.nz[first + i] = 0.0f;
    row.nx[first + i] = -1.0f;
  }
  for (int i = 0; i < kWidth; ++i) row.g[first + i] = i < kWidth / 2 ? 1.0f : 5.0f;
  row.blur(box_taps(4), 0.5f);
  for (int i = 0; i < kWidth; ++i) EXPECT_FLOAT_EQ(row.out_g[first + i], row.g[first + i]) << i;
}

TEST(CrossBilateral, FlattensNoiseByTheNumberOfItsTaps) {
  // The mean of k independent values has 1 / k of their variance
  Row row(4096);
  const std::size_t first = row.layout.row(0);
  RandomStream random = make_random_stream(1, 2, 3);
  for (int i = 0; i < 4096; ++i) row.b[first + i] = next_uniform(random);
  for (const int radius : {1, 2, 4}) {
    row.blur(box_taps(radius), 0.5f);
    double sum = 0.0, square = 0.0;
    const int count = 4096 - 2 * radius;
    for (int i = radius; i < 4096 - radius; ++i) {
      const double value = row.out_b[first + i];
      sum += value;
      square += value * value;
    }
    const double variance = square / count - sum * sum / count / count;
    const double predicted = 1.0 / 12.0 / (2 * radius + 1);
    EXPECT_NEAR(variance / predicted, 1.0, 0.15) << radius;  // 3 sigma of 4096 correlated samples
  }
}

TEST(CrossBilateral, AveragesAPatternOfItsPeriodAway) {
  for (const int period : {2, 3, 4, 5, 8}) {
    Row row(kWidth);
    const std::size_t first = row.layout.row(0);
    for (int i = 0; i < kWidth; ++i) row.r[first + i] = static_cast<float>(i % period);
    row.blur(period_taps(period), 0.5f);
    const float mean = 0.5f * static_cast<float>(period - 1);
    for (int i = period; i < kWidth - period; ++i) {
      EXPECT_NEAR(row.out_r[first + i], mean, 1e-5f) << period << " at " << i;
    }
  }
}

TEST(CrossBilateral, TakesNothingFromPixelsThatSeeNothing) {
  Row row(kWidth);
  const std::size_t first = row.layout.row(0);
  for (int i = 0; i < kWidth; ++i) row.r[first + i] = i % 2 == 0 ? 1.0f : 1000.0f;
  for (int i = 1; i < kWidth; i += 2) row.nz[first + i] = 0.0f;
  row.blur(box_taps(3), 0.5f);
  for (int i = 0; i < kWidth; i += 2) EXPECT_FLOAT_EQ(row.out_r[first + i], 1.0f);
}

TEST(CrossBilateral, WeighsLanesAsTheSharedFunctionDoes) {
  Row row(kWidth);
  const std::size_t first = row.layout.row(0);
  RandomStream random = make_random_stream(5, 6, 7);
  for (int i = 0; i < kWidth; ++i) {
    const vec3 n = normalize(vec3(next_uniform2(random) * 0.6f - 0.3f, 1.0f));
    row.nx[first + i] = n.x;
    row.ny[first + i] = n.y;
    row.nz[first + i] = n.z;
    row.z[first + i] = 0.02f * next_uniform(random);
    row.r[first + i] = next_uniform(random);
  }
  constexpr float kTolerance = 0.03f;
  row.blur({{2, 0.7f}}, kTolerance);
  const auto at = [&](int i) {
    const std::size_t k = first + i;
    return std::pair(vec3(row.x[k], row.y[k], row.z[k]), vec3(row.nx[k], row.ny[k], row.nz[k]));
  };
  for (int i = 2; i + 2 < kWidth; ++i) {
    float sum = row.r[first + i], weights = 1.0f;
    for (const int j : {i - 2, i + 2}) {
      const float weight = 0.7f * relit_bilateral_weight(at(i).first - at(j).first, at(i).second,
                                                         at(j).second, 1.0f / kTolerance);
      sum += weight * row.r[first + j];
      weights += weight;
    }
    EXPECT_NEAR(row.out_r[first + i], sum / weights, 1e-5f);
  }
}

}  // namespace
}  // namespace lambent
