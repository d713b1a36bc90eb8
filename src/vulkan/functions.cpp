// SPDX-License-Identifier: Apache-2.0
#include "vulkan/functions.h"

#include <dlfcn.h>

namespace lambent::vulkan {

PFN_vkGetInstanceProcAddr find_loader() {
  static const auto entry = [] {
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) library = dlopen("libvulkan.so", RTLD_NOW | RTLD_LOCAL);
    return library == nullptr ? nullptr
                              : reinterpret_cast<PFN_vkGetInstanceProcAddr>(
                                    dlsym(library, "vkGetInstanceProcAddr"));
  }();
  return entry;
}

bool load_global_functions(Functions& f) {
  bool complete = true;
#define LAMBENT_VULKAN_LOAD(name)                                                 \
  f.name = reinterpret_cast<PFN_##name>(f.vkGetInstanceProcAddr(nullptr, #name)); \
  complete = complete && f.name != nullptr;
  LAMBENT_VULKAN_GLOBAL_FUNCTIONS(LAMBENT_VULKAN_LOAD)
#undef LAMBENT_VULKAN_LOAD
  return complete;
}

bool load_instance_functions(VkInstance instance, Functions& f) {
  bool complete = true;
#define LAMBENT_VULKAN_LOAD(name)                                                  \
  f.name = reinterpret_cast<PFN_##name>(f.vkGetInstanceProcAddr(instance, #name)); \
  complete = complete && f.name != nullptr;
  LAMBENT_VULKAN_INSTANCE_FUNCTIONS(LAMBENT_VULKAN_LOAD)
#undef LAMBENT_VULKAN_LOAD
#define LAMBENT_VULKAN_LOAD(name) \
  f.name = reinterpret_cast<PFN_##name>(f.vkGetInstanceProcAddr(instance, #name));
  LAMBENT_VULKAN_DEBUG_FUNCTIONS(LAMBENT_VULKAN_LOAD)
#undef LAMBENT_VULKAN_LOAD
  return complete;
}

bool load_device_functions(VkInstance instance, VkDevice device, Functions& f) {
  if (f.vkGetDeviceProcAddr == nullptr && !load_instance_functions(instance, f)) return false;
  bool complete = true;
#define LAMBENT_VULKAN_LOAD(name)                                              \
  f.name = reinterpret_cast<PFN_##name>(f.vkGetDeviceProcAddr(device, #name)); \
  complete = complete && f.name != nullptr;
  LAMBENT_VULKAN_DEVICE_FUNCTIONS(LAMBENT_VULKAN_LOAD)
#undef LAMBENT_VULKAN_LOAD
  return complete;
}

}  // namespace lambent::vulkan
