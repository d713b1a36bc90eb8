// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/engine_tracer.h"

#include "raytracing/vulkan/trace_arguments.h"
#include "shaders/closest_rchit.h"
#include "shaders/closest_rmiss.h"
#include "shaders/engine_closest_rgen.h"
#include "shaders/engine_occlusion_rgen.h"
#include "shaders/occlusion_rmiss.h"
#include "vulkan/device.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Recorder;

VkDeviceAddress address_of(const vulkan::Device& device, VkAccelerationStructureKHR structure) {
  VkAccelerationStructureDeviceAddressInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
  info.accelerationStructure = structure;
  return device.fn().vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &info);
}

}  // namespace

EngineClosest::EngineClosest(const vulkan::Device& device)
    : kernel(device,
             {shaders::engine_closest_rgen(),
              shaders::closest_rmiss(),
              shaders::closest_rchit(),
              {},
              /*any_record=*/true},
             "closest hits of engines") {}

EngineOcclusion::EngineOcclusion(const vulkan::Device& device)
    : kernel(device,
             {shaders::engine_occlusion_rgen(),
              shaders::occlusion_rmiss(),
              {},
              {},
              /*any_record=*/true},
             "occlusions of engines") {}

EngineTracer::EngineTracer(const vulkan::Device& device, VkAccelerationStructureKHR structure,
                           std::uint32_t mask)
    : device_(device), address_(address_of(device, structure)), mask_(mask) {}

void EngineTracer::trace(Recorder& to, const vulkan::RayKernel& kernel, const RayBatch& batch,
                         HitArray hits, UintArray occluded) const {
  const EngineTraceArguments arguments = {
      uvec2(static_cast<uint>(address_), static_cast<uint>(address_ >> 32)),
      batch.rays,
      hits,
      occluded,
      batch.count,
      mask_};
  if (batch.indirect != nullptr) {
    to.trace_indirect(kernel, arguments, *batch.indirect, batch.indirect_offset);
    return;
  }
  to.trace(kernel, arguments, batch.count);
}

void EngineTracer::closest_hits(Recorder& to, const RayBatch& batch, HitArray hits) const {
  trace(to, device_.kept<EngineClosest>().kernel, batch, hits, {});
}

void EngineTracer::occlusions(Recorder& to, const RayBatch& batch, UintArray occluded) const {
  trace(to, device_.kept<EngineOcclusion>().kernel, batch, {}, occluded);
}

}  // namespace lambent
