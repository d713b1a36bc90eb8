// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/passes_vulkan.h"

namespace lambent {

void FieldPassesVulkan::blend_distances() {
  update_.field.record_blend_distances(to_, update_.list, {update_.shares.address()}, update_.salt);
}

void FieldPassesVulkan::lookups() {
  update_.field.record_lookups(to_, update_.list, update_.source.tracer());
}

void FieldPassesVulkan::solve() {
  DeviceSolver& solver = update_.solver;
  if (settings().max_bounces >= 0) {
    solver.record_bounces(to_, update_.list, update_.shares, settings().max_bounces);
  } else {
    solver.record(to_, update_.list, update_.shares, update_.largest_share, {},
                  relight_settings(settings()));
  }
  update_.field.record_told(to_, update_.list, {solver.solution().address()});
}

void FieldPassesVulkan::variability() {
  update_.noise.record(to_, update_.list, {update_.shares.address()},
                       {update_.solver.history().address()});
}

void FieldPassesVulkan::store() {
  update_.field.record_store_light(to_, update_.list, update_.salt);
}

}  // namespace lambent
