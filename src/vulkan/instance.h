// SPDX-License-Identifier: Apache-2.0
// Instances, and queries of devices that are not open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vulkan/device.h"

namespace lambent::vulkan {

/// An instance that Lambent creates, destroyed with this object.
class Instance {
 public:
  /// Fails where there is no loader, no driver of Vulkan 1.2, or, with `validation`, no such layer.
  static Expected<Instance> make(bool validation);
  ~Instance();
  Instance(Instance&& other) noexcept;
  Instance& operator=(Instance&&) = delete;

  VkInstance handle() const { return instance_; }
  const Functions& fn() const { return functions_; }
  bool has_debug_utils() const { return debug_utils_; }
  std::vector<VkPhysicalDevice> devices() const;
  /// Hands the handle over to the caller.
  VkInstance release();

 private:
  Instance() = default;
  Functions functions_;
  VkInstance instance_ = VK_NULL_HANDLE;
  bool debug_utils_ = false;
};

bool has_extension(const Functions& functions, VkPhysicalDevice device, const char* name);
/// The first queue family that supports compute.
std::optional<std::uint32_t> compute_queue_family(const Functions& functions,
                                                  VkPhysicalDevice device);
/// Number of valid bits of a queue family's timestamps; 0: it has none.
std::uint32_t timestamp_bits(const Functions& functions, VkPhysicalDevice device,
                             std::uint32_t family);
/// The description of a device, including what it lacks.
DeviceDescription describe(const Functions& functions, VkPhysicalDevice device);

}  // namespace lambent::vulkan
