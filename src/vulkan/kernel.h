// SPDX-License-Identifier: Apache-2.0
// Pipelines from SPIR-V. Arguments are one struct, shared between C++ and GLSL, of at most
// kMaxArgumentBytes: addresses of buffers and a few numbers.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vulkan/buffer.h"

namespace lambent::vulkan {

/// A compiled shader, embedded in the library.
using Spirv = std::span<const std::uint32_t>;

/// The value of a specialisation constant.
struct Constant {
  std::uint32_t id;
  std::uint32_t value;
};

/// A compute pipeline.
class Kernel {
 public:
  Kernel() = default;
  /// Throws std::runtime_error where the driver refuses the shader.
  Kernel(const Device& device, Spirv spirv, const std::string& name,
         std::span<const Constant> constants = {});
  ~Kernel();
  Kernel(Kernel&& other) noexcept;
  Kernel& operator=(Kernel&& other) noexcept;

  VkPipeline handle() const { return pipeline_; }
  std::uint32_t argument_bytes() const { return argument_bytes_; }
  std::uint32_t group_size(int axis) const { return group_size_[axis]; }
  const std::string& name() const { return name_; }

 private:
  const Device* device_ = nullptr;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  std::uint32_t argument_bytes_ = 0;
  std::uint32_t group_size_[3] = {1, 1, 1};
  std::string name_;
};

/// The shaders of a ray tracing pipeline: one ray generation shader, one miss shader, and one hit
/// group. Closest and any hit may be empty.
struct RayShaders {
  Spirv generation, miss, closest_hit, any_hit;
  /// All instances use the hit group, whatever shader binding table offset they have.
  bool any_record = false;
};

/// A ray tracing pipeline and its shader binding table.
class RayKernel {
 public:
  RayKernel() = default;
  RayKernel(const Device& device, const RayShaders& shaders, const std::string& name);
  ~RayKernel();
  RayKernel(RayKernel&& other) noexcept;
  RayKernel& operator=(RayKernel&& other) noexcept;

  VkPipeline handle() const { return pipeline_; }
  std::uint32_t argument_bytes() const { return argument_bytes_; }
  const std::string& name() const { return name_; }
  const VkStridedDeviceAddressRegionKHR& generation() const { return regions_[0]; }
  const VkStridedDeviceAddressRegionKHR& miss() const { return regions_[1]; }
  const VkStridedDeviceAddressRegionKHR& hit() const { return regions_[2]; }

 private:
  const Device* device_ = nullptr;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  Buffer table_;
  VkStridedDeviceAddressRegionKHR regions_[3] = {};
  std::uint32_t argument_bytes_ = 0;
  std::string name_;
};

}  // namespace lambent::vulkan
