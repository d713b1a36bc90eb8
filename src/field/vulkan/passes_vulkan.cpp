// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/passes_vulkan.h"

namespace lambent {

void FieldPassesVulkan::blend_distances() {
  update_.field.record_blend_distances(to_, update_.list, {update_.blend_weights.address()},
                                       update_.dither_seed);
}

void FieldPassesVulkan::lookups() {
  update_.field.record_lookups(to_, update_.list, update_.source.tracer());
}

void FieldPassesVulkan::solve() {
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
  update_.noise.record(to_, update_.list, {update_.blend_weights.address()},
                       {update_.solver.history().address()});
}

void FieldPassesVulkan::store() {
  update_.field.record_store_light(to_, update_.list, update_.dither_seed);
}

}  // namespace lambent
