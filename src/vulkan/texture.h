// SPDX-License-Identifier: Apache-2.0
// Textures with MIP levels, and the descriptor set of all textures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vulkan/api.h"

namespace lambent::vulkan {

class Device;

/// One MIP level: 8-bit RGBA, rows from the top.
struct TexelLevel {
  std::uint32_t width, height;
  std::span<const std::uint8_t> rgba;
};

/// An 8-bit RGBA image that shaders read, and its memory. Movable; empty by default. The device
/// must outlive it.
class Texture {
 public:
  Texture() = default;
  /// Full size first, each level half of the one before, at least one; waits for the copy. `srgb`:
  /// colours are decoded when they are read. Throws std::runtime_error where memory runs out or the
  /// image is too large for the device.
  Texture(const Device& device, std::span<const TexelLevel> levels, bool srgb,
          const std::string& name);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  VkImageView view() const { return view_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void allocate(const VkImageCreateInfo& info);
  void copy(std::span<const TexelLevel> levels) const;
  void release();

  const Device* device_ = nullptr;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  std::size_t bytes_ = 0;
};

/// The address modes beyond a texture's edges.
inline constexpr std::uint32_t kAddressModes = 3;
inline constexpr VkSamplerAddressMode kAddressMode[kAddressModes] = {
    VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};

/// The descriptors of Device::texture_set_layout: an array of textures, and a bilinear sampler for
/// each pair of address modes (that of u + 3 * that of v).
class TextureSet {
 public:
  /// The device must outlive it.
  explicit TextureSet(const Device& device);
  ~TextureSet();
  TextureSet(const TextureSet&) = delete;
  TextureSet& operator=(const TextureSet&) = delete;

  /// Binds a texture at an index; it must live as long as kernels may read it there. Not to be
  /// called while the device uses the set. Throws std::runtime_error where the device supports no
  /// more textures.
  void set(std::uint32_t index, const Texture& texture);

  VkDescriptorSet handle() const { return set_; }

 private:
  void make_samplers();
  void release();

  const Device& device_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  std::vector<VkSampler> samplers_;
};

}  // namespace lambent::vulkan
