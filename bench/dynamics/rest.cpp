// SPDX-License-Identifier: Apache-2.0
// How much light at rest wavers from frame to frame.
#include <cmath>
#include <cstdio>

#include "bench/dynamics/subject.h"

namespace lambent::dynamics {
namespace {

constexpr int kFrames = 64;
constexpr int kPixels = 96;

/// Standard deviation of each point's light over the frames, over its mean; root mean square over
/// the points, and the largest.
void waver(const std::string& name, const std::string& label, FieldSettings settings,
           std::uint64_t budget) {
  Subject subject(name, settings);
  const UpdateRequest request{budget, 0.0, std::nullopt};
  const std::vector<FieldQuery> points = seen_points(subject, kPixels);
  constexpr int kSettling = 128;
  for (int i = 0; i < kSettling; ++i) subject.field.update(subject.world, request);
  std::vector<double> sum(points.size(), 0.0), squares(points.size(), 0.0);
  std::uint64_t rays = 0;
  for (int i = 0; i < kFrames; ++i) {
    rays += subject.field.update(subject.world, request).probe_rays;
    const std::vector<double> light = light_at(subject.field, points);
    for (std::size_t p = 0; p < points.size(); ++p) {
      sum[p] += light[p];
      squares[p] += light[p] * light[p];
    }
  }
  double total = 0.0, largest = 0.0, mean_light = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) mean_light += sum[p] / kFrames;
  mean_light /= static_cast<double>(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double mean = sum[p] / kFrames;
    const double variance = std::max(squares[p] / kFrames - mean * mean, 0.0);
    // What is black next to the rest of the picture has no colour to waver
    const double coefficient = std::sqrt(variance) / std::max(mean, 0.01 * mean_light);
    total += coefficient * coefficient;
    largest = std::max(largest, coefficient);
  }
  std::printf("| %s | %.3f %% | %.3f %% | %.0f |\n", label.c_str(),
              100.0 * std::sqrt(total / static_cast<double>(points.size())), 100.0 * largest,
              static_cast<double>(rays) / kFrames);
}

}  // namespace

void measure_rest() {
  std::printf("### At rest: coefficient of variation of E over %d frames, after 128\n", kFrames);
  std::printf("| scene, budget | root mean square | largest | probe rays a frame |\n");
  std::printf("|---|---|---|---|\n");
  waver("cornell", "cornell, 100,000 rays", {}, 100000);
  waver("two-rooms", "two-rooms, 100,000 rays", {}, 100000);
  waver("atrium", "atrium, 100,000 rays", {}, 100000);
}

}  // namespace lambent::dynamics
