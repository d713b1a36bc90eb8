// SPDX-License-Identifier: Apache-2.0
// Comparison of the costs of updates.
#include <cstdio>

#include "bench/dynamics/subject.h"
#include "bench/median.h"
#include "core/stopwatch.h"

namespace lambent::dynamics {
namespace {

constexpr int kUpdatesBeforeCost = 4;
constexpr int kRepetitions = 15;

void compare_costs(const std::string& name, const std::string& label, FieldSettings settings) {
  Subject subject(name, settings);
  for (int i = 0; i < kUpdatesBeforeCost; ++i) subject.field.update(subject.world);
  bench::Median full, lights_only;
  for (int i = 0; i < kRepetitions; ++i) {
    Stopwatch watch;
    subject.field.update(subject.world);
    full.add(watch.lap());
  }
  for (int i = 0; i < kRepetitions; ++i) {
    // Brighten and dim in turn. The update after an edit traces no probe rays if the one before was
    // not an edit
    const float factor = i % 2 == 0 ? 1.5f : 1.0f / 1.5f;
    for (Light& light : subject.scene.lights) light.intensity *= factor;
    for (Material& material : subject.scene.materials) material.emission *= factor;
    subject.apply_edits();
    Stopwatch watch;
    subject.field.update(subject.world);
    lights_only.add(watch.lap());
    // Trace every probe, so that the next edit does not follow another
    subject.field.update(subject.world);
  }
  std::printf("| %s | %.2f |\n", label.c_str(), lights_only.value() / full.value());
}

}  // namespace

void measure_cost() {
  std::printf(
      "### Cost of an update in which only lights changed, against a full one (median of %d)\n",
      kRepetitions);
  std::printf("| scene | ratio |\n|---|---|\n");
  FieldSettings nine;
  nine.probe_count = glm::ivec3(9);
  nine.rays_per_probe = 256;
  compare_costs("cornell", "cornell, 9x9x9 probes, 256 rays", nine);
  compare_costs("two-rooms", "two-rooms", {});
  compare_costs("atrium", "atrium", {});
}

void measure_growth() {
  std::printf("### Cost of a frame as the world grows, house, budget 100,000 rays\n");
  std::printf("| probes | ms a frame | over the first |\n|---|---|---|\n");
  constexpr std::uint64_t kBudget = 100000;
  constexpr int kFrames = 24;
  double first = 0.0;
  for (const int probes : {4096, 16384, 65536, 262144}) {
    FieldSettings settings;
    settings.probe_budget = probes;
    Subject house("house", settings);
    // Trace every probe once, so that frames are in a steady state
    const UpdateRequest request{kBudget, 0.0, house.scene.cameras[0].world_from_view[3]};
    for (std::uint64_t rays = 0; rays < 33ull * house.field.probes(); rays += kBudget) {
      house.field.update(house.world, request);
    }
    bench::Median ms;
    for (int i = 0; i < kFrames; ++i) {
      Stopwatch watch;
      house.field.update(house.world, request);
      ms.add(watch.lap());
    }
    if (first == 0.0) first = ms.value();
    std::printf("| %d | %.1f | %.2f |\n", house.field.probes(), ms.value(), ms.value() / first);
  }
}

}  // namespace lambent::dynamics
