// SPDX-License-Identifier: Apache-2.0
#include "vulkan/recorder.h"

#include <algorithm>

#include "vulkan/device.h"

namespace lambent::vulkan {
namespace {

constexpr double kMsPerNs = 1e-6;

// Rays in a row of a launch, which all devices support.
constexpr std::uint32_t kLaunchWidth = 1u << 20;

/// Whether the size of a struct matches what a shader reads; C++ may pad its end.
[[maybe_unused]] bool fits(std::uint32_t bytes, std::uint32_t read_by_shader) {
  return bytes >= read_by_shader && bytes - read_by_shader < alignof(std::uint64_t);
}

std::uint32_t groups(std::uint32_t invocations, std::uint32_t group_size) {
  return (invocations + group_size - 1) / group_size;
}

}  // namespace

Timestamps::Timestamps(const Device& device, std::uint32_t passes)
    : device_(&device), capacity_(passes) {
  if (device.limits().timestamp_period_ns == 0.0f) return;
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * passes;
  check(device.fn().vkCreateQueryPool(device.handle(), &info, nullptr, &pool_),
        "vkCreateQueryPool");
}

Timestamps::~Timestamps() {
  device_->fn().vkDestroyQueryPool(device_->handle(), pool_, nullptr);
}

std::vector<DevicePassTime> Timestamps::read() const {
  return read(VK_QUERY_RESULT_WAIT_BIT);
}

std::vector<DevicePassTime> Timestamps::read_if_finished() const {
  return read(0);
}

std::vector<DevicePassTime> Timestamps::read(VkQueryResultFlags flags) const {
  std::vector<DevicePassTime> times;
  if (pool_ == VK_NULL_HANDLE || names_.empty()) return times;
  std::vector<std::uint64_t> ticks(2 * names_.size());
  const VkResult result = device_->fn().vkGetQueryPoolResults(
      device_->handle(), pool_, 0, static_cast<std::uint32_t>(ticks.size()),
      ticks.size() * sizeof(ticks[0]), ticks.data(), sizeof(ticks[0]),
      VK_QUERY_RESULT_64_BIT | flags);
  if (result == VK_NOT_READY) return times;
  check(result, "vkGetQueryPoolResults");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::uint64_t passed =
        (ticks[2 * i + 1] - ticks[2 * i]) & device_->limits().timestamp_mask;
    const double ms =
        static_cast<double>(passed) * device_->limits().timestamp_period_ns * kMsPerNs;
    const auto known = std::find_if(times.begin(), times.end(), [&](const DevicePassTime& time) {
      return time.name == names_[i];
    });
    if (known == times.end()) {
      times.push_back({names_[i], ms});
    } else {
      known->ms += ms;
    }
  }
  return times;
}

Recorder::Recorder(const Device& device, VkCommandBuffer commands, Timestamps* timestamps)
    : device_(device), commands_(commands), timestamps_(timestamps) {
  if (timestamps_ == nullptr || timestamps_->pool_ == VK_NULL_HANDLE) return;
  timestamps_->names_.clear();
  device_.fn().vkCmdResetQueryPool(commands_, timestamps_->pool_, 0, 2 * timestamps_->capacity_);
}

void Recorder::begin_pass(const std::string& name) {
  if (device_.fn().vkCmdBeginDebugUtilsLabelEXT != nullptr) {
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = name.c_str();
    device_.fn().vkCmdBeginDebugUtilsLabelEXT(commands_, &label);
  }
  if (timestamps_ == nullptr || timestamps_->pool_ == VK_NULL_HANDLE) return;
  assert(timestamps_->names_.size() < timestamps_->capacity_);
  timing_ = timestamps_->names_.size() < timestamps_->capacity_;
  if (!timing_) return;
  device_.fn().vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                                   timestamps_->pool_,
                                   static_cast<std::uint32_t>(2 * timestamps_->names_.size()));
  timestamps_->names_.push_back(name);
}

void Recorder::end_pass() {
  if (timing_) {
    timing_ = false;
    device_.fn().vkCmdWriteTimestamp(
        commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_->pool_,
        static_cast<std::uint32_t>(2 * timestamps_->names_.size() - 1));
  }
  if (device_.fn().vkCmdEndDebugUtilsLabelEXT != nullptr) {
    device_.fn().vkCmdEndDebugUtilsLabelEXT(commands_);
  }
}

