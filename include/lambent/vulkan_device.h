// SPDX-License-Identifier: Apache-2.0
// A Vulkan device that an engine owns and lends to Lambent. Needs Vulkan's headers; without them,
// this file declares nothing. Devices that Lambent opens itself are in vulkan.h.
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

/// Device extensions that an engine must enable, in addition to Vulkan 1.2.
inline constexpr std::array kRequiredExtensions = {"VK_KHR_acceleration_structure",
                                                   "VK_KHR_ray_tracing_pipeline",
                                                   "VK_KHR_deferred_host_operations"};

/// The features that an engine must enable, as a chain for VkDeviceCreateInfo::pNext that begins
/// with `core`. The engine sets further features in these structs, or chains further structs to the
/// last one, whose pNext is null.
struct RequiredFeatures {
  RequiredFeatures();
  RequiredFeatures(const RequiredFeatures&) = delete;
  RequiredFeatures& operator=(const RequiredFeatures&) = delete;

  VkPhysicalDeviceFeatures2 core;
  VkPhysicalDeviceVulkan12Features vulkan12;
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration_structure;
  VkPhysicalDeviceRayTracingPipelineFeaturesKHR ray_tracing_pipeline;  ///< The last.

  /// Sets the features that Lambent needs.
  void request();
  /// Names of the needed features that these structs, as filled in by the driver, lack. Newly
  /// constructed structs lack all of them.
  std::vector<std::string> missing() const;
};

/// A device that an engine lends. It was created with kRequiredExtensions and RequiredFeatures, and
/// must outlive everything that Lambent creates on it.
struct LentDevice {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  ///< Null: the system's loader.
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  /// Supports compute. Lambent submits to it while it creates objects on the device, never while it
  /// records; nobody else may submit to it meanwhile.
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
};

/// Wraps a lent device without taking ownership. Fails where something that is needed is missing.
Expected<std::shared_ptr<Device>> adopt_device(const LentDevice& lent);

/// Part of a buffer.
struct BufferRange {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;      ///< [bytes]
  VkDeviceSize bytes = 0;       ///< [bytes]
  VkDeviceAddress address = 0;  ///< Address of its first byte.
};

}  // namespace lambent::vulkan
#endif
