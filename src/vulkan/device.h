// SPDX-License-Identifier: Apache-2.0
// An instance, a device and its queue: opened by Lambent or lent by an engine. Independent of
// techniques.
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

// Must follow Vulkan's headers without prototypes
#include "lambent/vulkan_device.h"

namespace lambent::vulkan {

class Recorder;

/// Throws a std::runtime_error that names the call if `result` is an error. For calls that fail
/// only on broken or exhausted devices.
void check(VkResult result, const char* call);

/// Limits of the device to which passes adapt.
struct DeviceLimits {
  std::uint32_t shader_group_handle_bytes = 0;
  std::uint32_t shader_group_handle_alignment = 0;
  std::uint32_t shader_group_base_alignment = 0;
  std::uint32_t acceleration_scratch_alignment = 0;
  std::uint32_t max_sampled_images = 0;  ///< In one descriptor array.
  std::uint32_t max_image_extent = 0;    ///< Largest width or height of an image [texels].
  std::uint32_t max_groups = 0;      ///< Largest number of groups along the first or second axis.
  std::uint64_t timestamp_mask = 0;  ///< Mask of the valid bits.
  float timestamp_period_ns = 0.0f;  ///< 0: the queue has no timestamps.
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

  /// Lets `record` fill a command buffer, submits it and waits. Concurrent calls run one after the
  /// other.
  void run(const std::function<void(Recorder&)>& record) const;

  /// The device's only object of class T, created at the first call as T(device) and destroyed with
  /// the device: for kernels, which take long to compile, and memory that passes reuse.
  template <class T>
  T& kept() const {
    return *static_cast<T*>(
        keep(typeid(T), [this] { return std::shared_ptr<void>(std::make_shared<T>(*this)); }));
  }

  /// Sets the name of an object for debuggers, if VK_EXT_debug_utils is on.
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
  std::function<void(const char*)> keep_;  // stores a message of the validation layer
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

/// Bytes of push constants, which every device supports.
inline constexpr std::uint32_t kMaxArgumentBytes = 128;

/// Capacity of a scene's descriptor set, and the binding of its textures.
inline constexpr std::uint32_t kMaxTextures = 4096;
inline constexpr std::uint32_t kMaxSamplers = 9;
inline constexpr std::uint32_t kTextureBinding = 0;
inline constexpr std::uint32_t kSamplerBinding = 1;

}  // namespace lambent::vulkan
