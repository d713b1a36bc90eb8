// SPDX-License-Identifier: Apache-2.0
// The part of an update that runs on a device, and what it takes to come there and back.
#include <numeric>
#include <utility>

#include "core/stopwatch.h"
#include "field/field_state.h"
#include "lambent/world.h"

namespace lambent {

void IrradianceField::State::move_to(const World& world, UpdateStatistics& statistics) {
  const bool on_device = world.on_device() != nullptr && store.probes() <= kMostDeviceProbes;
  if (on_device && device && device->is_on(world)) return;
  if (!on_device && !device) return;
  fetch_light();
  fetch_store();
  device.reset();
  // Surfels stay behind: probes that have been traced are traced anew, and what they averaged of
  // another world than this cannot be corrected
  for (std::size_t probe = 0; probe < traces.size(); ++probe) {
    if (traces[probe].rays == nullptr) continue;
    traces[probe] = {};
    if (records[probe].revision != world.revision()) records[probe].samples = 0.0f;
    records[probe].revision = world.revision();
  }
  agenda.changed_all();
  edits = {};
  late_sleepers.clear();
  if (on_device) device = make_field_device(world, settings, store);
  if (device) {
    device->write_store(store);
    device->write_light(light, told);
  }
  // Nothing has been placed before the first update
  if (updates == 0) return;
  std::vector<int> all(records.size());
  std::iota(all.begin(), all.end(), 0);
  statistics.shadow_rays += look_across_cells(world, all);
}

void IrradianceField::State::fetch_light() {
  if (!light_behind) return;
  device->read_light(light, told);
  light_behind = false;
}

void IrradianceField::State::fetch_store() const {
  if (!store_behind) return;
  device->read_store(store);
  store_behind = false;
}

void IrradianceField::State::trace_on_device(const World& world, std::span<const TraceGroup> groups,
                                             UpdateStatistics& statistics) {
  Stopwatch watch;
  const TracedProbes traced = shares_of(groups);
  statistics.shadow_rays += look_across_cells(world, traced.probes);
  statistics.shade_ms += watch.lap();
  if (!light_behind) device->write_light(light, told);
  const DeviceTraced found = device->trace(
      {world, groups, traced.shares, relight_settings(), settings.max_bounces, darkest(), salt()});
  light_behind = store_behind = true;
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) {
      traces[probe].rays = group.rays;
      told_roughly[probe] = 1;
    }
  }
  statistics.probe_rays += found.probe_rays;
  statistics.shadow_rays += found.shadow_rays;
  statistics.relights += found.solve.iterations;
  statistics.residual = found.solve.error;
  statistics.change = found.solve.change;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  statistics.trace_ms += found.trace_ms;
  statistics.shade_ms += found.shade_ms;
  statistics.relight_ms += found.relight_ms;
  statistics.blend_ms += found.blend_ms;
  book(world, traced, found.changes);
}

}  // namespace lambent
