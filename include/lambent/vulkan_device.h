// SPDX-License-Identifier: Apache-2.0
// A Vulkan device that an engine lends, whatever it records there. Needs Vulkan's headers; where
// there are none it declares nothing. Devices that Lambent opens itself are in vulkan.h.
#pragma once

#if __has_include(<vulkan/vulkan_core.h>)
#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/vulkan.h"

namespace lambent::vulkan {

/// Device extensions that an engine turns on, besides Vulkan 1.2.
inline constexpr std::array kRequiredExtensions = {"VK_KHR_acceleration_structure",
                                                   "VK_KHR_ray_tracing_pipeline",
                                                   "VK_KHR_deferred_host_operations"};

/// The features that an engine turns on, as a chain for VkDeviceCreateInfo::pNext that begins with
/// `core`. What the engine wants besides is set in these structs or chained behind the last, whose
/// pNext is null.
struct RequiredFeatures {
  RequiredFeatures();
  RequiredFeatures(const RequiredFeatures&) = delete;
  RequiredFeatures& operator=(const RequiredFeatures&) = delete;

  VkPhysicalDeviceFeatures2 core;
  VkPhysicalDeviceVulkan12Features vulkan12;
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration_structure;
  VkPhysicalDeviceRayTracingPipelineFeaturesKHR ray_tracing_pipeline;  ///< The last.

  /// Turns on what is needed.
  void request();
  /// Names of what is needed and these, as filled in by the driver, lack. Of fresh ones: of all
  /// that is needed.
  std::vector<std::string> missing() const;
};

/// What an engine lends. The device was made with kRequiredExtensions and RequiredFeatures, and
/// outlives all that is made on it.
struct LentDevice {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  ///< Null: the system's loader.
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  /// Takes compute. Used while something is made on the device, never while it records: nobody else
  /// may submit to it meanwhile.
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
};

/// Takes a lent device over without owning it. Fails where something that is needed is missing.
Expected<std::shared_ptr<Device>> adopt_device(const LentDevice& lent);

/// Part of a buffer.
struct BufferRange {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;      ///< [bytes]
  VkDeviceSize bytes = 0;       ///< [bytes]
  VkDeviceAddress address = 0;  ///< Of its first byte.
};

}  // namespace lambent::vulkan
#endif
