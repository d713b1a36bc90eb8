// SPDX-License-Identifier: Apache-2.0
#include "vulkan/buffer.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "vulkan/device.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {
namespace {

// An empty buffer would have no address.
constexpr std::size_t kLeastBytes = 16;
// Upload buffers up to this size are in device-local memory, if the host can write there: such
// memory may be scarce.
constexpr std::size_t kMaxNearBytes = 1 << 20;
// Fills and copies are in multiples of this [bytes].
constexpr std::size_t kWord = 4;
// Device memory that the host can see begins with these words in turn where asserts are on, so that
// what reads memory that nobody wrote shows: as floats, NaN, and -2 beside it; as indices, far out
// of range.
[[maybe_unused]] constexpr std::uint32_t kPoison[] = {0xFFFFFFFFu, 0xC0000000u};

/// The memory type for a buffer, among the allowed `types`: one with all preferred properties,
/// otherwise one with the required ones.
std::uint32_t memory_type(const Device& device, std::uint32_t types, Memory memory,
                          std::size_t bytes) {
  VkMemoryPropertyFlags needed = 0, wished = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (memory != Memory::device) {
    needed = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    wished = needed;
    if (memory == Memory::readback) wished |= VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    // Prefer device-local memory for small buffers, which kernels read repeatedly
    if (memory == Memory::upload && bytes <= kMaxNearBytes) {
      wished |= VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    }
  }
  for (const VkMemoryPropertyFlags flags : {wished, needed}) {
    for (std::uint32_t i = 0; i < device.memory().memoryTypeCount; ++i) {
      const VkMemoryPropertyFlags has = device.memory().memoryTypes[i].propertyFlags;
      if ((types & (1u << i)) != 0 && (has & flags) == flags) return i;
    }
  }
  throw std::runtime_error("the Vulkan device has no memory for buffers of this kind");
}

[[maybe_unused]] void poison(std::byte* memory, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += sizeof(kPoison)) {
    std::memcpy(memory + at, kPoison, std::min(sizeof(kPoison), bytes - at));
  }
}

}  // namespace

Buffer::Buffer(const Device& device, std::size_t bytes, Memory memory, const std::string& name,
               std::size_t alignment, VkBufferUsageFlags further_usage)
    : device_(&device), bytes_(bytes) {
  const Functions& f = device.fn();
  const std::size_t rounded = (std::max(bytes, kLeastBytes) + kWord - 1) / kWord * kWord;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = rounded + alignment;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | further_usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  try {
    check(f.vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    f.vkGetBufferMemoryRequirements(device.handle(), buffer_, &needs);
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.pNext = &flags;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = memory_type(device, needs.memoryTypeBits, memory, bytes);
    check(f.vkAllocateMemory(device.handle(), &allocation, nullptr, &memory_), "vkAllocateMemory");
    check(f.vkBindBufferMemory(device.handle(), buffer_, memory_, 0), "vkBindBufferMemory");
    VkBufferDeviceAddressInfo where{};
    where.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    where.buffer = buffer_;
    const VkDeviceAddress start = f.vkGetBufferDeviceAddress(device.handle(), &where);
    address_ = (start + alignment - 1) / alignment * alignment;
    offset_ = address_ - start;
    const auto map = [&] {
      void* mapped = nullptr;
      check(f.vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
      return static_cast<std::byte*>(mapped) + offset_;
    };
    if (memory != Memory::device) {
      host_ = map();
      std::memset(host_, 0, bytes_);
    }
#ifndef NDEBUG
    const VkMemoryPropertyFlags properties =
        device.memory().memoryTypes[allocation.memoryTypeIndex].propertyFlags;
    if (memory == Memory::device && (properties & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0) {
      poison(map(), bytes_);
      f.vkUnmapMemory(device.handle(), memory_);
    }
#endif
  } catch (...) {
    release();
    throw;
  }
  device.name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer_), name);
}

void Buffer::release() {
  if (device_ == nullptr) return;
  const Functions& f = device_->fn();
  f.vkDestroyBuffer(device_->handle(), buffer_, nullptr);
  f.vkFreeMemory(device_->handle(), memory_, nullptr);
  device_ = nullptr;
}

Buffer::~Buffer() {
  release();
}

void Buffer::reserve(const Device& device, std::size_t bytes, const std::string& name) {
  if (buffer_ != VK_NULL_HANDLE && bytes_ >= bytes) return;
  *this = Buffer(device, bytes, Memory::device, name);
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
  std::swap(address_, other.address_);
  std::swap(offset_, other.offset_);
  std::swap(bytes_, other.bytes_);
  std::swap(host_, other.host_);
  return *this;
}

Buffer upload_bytes(const Device& device, std::span<const std::byte> data, const std::string& name,
                    VkBufferUsageFlags further_usage) {
  constexpr std::size_t kAlignment = 16;
  Buffer buffer(device, data.size(), Memory::device, name, kAlignment, further_usage);
  write_bytes(device, data, buffer);
  return buffer;
}

void write_bytes(const Device& device, std::span<const std::byte> data, const Buffer& buffer,
                 std::size_t offset) {
  assert(offset + data.size() <= buffer.bytes());
  if (data.empty()) return;
  if (buffer.host() != nullptr) {
    std::memcpy(buffer.host() + offset, data.data(), data.size());
    return;
  }
  const Buffer staging(device, data.size(), Memory::upload, "upload");
  std::memcpy(staging.host(), data.data(), data.size());
  device.run([&](Recorder& to) { to.copy(staging, buffer, data.size(), 0, offset); });
}

void read_bytes(const Device& device, const Buffer& buffer, std::span<std::byte> data,
                std::size_t offset) {
  assert(offset + data.size() <= buffer.bytes());
  if (data.empty()) return;
  if (buffer.host() != nullptr) {
    std::memcpy(data.data(), buffer.host() + offset, data.size());
    return;
  }
  const Buffer staging(device, data.size(), Memory::readback, "readback");
  device.run([&](Recorder& to) { to.copy(buffer, staging, data.size(), offset, 0); });
  std::memcpy(data.data(), staging.host(), data.size());
}

}  // namespace lambent::vulkan
