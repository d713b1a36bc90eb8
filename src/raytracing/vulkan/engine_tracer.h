// SPDX-License-Identifier: Apache-2.0
// Rays in an acceleration structure of an engine's.
#pragma once

#include "raytracing/vulkan/device_tracer.h"
#include "vulkan/kernel.h"

namespace lambent {

/// The pipelines, which a device keeps (Device::kept): asked for once in advance, they are there
/// where recording must make nothing.
struct EngineClosest {
  explicit EngineClosest(const vulkan::Device& device);
  vulkan::RayKernel kernel;
};
struct EngineOcclusion {
  explicit EngineOcclusion(const vulkan::Device& device);
  vulkan::RayKernel kernel;
};

/// Traces rays in a structure of which nothing is known but its handle: instance masks are the
/// engine's, as are those of rays whose closest hits are asked for, and see-through surfaces stop
/// rays.
class EngineTracer final : public DeviceTracer {
 public:
  /// `mask`: occlusion is by instances whose mask shares a bit with this one.
  EngineTracer(const vulkan::Device& device, VkAccelerationStructureKHR structure,
               std::uint32_t mask);

  void closest_hits(vulkan::Recorder& to, const RayBatch& batch, HitArray hits) const override;
  void occlusions(vulkan::Recorder& to, const RayBatch& batch, UintArray occluded) const override;

 private:
  void trace(vulkan::Recorder& to, const vulkan::RayKernel& kernel, const RayBatch& batch,
             HitArray hits, UintArray occluded) const;

  const vulkan::Device& device_;
  VkDeviceAddress address_;
  std::uint32_t mask_;
};

}  // namespace lambent
