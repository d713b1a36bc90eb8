// SPDX-License-Identifier: Apache-2.0
// Whether an edit touches the probes that it changes, and no others.
#include <cstdio>

#include "bench/dynamics/subject.h"
#include "field/field_access.h"
#include "field/probes/probe_store.h"

namespace lambent::dynamics {
namespace {

constexpr int kUpdatesBeforeHouse = 12;
// The reference: fields that differ only in the lamp, and share all random numbers, so that their
// difference is the lamp's light and not noise.
constexpr int kTruthUpdates = 4;
constexpr int kTruthRays = 256;
// Relative change of a probe's mean light from which it counts as changed.
constexpr double kChange = 0.01;

/// Mean of each probe's irradiance over its tile and the channels.
std::vector<double> probe_light(const IrradianceField& field) {
  const ProbeStore& store = store_of(field);
  const int edge = store.irradiance_texels();
  std::vector<double> light(store.probes());
  for (int probe = 0; probe < store.probes(); ++probe) {
    for (int t = 0; t < edge * edge; ++t) {
      const vec3 e = store.irradiance_texel(probe, ivec2(t % edge, t / edge) + 1);
      light[probe] += (e.x + e.y + e.z) / (3.0 * edge * edge);
    }
  }
  return light;
}

std::vector<double> true_light(const Subject& house) {
  FieldSettings settings = house.field.settings();
  settings.rays_per_probe = kTruthRays;
  settings.hysteresis = 0.999f;
  settings.solve_tolerance = 1e-5f;
  settings.max_solve_iterations = 200;
  const World world(house.scene);
  IrradianceField field = house.fresh_field(settings);
  for (int i = 0; i < kTruthUpdates; ++i) field.update(world);
  return probe_light(field);
}

}  // namespace

void measure_house() {
  std::printf(
      "### Edit of one lamp in a house of 16 rooms: probes touched against probes that change by > "
      "1 %%\n");
  std::printf("| edit | probes | change in truth | touched | recall | precision |\n");
  std::printf("|---|---|---|---|---|---|\n");
  struct Edit {
    const char* label;
    int lamp;
    float factor;
  };
  for (const Edit& edit :
       {Edit{"corner room's lamp dimmed to a half", 0, 0.5f},
        Edit{"inner room's lamp off", 5, 0.0f}, Edit{"inner room's lamp 10 % brighter", 5, 1.1f}}) {
    FieldSettings settings;
    settings.irradiance_format = IrradianceFormat::float32;
    Subject house("house", settings);
    for (int i = 0; i < kUpdatesBeforeHouse; ++i) house.field.update(house.world);
    const std::vector<double> true_before = true_light(house);
    const std::vector<double> before = probe_light(house.field);
    house.scene.lights[edit.lamp].intensity *= edit.factor;
    house.apply_edits();
    house.field.update(house.world);
    // A budget of one ray suffices for no probe, but stale probes in open air, which cost nothing,
    // are still updated
    while (house.field.update(house.world, {.ray_budget = 1}).probes_invalidated > 0) continue;
    const std::vector<double> after = probe_light(house.field);
    const std::vector<double> true_after = true_light(house);
    int changed = 0, touched = 0, both = 0;
    for (std::size_t p = 0; p < before.size(); ++p) {
      const double step = true_after[p] - true_before[p];
      const bool changes = std::abs(step) > kChange * true_before[p];
      const bool is_touched = after[p] != before[p];
      changed += changes ? 1 : 0;
      touched += is_touched ? 1 : 0;
      both += changes && is_touched ? 1 : 0;
    }
    std::printf("| %s | %zu | %d | %d | %.1f %% | %.1f %% |\n", edit.label, before.size(), changed,
                touched, 100.0 * both / changed, 100.0 * both / touched);
  }
}

}  // namespace lambent::dynamics