void Recorder::barrier() {
  VkMemoryBarrier memory{};
  memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  memory.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  memory.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  device_.fn().vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                    VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                                    0, 1, &memory, 0, nullptr, 0, nullptr);
}

void Recorder::bind_textures(VkDescriptorSet textures) {
  for (const VkPipelineBindPoint point :
       {VK_PIPELINE_BIND_POINT_COMPUTE, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR}) {
    device_.fn().vkCmdBindDescriptorSets(commands_, point, device_.pipeline_layout(), 0, 1,
                                         &textures, 0, nullptr);
  }
}

void Recorder::copy(const Buffer& from, const Buffer& to, std::size_t bytes,
                    std::size_t from_offset, std::size_t to_offset) {
  if (bytes == 0) return;
  const VkBufferCopy region = {from.offset() + from_offset, to.offset() + to_offset, bytes};
  device_.fn().vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

void Recorder::fill(const Buffer& buffer, std::uint32_t word, std::size_t offset,
                    std::size_t bytes) {
  constexpr std::size_t kFilledWord = 4;
  const std::size_t size =
      bytes == 0 ? (buffer.bytes() - offset) / kFilledWord * kFilledWord : bytes;
  if (size == 0) return;
  device_.fn().vkCmdFillBuffer(commands_, buffer.handle(), buffer.offset() + offset, size, word);
}

void Recorder::update(const Buffer& buffer, const void* data, std::size_t bytes,
                      std::size_t offset) {
  device_.fn().vkCmdUpdateBuffer(commands_, buffer.handle(), buffer.offset() + offset, bytes, data);
}

void Recorder::bind_compute(const Kernel& kernel, const void* arguments, std::uint32_t bytes) {
  assert(fits(bytes, kernel.argument_bytes()));
  const Functions& f = device_.fn();
  f.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.handle());
  if (bytes == 0) return;
  f.vkCmdPushConstants(commands_, device_.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, bytes,
                       arguments);
}

void Recorder::bind_rays(const RayKernel& kernel, const void* arguments, std::uint32_t bytes) {
  assert(fits(bytes, kernel.argument_bytes()));
  const Functions& f = device_.fn();
  f.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, kernel.handle());
  if (bytes == 0) return;
  f.vkCmdPushConstants(commands_, device_.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, bytes,
                       arguments);
}

void Recorder::dispatch(const Kernel& kernel, const void* arguments, std::uint32_t bytes,
                        std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  if (x == 0 || y == 0 || z == 0) return;
  assert(groups(x, kernel.group_size(0)) <= device_.limits().max_groups &&
         groups(y, kernel.group_size(1)) <= device_.limits().max_groups);
  bind_compute(kernel, arguments, bytes);
  device_.fn().vkCmdDispatch(commands_, groups(x, kernel.group_size(0)),
                             groups(y, kernel.group_size(1)), groups(z, kernel.group_size(2)));
}

void Recorder::dispatch_indirect(const Kernel& kernel, const void* arguments, std::uint32_t bytes,
                                 const Buffer& groups_at, std::size_t offset) {
  bind_compute(kernel, arguments, bytes);
  device_.fn().vkCmdDispatchIndirect(commands_, groups_at.handle(), groups_at.offset() + offset);
}

void Recorder::trace_rays(const RayKernel& kernel, const void* arguments, std::uint32_t bytes,
                          std::uint32_t count) {
  if (count == 0) return;
  const std::uint32_t width = std::min(count, kLaunchWidth);
  bind_rays(kernel, arguments, bytes);
  const VkStridedDeviceAddressRegionKHR none{};
  device_.fn().vkCmdTraceRaysKHR(commands_, &kernel.generation(), &kernel.miss(), &kernel.hit(),
                                 &none, width, groups(count, width), 1);
}

void Recorder::trace_rays_indirect(const RayKernel& kernel, const void* arguments,
                                   std::uint32_t bytes, const Buffer& size, std::size_t offset) {
  bind_rays(kernel, arguments, bytes);
  const VkStridedDeviceAddressRegionKHR none{};
  device_.fn().vkCmdTraceRaysIndirectKHR(commands_, &kernel.generation(), &kernel.miss(),
                                         &kernel.hit(), &none, size.address() + offset);
}

}  // namespace lambent::vulkan
