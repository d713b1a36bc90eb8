// SPDX-License-Identifier: Apache-2.0
// The fluctuation of light from frame to frame where nothing changes.
#include <cmath>
#include <cstdio>

#include "bench/dynamics/subject.h"

namespace lambent::dynamics {
namespace {

constexpr int kRestFrames = 64;
constexpr int kRestPixels = 96;
constexpr std::uint64_t kRestBudget = 100000;  // rays per frame

/// Prints the relative standard deviation of each point's light over the frames: root mean square
/// over the points, and the largest.
void waver(const std::string& name, int updates_before, bool corrections) {
  FieldSettings settings;
  settings.corrections = corrections;
  Subject subject(name, settings);
  const UpdateRequest request{kRestBudget, 0.0, std::nullopt};
  const std::vector<FieldQuery> points = seen_points(subject, kRestPixels);
  for (int i = 0; i < updates_before; ++i) subject.field.update(subject.world);
  std::vector<double> sum(points.size(), 0.0), squares(points.size(), 0.0);
  std::uint64_t rays = 0;
  for (int i = 0; i < kRestFrames; ++i) {
    rays += subject.field.update(subject.world, request).probe_rays;
    const std::vector<double> light = light_at(subject.field, points);
    for (std::size_t p = 0; p < points.size(); ++p) {
      sum[p] += light[p];
      squares[p] += light[p] * light[p];
    }
  }
  double total = 0.0, largest = 0.0, mean_light = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) mean_light += sum[p] / kRestFrames;
  mean_light /= static_cast<double>(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double mean = sum[p] / kRestFrames;
    const double variance = std::max(squares[p] / kRestFrames - mean * mean, 0.0);
    // Fluctuations of nearly black points are not visible
    const double coefficient = std::sqrt(variance) / std::max(mean, 0.01 * mean_light);
    total += coefficient * coefficient;
    largest = std::max(largest, coefficient);
  }
  std::printf("| %s, %d | %s | %.3f %% | %.3f %% | %.0f |\n", name.c_str(), updates_before,
              corrections ? "yes" : "no",
              100.0 * std::sqrt(total / static_cast<double>(points.size())), 100.0 * largest,
              static_cast<double>(rays) / kRestFrames);
}

}  // namespace

void measure_rest() {
  std::printf("### Coefficient of variation of E over %d frames of 100,000 rays, nothing moving\n",
              kRestFrames);
  std::printf(
      "| scene, full updates before | corrections | root mean square | largest | "
      "probe rays a frame |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const bool corrections : {true, false}) {
    for (const int updates : {16, 100}) {
      waver("cornell", updates, corrections);
      waver("two-rooms", updates, corrections);
    }
    waver("atrium", 100, corrections);
  }
}

}  // namespace lambent::dynamics
