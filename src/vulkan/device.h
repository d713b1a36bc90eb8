// SPDX-License-Identifier: Apache-2.0
// An instance, a device and its queue: opened by us or lent by an engine. Knows no technique.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <unordered_map>
#include <vector>

#include "lambent/vulkan.h"
#include "vulkan/functions.h"

// After Vulkan's headers without prototypes
#include "lambent/vulkan_device.h"

namespace lambent::vulkan {

class Recorder;

/// Throws std::runtime_error that names the call, where a call that only a broken or exhausted
/// device fails did fail.
void check(VkResult result, const char* call);

/// Numbers that passes adapt to.
struct DeviceLimits {
  std::uint32_t shader_group_handle_bytes = 0;
  std::uint32_t shader_group_handle_alignment = 0;
  std::uint32_t shader_group_base_alignment = 0;
  std::uint32_t acceleration_scratch_alignment = 0;
  std::uint32_t max_sampled_images = 0;  ///< In one descriptor array.
  std::uint32_t max_image_extent = 0;    ///< Texels an image is wide or high.
  std::uint32_t max_groups = 0;          ///< Of a dispatch, along its first or second axis.
  std::uint64_t timestamp_mask = 0;      ///< Of the bits that count.
  float timestamp_period_ns = 0.0f;      ///< 0: the queue has no timestamps.
};

class Device : public std::enable_shared_from_this<Device> {
 public:
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const Functions& fn() const { return functions_; }
  VkDevice handle() const { return device_; }
  VkPhysicalDevice physical_device() const { return physical_device_; }
  const DeviceLimits& limits() const { return limits_; }
  const DeviceDescription& description() const { return description_; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
  bool has_debug_names() const { return functions_.vkSetDebugUtilsObjectNameEXT != nullptr; }

  /// The layout of all pipelines: the descriptors of a scene's textures, and push constants of
  /// kMaxArgumentBytes.
  VkPipelineLayout pipeline_layout() const { return pipeline_layout_; }
  VkDescriptorSetLayout texture_set_layout() const { return texture_set_layout_; }

  /// Has `record` fill a command buffer, submits it and waits. One at a time; others wait.
  void run(const std::function<void(Recorder&)>& record) const;

  /// The one object of this class that lives with the device, made at the first call as T(device):
  /// for kernels, which take long to compile, and memory that passes use again.
  template <class T>
  T& kept() const {
    return *static_cast<T*>(
        keep(typeid(T), [this] { return std::shared_ptr<void>(std::make_shared<T>(*this)); }));
  }

  /// Gives an object its name for debuggers, where they listen.
  void name(VkObjectType type, std::uint64_t object, const std::string& name) const;

  std::vector<std::string> messages() const;

 private:
  friend Expected<std::shared_ptr<Device>> open_device(const DeviceRequest&);
  friend Expected<std::shared_ptr<Device>> adopt_device(const LentDevice&);
  struct Messages;
  Device();
  void* keep(std::type_index type, const std::function<std::shared_ptr<void>()>& make) const;
  void listen(VkInstance instance);
  void finish(std::uint32_t queue_family);
  void make_pipeline_layout();

  Functions functions_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  bool owned_ = false;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::unique_ptr<Messages> messages_;
  std::function<void(const char*)> keep_;  // a message of the validation layer
  DeviceDescription description_;
  DeviceLimits limits_;
  VkPhysicalDeviceMemoryProperties memory_{};
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout texture_set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout pipeline_layout_ = VK_NULL_HANDLE;
  mutable std::mutex running_;
  mutable std::mutex keeping_;
  mutable std::unordered_map<std::type_index, std::shared_ptr<void>> kept_;
};

/// Push constants a pipeline can take: what every device has.
inline constexpr std::uint32_t kMaxArgumentBytes = 128;

/// Textures and samplers that a scene's descriptor set can hold, and where they are bound.
inline constexpr std::uint32_t kMaxTextures = 4096;
inline constexpr std::uint32_t kMaxSamplers = 9;
inline constexpr std::uint32_t kTextureBinding = 0;
inline constexpr std::uint32_t kSamplerBinding = 1;

}  // namespace lambent::vulkan
