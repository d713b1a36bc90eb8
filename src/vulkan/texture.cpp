// SPDX-License-Identifier: Apache-2.0
#include "vulkan/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "vulkan/device.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {
namespace {

std::uint32_t memory_type(const Device& device, std::uint32_t types) {
  const VkPhysicalDeviceMemoryProperties& memory = device.memory();
  constexpr VkMemoryPropertyFlags kWishes[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  for (const VkMemoryPropertyFlags wished : kWishes) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      const bool fits = (memory.memoryTypes[i].propertyFlags & wished) == wished;
      if ((types & (1u << i)) != 0 && fits) return i;
    }
  }
  throw std::runtime_error("the Vulkan device has no memory for textures");
}

VkImageSubresourceRange all_levels(std::size_t levels) {
  return {VK_IMAGE_ASPECT_COLOR_BIT, 0, static_cast<std::uint32_t>(levels), 0, 1};
}

}  // namespace

Texture::Texture(const Device& device, std::span<const TexelLevel> levels, bool srgb,
                 const std::string& name)
    : device_(&device) {
  assert(!levels.empty());
  const std::uint32_t extent = std::max(levels[0].width, levels[0].height);
  if (extent > device.limits().max_image_extent) {
    throw std::runtime_error("the Vulkan device takes no texture of " + std::to_string(extent) +
                             " texels");
  }
  const VkFormat format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {levels[0].width, levels[0].height, 1};
  info.mipLevels = static_cast<std::uint32_t>(levels.size());
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  try {
    allocate(info);
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = all_levels(levels.size());
    check(device.fn().vkCreateImageView(device.handle(), &view, nullptr, &view_),
          "vkCreateImageView");
    copy(levels);
  } catch (...) {
    release();
    throw;
  }
  device.name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image_), name);
}

void Texture::allocate(const VkImageCreateInfo& info) {
  const Functions& f = device_->fn();
  check(f.vkCreateImage(device_->handle(), &info, nullptr, &image_), "vkCreateImage");
  VkMemoryRequirements needs{};
  f.vkGetImageMemoryRequirements(device_->handle(), image_, &needs);
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.allocationSize = needs.size;
  allocation.memoryTypeIndex = memory_type(*device_, needs.memoryTypeBits);
  check(f.vkAllocateMemory(device_->handle(), &allocation, nullptr, &memory_), "vkAllocateMemory");
  check(f.vkBindImageMemory(device_->handle(), image_, memory_, 0), "vkBindImageMemory");
  bytes_ = needs.size;
}

void Texture::copy(std::span<const TexelLevel> levels) const {
  // Copy the levels to memory that the host can access
  std::size_t bytes = 0;
  for (const TexelLevel& level : levels) bytes += level.rgba.size();
  const Buffer staging(*device_, bytes, Memory::upload, "texture upload");
  std::vector<VkBufferImageCopy> regions;
  std::size_t offset = 0;
  for (const TexelLevel& level : levels) {
    assert(level.rgba.size() == std::size_t{4} * level.width * level.height);
    std::memcpy(staging.host() + offset, level.rgba.data(), level.rgba.size());
    VkBufferImageCopy region{};
    region.bufferOffset = staging.offset() + offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT,
                               static_cast<std::uint32_t>(regions.size()), 0, 1};
    region.imageExtent = {level.width, level.height, 1};
    regions.push_back(region);
    offset += level.rgba.size();
  }

  device_->run([&](Recorder& to) {
    const auto turn = [&](VkImageLayout from, VkImageLayout into, VkAccessFlags after,
                          VkAccessFlags before) {
      VkImageMemoryBarrier barrier{};
      barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
      barrier.srcAccessMask = after;
      barrier.dstAccessMask = before;
      barrier.oldLayout = from;
      barrier.newLayout = into;
      barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.image = image_;
      barrier.subresourceRange = all_levels(levels.size());
      device_->fn().vkCmdPipelineBarrier(to.commands(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                                         nullptr, 1, &barrier);
    };
    turn(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0,
         VK_ACCESS_TRANSFER_WRITE_BIT);
    device_->fn().vkCmdCopyBufferToImage(
        to.commands(), staging.handle(), image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        static_cast<std::uint32_t>(regions.size()), regions.data());
    turn(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
         VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT);
  });
}

void Texture::release() {
  if (device_ == nullptr) return;
  const Functions& f = device_->fn();
  f.vkDestroyImageView(device_->handle(), view_, nullptr);
  f.vkDestroyImage(device_->handle(), image_, nullptr);
  f.vkFreeMemory(device_->handle(), memory_, nullptr);
  device_ = nullptr;
}

Texture::~Texture() {
  release();
}

Texture::Texture(Texture&& other) noexcept {
  *this = std::move(other);
}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(image_, other.image_);
  std::swap(memory_, other.memory_);
  std::swap(view_, other.view_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

TextureSet::TextureSet(const Device& device) : device_(device) {
  const Functions& f = device.fn();
  try {
    const std::array<VkDescriptorPoolSize, 2> sizes = {
        {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, device.limits().max_sampled_images},
         {VK_DESCRIPTOR_TYPE_SAMPLER, kMaxSamplers}}};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    check(f.vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_),
          "vkCreateDescriptorPool");
    const VkDescriptorSetLayout layout = device.texture_set_layout();
    VkDescriptorSetAllocateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set.descriptorPool = pool_;
    set.descriptorSetCount = 1;
    set.pSetLayouts = &layout;
    check(f.vkAllocateDescriptorSets(device.handle(), &set, &set_), "vkAllocateDescriptorSets");
    make_samplers();
  } catch (...) {
    release();
    throw;
  }
}

void TextureSet::make_samplers() {
  static_assert(kMaxSamplers == kAddressModes * kAddressModes);
  std::vector<VkDescriptorImageInfo> images;
  for (std::uint32_t pair = 0; pair < kAddressModes * kAddressModes; ++pair) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = kAddressMode[pair % kAddressModes];
    info.addressModeV = kAddressMode[pair / kAddressModes];
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler sampler = VK_NULL_HANDLE;
    check(device_.fn().vkCreateSampler(device_.handle(), &info, nullptr, &sampler),
          "vkCreateSampler");
    samplers_.push_back(sampler);
    images.push_back({sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
  }
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = set_;
  write.dstBinding = kSamplerBinding;
  write.descriptorCount = static_cast<std::uint32_t>(images.size());
  write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLER;
  write.pImageInfo = images.data();
  device_.fn().vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
}

void TextureSet::release() {
  const Functions& f = device_.fn();
  for (const VkSampler sampler : samplers_) f.vkDestroySampler(device_.handle(), sampler, nullptr);
  f.vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
}

TextureSet::~TextureSet() {
  release();
}

void TextureSet::set(std::uint32_t index, const Texture& texture) {
  if (index >= device_.limits().max_sampled_images) {
    throw std::runtime_error("the Vulkan device takes no more than " +
                             std::to_string(device_.limits().max_sampled_images) + " textures");
  }
  const VkDescriptorImageInfo image = {VK_NULL_HANDLE, texture.view(),
                                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = set_;
  write.dstBinding = kTextureBinding;
  write.dstArrayElement = index;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  write.pImageInfo = &image;
  device_.fn().vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
}

}  // namespace lambent::vulkan
