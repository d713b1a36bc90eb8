// SPDX-License-Identifier: Apache-2.0
// The requirements of passes on a device, and which devices meet them.
#include <algorithm>
#include <cstring>
#include <string_view>

#include "vulkan/instance.h"

namespace lambent::vulkan {
namespace {

constexpr std::uint32_t kRequiredApi = VK_API_VERSION_1_2;

// Least number of lanes in a subgroup, which matrix products use to share loads.
constexpr std::uint32_t kLeastSubgroup = 8;
// Least supported size of a workgroup.
constexpr std::uint32_t kLeastGroup = 256;

/// Calls visit(name, flag) for each feature that passes need.
template <class Features, class Visit>
void for_each_feature(Features& f, Visit visit) {
  visit("bufferDeviceAddress", f.vulkan12.bufferDeviceAddress);
  visit("scalarBlockLayout", f.vulkan12.scalarBlockLayout);
  visit("descriptorIndexing", f.vulkan12.descriptorIndexing);
  visit("runtimeDescriptorArray", f.vulkan12.runtimeDescriptorArray);
  visit("descriptorBindingPartiallyBound", f.vulkan12.descriptorBindingPartiallyBound);
  visit("shaderSampledImageArrayNonUniformIndexing",
        f.vulkan12.shaderSampledImageArrayNonUniformIndexing);
  visit("accelerationStructure", f.acceleration_structure.accelerationStructure);
  visit("rayTracingPipeline", f.ray_tracing_pipeline.rayTracingPipeline);
  visit("rayTracingPipelineTraceRaysIndirect",
        f.ray_tracing_pipeline.rayTracingPipelineTraceRaysIndirect);
}

std::vector<VkExtensionProperties> extensions_of(const Functions& f, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  f.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  f.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return extensions;
}

std::vector<VkQueueFamilyProperties> queue_families(const Functions& f, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  f.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  f.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

}  // namespace

RequiredFeatures::RequiredFeatures()
    : core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr, {}},
      vulkan12{},
      acceleration_structure{},
      ray_tracing_pipeline{} {
  vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  acceleration_structure.sType =
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
  ray_tracing_pipeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
  core.pNext = &vulkan12;
  vulkan12.pNext = &acceleration_structure;
  acceleration_structure.pNext = &ray_tracing_pipeline;
}

void RequiredFeatures::request() {
  for_each_feature(*this, [](const char*, VkBool32& flag) { flag = VK_TRUE; });
}

std::vector<std::string> RequiredFeatures::missing() const {
  std::vector<std::string> names;
  for_each_feature(*this, [&](const char* name, const VkBool32& flag) {
    if (flag == VK_FALSE) names.emplace_back(name);
  });
  return names;
}

bool has_extension(const Functions& f, VkPhysicalDevice device, const char* name) {
  const std::vector<VkExtensionProperties> extensions = extensions_of(f, device);
  return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
    return std::string_view(e.extensionName) == name;
  });
}

std::optional<std::uint32_t> compute_queue_family(const Functions& f, VkPhysicalDevice device) {
  const std::vector<VkQueueFamilyProperties> families = queue_families(f, device);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) return i;
  }
  return std::nullopt;
}

std::uint32_t timestamp_bits(const Functions& f, VkPhysicalDevice device, std::uint32_t family) {
  const std::vector<VkQueueFamilyProperties> families = queue_families(f, device);
  return family < families.size() ? families[family].timestampValidBits : 0;
}

DeviceDescription describe(const Functions& f, VkPhysicalDevice device) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceSubgroupProperties subgroups{};
  subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  driver.pNext = &subgroups;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  f.vkGetPhysicalDeviceProperties2(device, &properties);
  DeviceDescription description;
  const std::uint32_t api = properties.properties.apiVersion;
  description.name = properties.properties.deviceName;
  description.api_major = VK_API_VERSION_MAJOR(api);
  description.api_minor = VK_API_VERSION_MINOR(api);
  description.software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  // Devices of a lower version may not know the structures that are queried below
  if (api < kRequiredApi) {
    description.missing.emplace_back("Vulkan 1.2");
    return description;
  }
  description.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  for (const char* name : kRequiredExtensions) {
    if (!has_extension(f, device, name)) description.missing.emplace_back(name);
  }
  if (!compute_queue_family(f, device)) description.missing.emplace_back("a compute queue");
  if (subgroups.subgroupSize < kLeastSubgroup ||
      (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0 ||
      (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) == 0) {
    description.missing.emplace_back("subgroups of 8 that shuffle");
  }
  if (properties.properties.limits.maxComputeWorkGroupInvocations < kLeastGroup) {
    description.missing.emplace_back("workgroups of 256");
  }
  if (!description.missing.empty()) return description;
  RequiredFeatures features;
  f.vkGetPhysicalDeviceFeatures2(device, &features.core);
  description.missing = features.missing();
  return description;
}

}  // namespace lambent::vulkan
