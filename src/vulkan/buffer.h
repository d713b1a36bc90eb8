// SPDX-License-Identifier: Apache-2.0
// Buffers on a device, which shaders access by address.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "vulkan/api.h"

namespace lambent::vulkan {

class Device;

/// The kind of memory that a buffer uses.
enum class Memory {
  device,    ///< Fast for the device; the host cannot see it.
  upload,    ///< Written by the host, read by the device.
  readback,  ///< Written by the device, read by the host.
};

/// A buffer and its memory. Movable; empty by default. The device must outlive it.
class Buffer {
 public:
  Buffer() = default;
  /// Throws std::runtime_error where memory runs out. `bytes` may be 0: the buffer then has a
  /// minimum size, so that its address is valid. Zeroed where the host can access it, else
  /// undefined. `alignment` of the address; a power of two.
  Buffer(const Device& device, std::size_t bytes, Memory memory, const std::string& name,
         std::size_t alignment = 16, VkBufferUsageFlags further_usage = 0);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  /// Makes it a buffer of Memory::device of at least `bytes`. Its contents are lost if it grows.
  void reserve(const Device& device, std::size_t bytes, const std::string& name);

  VkBuffer handle() const { return buffer_; }
  VkDeviceAddress address() const { return address_; }
  /// Offset in `handle()` at which the aligned address begins.
  VkDeviceSize offset() const { return offset_; }
  std::size_t bytes() const { return bytes_; }
  bool empty() const { return bytes_ == 0; }

  /// The mapped memory; null for Memory::device.
  std::byte* host() const { return host_; }
  template <class T>
  std::span<T> as() const {
    return {reinterpret_cast<T*>(host_), bytes_ / sizeof(T)};
  }

 private:
  void release();

  const Device* device_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  VkDeviceSize offset_ = 0;
  std::size_t bytes_ = 0;
  std::byte* host_ = nullptr;
};

/// Creates a device buffer with this content. Waits for the copy.
Buffer upload_bytes(const Device& device, std::span<const std::byte> data, const std::string& name,
                    VkBufferUsageFlags further_usage = 0);
/// Copies into a buffer that is large enough, from `offset` bytes on. Waits for the copy.
void write_bytes(const Device& device, std::span<const std::byte> data, const Buffer& buffer,
                 std::size_t offset = 0);
/// Copies out of a buffer, from `offset` bytes on. Waits for the copy.
void read_bytes(const Device& device, const Buffer& buffer, std::span<std::byte> data,
                std::size_t offset = 0);

template <class T>
Buffer upload(const Device& device, std::span<const T> data, const std::string& name,
              VkBufferUsageFlags further_usage = 0) {
  return upload_bytes(device, std::as_bytes(data), name, further_usage);
}
template <class T>
Buffer upload(const Device& device, const std::vector<T>& data, const std::string& name,
              VkBufferUsageFlags further_usage = 0) {
  return upload(device, std::span<const T>(data), name, further_usage);
}
template <class T>
void write(const Device& device, std::span<const T> data, const Buffer& buffer,
           std::size_t first = 0) {
  write_bytes(device, std::as_bytes(data), buffer, first * sizeof(T));
}
template <class T>
void read(const Device& device, const Buffer& buffer, std::span<T> data, std::size_t first = 0) {
  read_bytes(device, buffer, std::as_writable_bytes(data), first * sizeof(T));
}
template <class T>
std::vector<T> download(const Device& device, const Buffer& buffer) {
  std::vector<T> data(buffer.bytes() / sizeof(T));
  read(device, buffer, std::span<T>(data));
  return data;
}

}  // namespace lambent::vulkan
