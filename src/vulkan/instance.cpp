// SPDX-License-Identifier: Apache-2.0
#include "vulkan/instance.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lambent::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool layer_is_installed(const Functions& f) {
  std::uint32_t count = 0;
  f.vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  f.vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::string_view(layer.layerName) == kValidationLayer;
  });
}

bool extension_is_there(const Functions& f, const char* layer, const char* name) {
  std::uint32_t count = 0;
  f.vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  f.vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
    return std::string_view(e.extensionName) == name;
  });
}

}  // namespace

Expected<Instance> Instance::make(bool validation) {
  Instance instance;
  Functions& f = instance.functions_;
  f.vkGetInstanceProcAddr = find_loader();
  if (f.vkGetInstanceProcAddr == nullptr) {
    return fail("", "Vulkan", "there is no Vulkan loader (libvulkan.so.1) on this machine",
                Error::Kind::failed);
  }
  if (!load_global_functions(f))
    return fail("", "Vulkan", "the Vulkan loader is incomplete", Error::Kind::failed);

  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pEngineName = "lambent";
  application.apiVersion = VK_API_VERSION_1_2;
  std::vector<const char*> layers, extensions;
  const char* layer = nullptr;
  if (validation) {
    if (!layer_is_installed(f)) {
      return fail("", "Vulkan", std::string(kValidationLayer) + " is not installed",
                  Error::Kind::failed);
    }
    layer = kValidationLayer;
    layers.push_back(layer);
  }
  if (extension_is_there(f, nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
      (layer != nullptr && extension_is_there(f, layer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME))) {
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    instance.debug_utils_ = true;
  }
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult made = f.vkCreateInstance(&info, nullptr, &instance.instance_);
  if (made == VK_ERROR_INCOMPATIBLE_DRIVER) {
    return fail("", "Vulkan", "there is no Vulkan driver on this machine", Error::Kind::failed);
  }
  if (made != VK_SUCCESS) {
    return fail("", "Vulkan", "an instance cannot be made (VkResult " + std::to_string(made) + ")",
                Error::Kind::failed);
  }
  if (!load_instance_functions(instance.instance_, f)) {
    return fail("", "Vulkan", "the Vulkan loader is older than Vulkan 1.2", Error::Kind::failed);
  }
  return instance;
}

Instance::Instance(Instance&& other) noexcept
    : functions_(other.functions_),
      instance_(std::exchange(other.instance_, VK_NULL_HANDLE)),
      debug_utils_(other.debug_utils_) {}

Instance::~Instance() {
  if (instance_ != VK_NULL_HANDLE) functions_.vkDestroyInstance(instance_, nullptr);
}

VkInstance Instance::release() {
  return std::exchange(instance_, VK_NULL_HANDLE);
}

std::vector<VkPhysicalDevice> Instance::devices() const {
  std::uint32_t count = 0;
  functions_.vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> found(count);
  functions_.vkEnumeratePhysicalDevices(instance_, &count, found.data());
  found.resize(count);
  return found;
}

Expected<std::vector<DeviceDescription>> devices() {
  const Expected<Instance> instance = Instance::make(/*validation=*/false);
  if (!instance) return tl::unexpected(instance.error());
  std::vector<DeviceDescription> found;
  for (const VkPhysicalDevice device : instance->devices()) {
    found.push_back(describe(instance->fn(), device));
  }
  return found;
}

}  // namespace lambent::vulkan
