// SPDX-License-Identifier: Apache-2.0
// Chooses the backend of a field.
#include "field/field_backend.h"
#include "raytracing/world_access.h"

namespace lambent {

bool lives_on_device(const World& world, int probes) {
  return device_world_of(world) != nullptr && probes <= kMaxBackendProbes;
}

std::unique_ptr<FieldBackend> make_field_backend([[maybe_unused]] const World& world,
                                                 ProbeData& data) {
#if LAMBENT_VULKAN
  if (lives_on_device(world, data.store.probes())) {
    return make_field_backend_vulkan(world, data);
  }
#endif
  return make_field_backend_cpu(data);
}

}  // namespace lambent
