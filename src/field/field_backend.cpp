// SPDX-License-Identifier: Apache-2.0
// Picks where a field lives.
#include "field/field_backend.h"

namespace lambent {

bool lives_on_device(const World& world, int probes) {
  return world.on_device() != nullptr && probes <= kMostDeviceProbes;
}

std::unique_ptr<FieldBackend> make_field_backend([[maybe_unused]] const World& world,
                                                 ProbeMemory& memory) {
#if LAMBENT_VULKAN
  if (lives_on_device(world, memory.store.probes())) {
    return make_field_backend_vulkan(world, memory);
  }
#endif
  return make_field_backend_cpu(memory);
}

}  // namespace lambent
