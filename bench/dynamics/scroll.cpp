// SPDX-License-Identifier: Apache-2.0
// Visible changes of light when cascades follow a walking viewer.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/dynamics/subject.h"

namespace lambent::dynamics {
namespace {

constexpr int kScrollPixels = 64;
constexpr int kScrollSettledUpdates = 24;
constexpr int kStandingFrames = 60;
constexpr int kScrollFrames = 200;
constexpr float kStep = 0.023f;  // [m]: 1.4 m/s at 60 Hz
constexpr std::uint64_t kScrollBudget = 100000, kSettlingBudget = 1000000;

/// Largest relative changes of E at any point in some updates.
struct Changes {
  int count = 0, probes = 0;
  double largest = 0.0, sum = 0.0;

  void add(double change, int recycled) {
    ++count;
    probes += recycled;
    largest = std::max(largest, change);
    sum += change;
  }
  void print(const std::string& scene, const char* label) const {
    const double n = std::max(count, 1);
    std::printf("| %s | %s | %d | %.0f | %.2f %% | %.2f %% |\n", scene.c_str(), label, count,
                probes / n, 100.0 * largest, 100.0 * sum / n);
  }
};

/// The light at some points, and its changes.
class Watched {
 public:
  Watched(const Subject& subject)
      : subject_(subject),
        points_(seen_points(subject, kScrollPixels)),
        light_(light_at(subject.field, points_)) {
    for (const double e : light_) mean_ += e / static_cast<double>(light_.size());
  }

  /// Largest relative change since the last call.
  double change() {
    const std::vector<double> now = light_at(subject_.field, points_);
    double largest = 0.0;
    for (std::size_t p = 0; p < now.size(); ++p) {
      largest = std::max(largest, std::abs(now[p] - light_[p]));
    }
    light_ = now;
    return largest / mean_;
  }

 private:
  const Subject& subject_;
  std::vector<FieldQuery> points_;
  std::vector<double> light_;
  double mean_ = 0.0;
};

void walk(const std::string& name, float spacing) {
  FieldSettings settings;
  settings.cascades = 4;
  settings.probe_spacing = spacing;
  Subject subject(name, settings);
  const Camera& camera = subject.scene.cameras.front();
  glm::vec3 viewer(camera.world_from_view[3]);
  glm::vec3 forward = -glm::vec3(camera.world_from_view[2]);
  forward.y = 0.0f;
  forward = glm::normalize(forward);
  const auto update = [&](std::uint64_t budget) {
    return subject.field.update(subject.world, {budget, 0.0, viewer});
  };
  for (int i = 0; i < kScrollSettledUpdates; ++i) update(0);
  for (int i = 0; i < kScrollSettledUpdates; ++i) update(kSettlingBudget);

  // In each frame the volumes move first, with a budget that suffices for no probe
  Changes scrolls, moves, traces, standing;
  Watched watched(subject);
  for (int frame = -kStandingFrames; frame < kScrollFrames; ++frame) {
    if (frame < 0) {
      update(kScrollBudget);
      standing.add(watched.change(), 0);
      continue;
    }
    viewer += kStep * forward;
    const int recycled = update(1).probes_recycled;
    (recycled > 0 ? scrolls : moves).add(watched.change(), recycled);
    update(kScrollBudget);
    traces.add(watched.change(), 0);
  }
  const std::string label = name + ", " + (spacing < 1.0f ? "0.5 m" : "1 m");
  scrolls.print(label, "a volume moving on");
  moves.print(label, "the viewer moving between these");
  traces.print(label, "tracing, on the walk");
  standing.print(label, "tracing, before it");
}

}  // namespace

void measure_scroll() {
  std::printf(
      "### A walk of %.1f m at 1.4 m/s and 60 Hz through four cascades of 32x4x32 probes, 100,000 "
      "rays a frame: change of E at any point of the picture, over its mean\n",
      kScrollFrames * kStep);
  std::printf(
      "| scene, finest spacing | by | updates | probes recycled | largest | largest of an update, "
      "on "
      "average |\n|---|---|---|---|---|---|\n");
  walk("atrium", 1.0f);
  walk("atrium", 0.5f);
  walk("house", 0.5f);
}

}  // namespace lambent::dynamics
