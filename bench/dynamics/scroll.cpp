// SPDX-License-Identifier: Apache-2.0
// What is seen of cascades that follow a walking viewer.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/dynamics/subject.h"
#include "core/stopwatch.h"

namespace lambent::dynamics {
namespace {

constexpr int kPixels = 64;
constexpr int kSettledUpdates = 32;
constexpr int kFrames = 200;
constexpr float kStep = 0.023f;  // [m]: 1.4 m/s at 60 Hz
constexpr std::uint64_t kBudget = 100000;

/// Largest change of E between frames that scrolled, or did not, and what these cost.
struct Frames {
  int count = 0, probes = 0;
  double largest = 0.0, sum = 0.0, ms = 0.0;

  void add(double change, int recycled, double cost_ms) {
    ++count;
    probes += recycled;
    largest = std::max(largest, change);
    sum += change;
    ms += cost_ms;
  }
  void print(const char* scene, const char* label) const {
    std::printf("| %s | %s | %d | %.0f | %.2f %% | %.2f %% | %.1f |\n", scene, label, count,
                count > 0 ? static_cast<double>(probes) / count : 0.0, 100.0 * largest,
                count > 0 ? 100.0 * sum / count : 0.0, count > 0 ? ms / count : 0.0);
  }
};

void walk(const char* name, float spacing) {
  FieldSettings settings;
  settings.cascades = 4;
  settings.probe_spacing = spacing;
  Subject subject(name, settings);
  const Camera& camera = subject.scene.cameras.front();
  const std::vector<FieldQuery> points = seen_points(subject, kPixels);
  glm::vec3 viewer(camera.world_from_view[3]);
  glm::vec3 forward = -glm::vec3(camera.world_from_view[2]);
  forward.y = 0.0f;
  forward = glm::normalize(forward);
  for (int i = 0; i < kSettledUpdates; ++i) subject.field.update(subject.world, {0, 0.0, viewer});

  Frames scrolled, others;
  std::vector<double> before = light_at(subject.field, points);
  double mean = 0.0;
  for (const double e : before) mean += e / static_cast<double>(before.size());
  for (int frame = 0; frame < kFrames; ++frame) {
    viewer += kStep * forward;
    Stopwatch watch;
    const int recycled =
        subject.field.update(subject.world, {kBudget, 0.0, viewer}).probes_recycled;
    const double cost_ms = watch.lap();
    const std::vector<double> after = light_at(subject.field, points);
    double largest = 0.0;
    for (std::size_t p = 0; p < after.size(); ++p) {
      largest = std::max(largest, std::abs(after[p] - before[p]));
    }
    (recycled > 0 ? scrolled : others).add(largest / mean, recycled, cost_ms);
    before = after;
  }
  scrolled.print(name, "scrolls");
  others.print(name, "others");
}

}  // namespace

void measure_scroll() {
  std::printf(
      "### A walk of %.1f m at 1.4 m/s and 60 Hz through four cascades of 32x4x32 probes, 100,000 "
      "rays a frame: change of E at a point of the picture from frame to frame, over its mean\n",
      kFrames * kStep);
  std::printf(
      "| scene, finest spacing | frames | count | probes recycled | largest | largest of a frame, "
      "on average | ms |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  walk("atrium", 1.0f);
  walk("atrium", 0.5f);
  walk("house", 0.5f);
}

}  // namespace lambent::dynamics
