// SPDX-License-Identifier: Apache-2.0
// The Vulkan functions that Lambent uses, loaded at run time.
#pragma once

#include "vulkan/api.h"

namespace lambent::vulkan {

#define LAMBENT_VULKAN_GLOBAL_FUNCTIONS(X)  \
  X(vkCreateInstance)                       \
  X(vkEnumerateInstanceExtensionProperties) \
  X(vkEnumerateInstanceLayerProperties)

#define LAMBENT_VULKAN_INSTANCE_FUNCTIONS(X)  \
  X(vkDestroyInstance)                        \
  X(vkEnumeratePhysicalDevices)               \
  X(vkEnumerateDeviceExtensionProperties)     \
  X(vkGetPhysicalDeviceFeatures2)             \
  X(vkGetPhysicalDeviceMemoryProperties)      \
  X(vkGetPhysicalDeviceProperties2)           \
  X(vkGetPhysicalDeviceQueueFamilyProperties) \
  X(vkCreateDevice)                           \
  X(vkGetDeviceProcAddr)

#define LAMBENT_VULKAN_DEVICE_FUNCTIONS(X)         \
  X(vkAllocateCommandBuffers)                      \
  X(vkAllocateDescriptorSets)                      \
  X(vkAllocateMemory)                              \
  X(vkBeginCommandBuffer)                          \
  X(vkBindBufferMemory)                            \
  X(vkBindImageMemory)                             \
  X(vkCmdBindDescriptorSets)                       \
  X(vkCmdBindPipeline)                             \
  X(vkCmdBuildAccelerationStructuresKHR)           \
  X(vkCmdCopyAccelerationStructureKHR)             \
  X(vkCmdCopyBuffer)                               \
  X(vkCmdCopyBufferToImage)                        \
  X(vkCmdDispatch)                                 \
  X(vkCmdDispatchIndirect)                         \
  X(vkCmdFillBuffer)                               \
  X(vkCmdPipelineBarrier)                          \
  X(vkCmdPushConstants)                            \
  X(vkCmdResetQueryPool)                           \
  X(vkCmdTraceRaysIndirectKHR)                     \
  X(vkCmdTraceRaysKHR)                             \
  X(vkCmdUpdateBuffer)                             \
  X(vkCmdWriteAccelerationStructuresPropertiesKHR) \
  X(vkCmdWriteTimestamp)                           \
  X(vkCreateAccelerationStructureKHR)              \
  X(vkCreateBuffer)                                \
  X(vkCreateCommandPool)                           \
  X(vkCreateComputePipelines)                      \
  X(vkCreateDescriptorPool)                        \
  X(vkCreateDescriptorSetLayout)                   \
  X(vkCreateFence)                                 \
  X(vkCreateImage)                                 \
  X(vkCreateImageView)                             \
  X(vkCreatePipelineLayout)                        \
  X(vkCreateQueryPool)                             \
  X(vkCreateRayTracingPipelinesKHR)                \
  X(vkCreateSampler)                               \
  X(vkCreateShaderModule)                          \
  X(vkDestroyAccelerationStructureKHR)             \
  X(vkDestroyBuffer)                               \
  X(vkDestroyCommandPool)                          \
  X(vkDestroyDescriptorPool)                       \
  X(vkDestroyDescriptorSetLayout)                  \
  X(vkDestroyDevice)                               \
  X(vkDestroyFence)                                \
  X(vkDestroyImage)                                \
  X(vkDestroyImageView)                            \
  X(vkDestroyPipeline)                             \
  X(vkDestroyPipelineLayout)                       \
  X(vkDestroyQueryPool)                            \
  X(vkDestroySampler)                              \
  X(vkDestroyShaderModule)                         \
  X(vkEndCommandBuffer)                            \
  X(vkFreeCommandBuffers)                          \
  X(vkFreeMemory)                                  \
  X(vkGetAccelerationStructureBuildSizesKHR)       \
  X(vkGetAccelerationStructureDeviceAddressKHR)    \
  X(vkGetBufferDeviceAddress)                      \
  X(vkGetBufferMemoryRequirements)                 \
  X(vkGetDeviceQueue)                              \
  X(vkGetImageMemoryRequirements)                  \
  X(vkGetQueryPoolResults)                         \
  X(vkGetRayTracingShaderGroupHandlesKHR)          \
  X(vkMapMemory)                                   \
  X(vkUnmapMemory)                                 \
  X(vkQueueSubmit)                                 \
  X(vkResetFences)                                 \
  X(vkUpdateDescriptorSets)                        \
  X(vkWaitForFences)

// Functions of VK_EXT_debug_utils; null where it is not on.
#define LAMBENT_VULKAN_DEBUG_FUNCTIONS(X) \
  X(vkCmdBeginDebugUtilsLabelEXT)         \
  X(vkCmdEndDebugUtilsLabelEXT)           \
  X(vkCreateDebugUtilsMessengerEXT)       \
  X(vkDestroyDebugUtilsMessengerEXT)      \
  X(vkSetDebugUtilsObjectNameEXT)

struct Functions {
  PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
#define LAMBENT_VULKAN_MEMBER(name) PFN_##name name = nullptr;
  LAMBENT_VULKAN_GLOBAL_FUNCTIONS(LAMBENT_VULKAN_MEMBER)
  LAMBENT_VULKAN_INSTANCE_FUNCTIONS(LAMBENT_VULKAN_MEMBER)
  LAMBENT_VULKAN_DEVICE_FUNCTIONS(LAMBENT_VULKAN_MEMBER)
  LAMBENT_VULKAN_DEBUG_FUNCTIONS(LAMBENT_VULKAN_MEMBER)
#undef LAMBENT_VULKAN_MEMBER
};

/// The entry point of the system's Vulkan loader; null where there is none. It is never unloaded,
/// since drivers do not support that.
PFN_vkGetInstanceProcAddr find_loader();

/// Load the functions that are available without an instance, with one, and with a device. Return
/// false where a required one is missing.
bool load_global_functions(Functions& functions);
bool load_instance_functions(VkInstance instance, Functions& functions);
bool load_device_functions(VkInstance instance, VkDevice device, Functions& functions);

}  // namespace lambent::vulkan
