// SPDX-License-Identifier: Apache-2.0
// The error of light for a budget of rays.
#include <array>
#include <cstdio>
#include <limits>

#include "bench/dynamics/subject.h"

namespace lambent::dynamics {
namespace {

constexpr int kBudgetPixels = 64;
// Width of the picture for UpdateRequest::seen, whose points are not the measured ones.
constexpr int kSeenPixels = 37;
constexpr int kReferenceSamples = 1024;

// Errors to reach, and the limits of updates, and of rays relative to the uniform schedule, after
// which a schedule has failed.
constexpr std::array kTargets = {0.08, 0.04, 0.03};
constexpr int kMaxUpdateCount = 400;
constexpr std::uint64_t kMaxTimes = 2;
constexpr std::uint64_t kAdaptiveBudget = 100000;  // rays per frame

/// Settings of fields of which the probes' light alone is compared. Two fields' corrections differ
/// by more than the rays of a schedule do, since each learns them from gathers of its own.
FieldSettings probes_alone() {
  FieldSettings settings;
  settings.corrections = false;
  return settings;
}

/// Number of rays of all kinds in a full update.
std::uint64_t full_rays(Subject& subject) {
  const UpdateStatistics statistics = subject.field.update(subject.world);
  return statistics.probe_rays + statistics.shadow_rays;
}

glm::vec3 viewer_of(const Subject& subject) {
  return subject.scene.cameras.front().world_from_view[3];
}

void print_curve(const std::string& name) {
  Subject subject(name, {});
  std::uint64_t full = 0;
  for (int i = 0; i < 16; ++i) full = full_rays(subject);
  for (Light& light : subject.scene.lights) light.intensity *= 3.0f;
  subject.apply_edits();
  const std::vector<FieldQuery> points = seen_points(subject, kBudgetPixels);
  const std::vector<double> truth =
      reference_light_at(World(subject.scene), points, kReferenceSamples);
  const std::vector<FieldQuery> seen = seen_points(subject, kSeenPixels);
  const UpdateRequest request{full / 4, 0.0, viewer_of(subject), seen};
  for (int frame = 0; frame <= 12; ++frame) {
    UpdateStatistics statistics;
    if (frame > 0) statistics = subject.field.update(subject.world, request);
    const Difference difference = compare(light_at(subject.field, points), truth);
    std::printf("| %s | %d | %llu | %.4f | %.4f |\n", name.c_str(), frame,
                static_cast<unsigned long long>(statistics.probe_rays + statistics.shadow_rays),
                difference.mean_ratio, difference.relative_rmse);
  }
}

/// The error relative to the settled field after a number of probe rays.
struct Mark {
  std::uint64_t rays;
  double error;
};

/// Updates a fresh field until the error is at most `target`, or a number of rays is spent.
std::vector<Mark> follow_error(Subject& subject, const UpdateRequest& request,
                               std::span<const FieldQuery> points, std::span<const double> settled,
                               double target, std::uint64_t most_rays) {
  IrradianceField field = subject.fresh_field(subject.field.settings());
  std::vector<Mark> marks;
  std::uint64_t rays = 0;
  for (int i = 0; i < kMaxUpdateCount && rays < most_rays; ++i) {
    rays += field.update(subject.world, request).probe_rays;
    marks.push_back({rays, compare(light_at(field, points), settled).relative_rmse});
    if (marks.back().error <= target) break;
  }
  return marks;
}

/// Rays after which the error stayed at or below `target`; 0: never.
std::uint64_t rays_to(std::span<const Mark> marks, double target) {
  for (const Mark& mark : marks) {
    if (mark.error <= target) return mark.rays;
  }
  return 0;
}

void compare_adaptive(const std::string& name) {
  Subject subject(name, probes_alone());
  const std::vector<FieldQuery> points = seen_points(subject, kBudgetPixels);
  const std::vector<double> settled = light_at(subject.settled_field(), points);
  const std::vector<FieldQuery> seen = seen_points(subject, kSeenPixels);
  const double hardest = kTargets.back();
  const std::vector<Mark> uniform = follow_error(subject, {}, points, settled, hardest,
                                                 std::numeric_limits<std::uint64_t>::max());
  const std::vector<Mark> adaptive =
      follow_error(subject, {kAdaptiveBudget, 0.0, viewer_of(subject), seen}, points, settled,
                   hardest, kMaxTimes * uniform.back().rays);
  for (const double target : kTargets) {
    const auto first = static_cast<double>(rays_to(uniform, target));
    const auto second = static_cast<double>(rays_to(adaptive, target));
    std::printf("| %s | %.2f |", name.c_str(), target);
    for (const double rays : {first, second}) {
      rays > 0.0 ? std::printf(" %.2f |", rays * 1e-6) : std::printf(" not reached |");
    }
    first > 0.0 && second > 0.0 ? std::printf(" %.2f |\n", first / second) : std::printf(" |\n");
  }
}

}  // namespace

void measure_curve() {
  std::printf(
      "### Light step (three times as bright) at a quarter of the full budget: E against the "
      "reference\n");
  std::printf("| scene | frame | rays | mean ratio | relative RMSE |\n|---|---|---|---|---|\n");
  print_curve("two-rooms");
  print_curve("atrium");
}

void measure_adaptive() {
  std::printf(
      "### Probe rays to equal error from darkness [millions], adaptive (100,000 a frame) against "
      "uniform, no corrections\n");
  std::printf("| scene | relative RMSE | uniform | adaptive | ratio |\n|---|---|---|---|---|\n");
  compare_adaptive("two-rooms");
  compare_adaptive("atrium");
}

void measure_moving() {
  std::printf(
      "### One moving object, atrium: rays of the schedule against those of full updates, no "
      "corrections\n");
  std::printf(
      "| updates | probe + shadow rays a frame | relative RMSE of E against the settled |\n");
  std::printf("|---|---|---|\n");
  constexpr int kFrames = 32;
  std::vector<double> settled;
  std::uint64_t full = 0;
  for (const double share : {1.0, 0.5, 0.25}) {
    Subject atrium("atrium", probes_alone());
    for (int i = 0; i < 16; ++i) atrium.field.update(atrium.world);
    const std::vector<FieldQuery> seen = seen_points(atrium, kSeenPixels);
    UpdateRequest request;
    if (full != 0) {
      request.ray_budget = static_cast<std::uint64_t>(share * static_cast<double>(full));
      request.viewer_ws = viewer_of(atrium);
      request.seen = seen;
    }
    std::uint64_t probe_rays = 0, shadow_rays = 0;
    for (int i = 0; i < kFrames; ++i) {
      atrium.move("", {0.03f, 0.0f, 0.0f});
      atrium.apply_edits();
      const UpdateStatistics statistics = atrium.field.update(atrium.world, request);
      probe_rays += statistics.probe_rays / kFrames;
      shadow_rays += statistics.shadow_rays / kFrames;
    }
    const bool first = full == 0;
    if (first) full = probe_rays + shadow_rays;
    const std::vector<FieldQuery> points = seen_points(atrium, kBudgetPixels);
    if (first) settled = light_at(atrium.settled_field(), points);
    const Difference difference = compare(light_at(atrium.field, points), settled);
    const std::string label =
        first ? "all probes, 144 rays"
              : "schedule, " + std::to_string(static_cast<int>(100.0 * share)) + " % of the rays";
    std::printf("| %s | %llu + %llu | %.4f |\n", label.c_str(),
                static_cast<unsigned long long>(probe_rays),
                static_cast<unsigned long long>(shadow_rays), difference.relative_rmse);
  }
}

}  // namespace lambent::dynamics
