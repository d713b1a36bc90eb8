// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/passes_vulkan.h"

namespace lambent {

void FieldPassesVulkan::keep_history() {
  if (update_.history != nullptr) {
    update_.history->record_before(to_, update_.list);
  } else {
    update_.field.record_rays_before(to_, update_.list);
  }
}

void FieldPassesVulkan::move_distances() {
  update_.field.record_move_distances(to_, update_.list, update_.dither_seed);
}

void FieldPassesVulkan::blend_distances() {
  update_.field.record_blend_distances(to_, update_.list, {update_.blend_weights.address()},
                                       update_.dither_seed);
}

void FieldPassesVulkan::lookups() {
  const DeviceProbes& readers = update_.readers != nullptr ? *update_.readers : update_.list;
  update_.field.record_lookups(to_, readers, update_.source.tracer());
}

void FieldPassesVulkan::solve() {
  if (update_.history != nullptr) {
    update_.history->record_solve(to_, update_.list, update_.blend_weights);
    return;
  }
  DeviceSolver& solver = update_.solver;
  if (settings().max_bounces >= 0) {
    solver.record_bounces(to_, update_.list, update_.blend_weights, settings().max_bounces);
  } else {
    solver.record(to_, update_.list, update_.blend_weights, update_.largest_blend_weight, {},
                  solve_settings(settings()));
  }
  update_.field.record_last_estimates(to_, update_.list, {solver.solution().address()});
}

void FieldPassesVulkan::variability() {
  if (update_.history != nullptr) {
    update_.history->record_keep(to_, update_.list);
    return;
  }
  update_.variability.record(to_, update_.list, {update_.blend_weights.address()},
                             {update_.solver.history().address()});
}

void FieldPassesVulkan::store() {
  const UintArray changed = update_.history != nullptr ? update_.history->changed() : UintArray{};
  update_.field.record_store_light(to_, update_.list, update_.dither_seed, changed);
}

}  // namespace lambent
