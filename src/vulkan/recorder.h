// SPDX-License-Identifier: Apache-2.0
// Records passes into a command buffer, of Lambent's or of an engine's.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/kernel.h"

namespace lambent::vulkan {

/// Time of a pass on the device.
struct DevicePassTime {
  std::string name;
  double ms = 0.0;
};

/// Timestamps around the passes of one command buffer.
class Timestamps {
 public:
  /// `passes` is the maximum number of passes.
  Timestamps(const Device& device, std::uint32_t passes);
  ~Timestamps();
  Timestamps(const Timestamps&) = delete;
  Timestamps& operator=(const Timestamps&) = delete;

  /// The time of each pass, in the order of recording; those of the same name are summed. The
  /// command buffer must have finished. None where the device has no timestamps.
  std::vector<DevicePassTime> read() const;
  /// The times as of read(); none if the command buffer has not finished.
  std::vector<DevicePassTime> read_if_finished() const;

 private:
  friend class Recorder;
  std::vector<DevicePassTime> read(VkQueryResultFlags flags) const;

  const Device* device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::uint32_t capacity_ = 0;
  std::vector<std::string> names_;
};

class Recorder {
 public:
  /// Records into a command buffer that is being recorded. `timestamps` are null or unused ones,
  /// which must outlive the command buffer's execution.
  Recorder(const Device& device, VkCommandBuffer commands, Timestamps* timestamps = nullptr);

  /// Begin and end a pass, which gets a debug label and is timed.
  void begin_pass(const std::string& name);
  void end_pass();

  /// Runs a kernel over a grid of x * y * z invocations; further ones in the last groups must do
  /// nothing. The textures are those bound last.
  template <class Arguments>
  void run(const Kernel& kernel, const Arguments& arguments, std::uint32_t x, std::uint32_t y = 1,
           std::uint32_t z = 1) {
    static_assert(sizeof(Arguments) <= kMaxArgumentBytes);
    dispatch(kernel, &arguments, sizeof(Arguments), x, y, z);
  }
  /// Runs a kernel over a number of groups that the device wrote to `groups`: three words.
  template <class Arguments>
  void run_indirect(const Kernel& kernel, const Arguments& arguments, const Buffer& groups,
                    std::size_t offset = 0) {
    static_assert(sizeof(Arguments) <= kMaxArgumentBytes);
    dispatch_indirect(kernel, &arguments, sizeof(Arguments), groups, offset);
  }
  /// Runs a ray generation shader at least `count` times, in rows; invocations beyond must do
  /// nothing.
  template <class Arguments>
  void trace(const RayKernel& kernel, const Arguments& arguments, std::uint32_t count) {
    static_assert(sizeof(Arguments) <= kMaxArgumentBytes);
    trace_rays(kernel, &arguments, sizeof(Arguments), count);
  }
  /// Runs a ray generation shader for a width, height and depth that the device wrote to `size`.
  template <class Arguments>
  void trace_indirect(const RayKernel& kernel, const Arguments& arguments, const Buffer& size,
                      std::size_t offset = 0) {
    static_assert(sizeof(Arguments) <= kMaxArgumentBytes);
    trace_rays_indirect(kernel, &arguments, sizeof(Arguments), size, offset);
  }

  /// Makes all earlier writes visible to everything recorded later.
  void barrier();

  /// Binds the textures of the kernels that follow.
  void bind_textures(VkDescriptorSet textures);

  void copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t from_offset = 0,
            std::size_t to_offset = 0);
  /// `bytes` and `offset` multiples of 4; 0 bytes: to the end.
  void fill(const Buffer& buffer, std::uint32_t word, std::size_t offset = 0,
            std::size_t bytes = 0);
  /// At most 65536 bytes, copied into the command buffer itself.
  void update(const Buffer& buffer, const void* data, std::size_t bytes, std::size_t offset = 0);

  VkCommandBuffer commands() const { return commands_; }
  const Device& device() const { return device_; }

 private:
  void dispatch(const Kernel& kernel, const void* arguments, std::uint32_t bytes, std::uint32_t x,
                std::uint32_t y, std::uint32_t z);
  void dispatch_indirect(const Kernel& kernel, const void* arguments, std::uint32_t bytes,
                         const Buffer& groups, std::size_t offset);
  void trace_rays(const RayKernel& kernel, const void* arguments, std::uint32_t bytes,
                  std::uint32_t count);
  void trace_rays_indirect(const RayKernel& kernel, const void* arguments, std::uint32_t bytes,
                           const Buffer& size, std::size_t offset);
  void bind_compute(const Kernel& kernel, const void* arguments, std::uint32_t bytes);
  void bind_rays(const RayKernel& kernel, const void* arguments, std::uint32_t bytes);

  const Device& device_;
  VkCommandBuffer commands_;
  Timestamps* timestamps_;
  bool timing_ = false;  // whether the open pass is timed
};

}  // namespace lambent::vulkan
