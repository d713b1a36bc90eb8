// SPDX-License-Identifier: Apache-2.0
// The part of an update that runs on a device, and the transfer of a field to a device and back.
#include <numeric>
#include <utility>

#include "core/stopwatch.h"
#include "field/field_state.h"
#include "lambent/world.h"

namespace lambent {

void IrradianceField::State::move_to(const World& world, UpdateStatistics& statistics) {
  const bool on_device = world.on_device() != nullptr && store.probes() <= kMaxBackendProbes;
  if (on_device && device && device->is_on(world)) return;
  if (!on_device && !device) return;
  fetch_light();
  fetch_store();
  device.reset();
  // Surfels are not transferred. Probes that had some are traced again; averages of an older
  // revision of the world cannot be corrected without surfels and start again
  for (std::size_t probe = 0; probe < traces.size(); ++probe) {
    if (traces[probe].rays == nullptr) continue;
    traces[probe] = {};
    if (statuses[probe].revision != world.revision()) statuses[probe].samples = 0.0f;
    statuses[probe].revision = world.revision();
  }
  scheduler.mark_all_changed();
  pending_edits = {};
  stale_sleeping.clear();
  if (on_device) device = make_field_backend(world, settings, store);
  if (device) {
    device->write_store(store);
    device->write_light(light, last_irradiance_estimate);
  }
  // Before the first update no probe has been placed yet
  if (updates == 0) return;
  std::vector<int> all(statuses.size());
  std::iota(all.begin(), all.end(), 0);
  statistics.shadow_rays += update_cell_visibility(world, all);
}

void IrradianceField::State::fetch_light() {
  if (!host_light_is_stale) return;
  device->read_light(light, last_irradiance_estimate);
  host_light_is_stale = false;
}

void IrradianceField::State::fetch_store() const {
  if (!host_store_is_stale) return;
  device->read_store(store);
  host_store_is_stale = false;
}

void IrradianceField::State::trace_on_device(const World& world, std::span<const TraceGroup> groups,
                                             UpdateStatistics& statistics) {
  Stopwatch watch;
  const TracedProbes traced = blend_weights_of(groups);
  statistics.shadow_rays += update_cell_visibility(world, traced.probes);
  statistics.shade_ms += watch.lap();
  if (!host_light_is_stale) device->write_light(light, last_irradiance_estimate);
  const DeviceTraced found = device->trace({world, groups, traced.blend_weights, solve_settings(),
                                            settings.max_bounces, darkest(), dither_seed()});
  host_light_is_stale = host_store_is_stale = true;
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) {
      traces[probe].rays = group.rays;
      last_estimate_is_coarse[probe] = 1;
    }
  }
  statistics.probe_rays += found.probe_rays;
  statistics.shadow_rays += found.shadow_rays;
  statistics.solve_iterations += found.solve.iterations;
  statistics.residual = found.solve.error;
  statistics.change = found.solve.change;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  statistics.trace_ms += found.trace_ms;
  statistics.shade_ms += found.shade_ms;
  statistics.solve_ms += found.solve_ms;
  statistics.blend_ms += found.blend_ms;
  update_variability(world, traced, found.changes);
}

}  // namespace lambent
