// SPDX-License-Identifier: Apache-2.0
// Helpers for buffers and dispatches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>

#include "vulkan/buffer.h"
#include "vulkan/device.h"

namespace lambent {

/// Creates a buffer in host memory from which the device reads, for data that is used once.
template <class T>
vulkan::Buffer host_buffer(const vulkan::Device& device, std::span<const T> data,
                           const std::string& name) {
  vulkan::Buffer buffer(device, data.size_bytes(), vulkan::Memory::upload, name);
  std::copy(data.begin(), data.end(), buffer.as<T>().begin());
  return buffer;
}

/// Makes a buffer hold at least `count` elements of a type. Its contents are lost if it grows.
template <class T>
void reserve(const vulkan::Device& device, std::size_t count, const std::string& name,
             vulkan::Buffer& buffer) {
  buffer.reserve(device, count * sizeof(T), name);
}

/// Sum of the sizes of buffers [bytes].
inline std::size_t bytes_of(std::initializer_list<const vulkan::Buffer*> buffers) {
  std::size_t bytes = 0;
  for (const vulkan::Buffer* buffer : buffers) bytes += buffer->bytes();
  return bytes;
}

inline int round_up(int value, int multiple) {
  return (value + multiple - 1) / multiple * multiple;
}
inline std::uint32_t groups_of(int count, int per_group) {
  return static_cast<std::uint32_t>((count + per_group - 1) / per_group);
}

}  // namespace lambent
