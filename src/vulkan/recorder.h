// SPDX-License-Identifier: Apache-2.0
// Records passes into a command buffer: ours, or an engine's.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <vector>

#include "vulkan/buffer.h"
#include "vulkan/kernel.h"

namespace lambent::vulkan {

/// Time that a pass took on the device.
struct DevicePassTime {
  std::string name;
  double ms = 0.0;
};

/// Timestamps around the passes of one command buffer.
class Timestamps {
 public:
  /// For so many passes.
  Timestamps(const Device& device, std::uint32_t passes);
  ~Timestamps();
  Timestamps(const Timestamps&) = delete;
  Timestamps& operator=(const Timestamps&) = delete;

  /// After the command buffer has finished: what each pass took, in the order of recording; passes
  /// of one name are added up. None where the device has no timestamps.
  std::vector<DevicePassTime> read() const;
  /// The same without waiting; none where the command buffer has not finished.
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
  /// Into a command buffer that is being recorded. `timestamps`: null or empty ones, which must
  /// outlive the command buffer's execution.
  Recorder(const Device& device, VkCommandBuffer commands, Timestamps* timestamps = nullptr);

  /// Begins and ends a pass: its name is its debug label, and its time is taken.
  void begin_pass(const std::string& name);
  void end_pass();

  /// Runs a kernel over a grid of so many invocations; those beyond in the last groups must do
  /// nothing. Textures as last bound.
  template <class Arguments>
  void run(const Kernel& kernel, const Arguments& arguments, std::uint32_t x, std::uint32_t y = 1,
           std::uint32_t z = 1) {
    static_assert(sizeof(Arguments) <= 128);
    dispatch(kernel, &arguments, sizeof(Arguments), x, y, z);
  }
  /// The same over a number of groups that the device wrote: three words.
  template <class Arguments>
  void run_indirect(const Kernel& kernel, const Arguments& arguments, const Buffer& groups,
                    std::size_t offset = 0) {
    static_assert(sizeof(Arguments) <= 128);
    dispatch_indirect(kernel, &arguments, sizeof(Arguments), groups, offset);
  }
  /// Runs a ray generation shader so many times or more, in rows; those beyond must do nothing.
  template <class Arguments>
  void trace(const RayKernel& kernel, const Arguments& arguments, std::uint32_t count) {
    static_assert(sizeof(Arguments) <= 128);
    trace_rays(kernel, &arguments, sizeof(Arguments), count);
  }
  /// The same for a width, height and depth that the device wrote.
  template <class Arguments>
  void trace_indirect(const RayKernel& kernel, const Arguments& arguments, const Buffer& size,
                      std::size_t offset = 0) {
    static_assert(sizeof(Arguments) <= 128);
    trace_rays_indirect(kernel, &arguments, sizeof(Arguments), size, offset);
  }

  /// Has everything recorded later see what was written before.
  void barrier();

  /// Textures for the kernels that follow.
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
  bool timing_ = false;  // the pass that is open
};

}  // namespace lambent::vulkan
