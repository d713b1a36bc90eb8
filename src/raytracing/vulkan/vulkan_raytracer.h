// SPDX-License-Identifier: Apache-2.0
// A ray tracer on a Vulkan device, for passes that run there and for those that run on the host.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "raytracing/raytracer.h"
#include "raytracing/vulkan/device_scene.h"
#include "raytracing/vulkan/device_tracer.h"
#include "raytracing/vulkan/scene_acceleration.h"
#include "vulkan/kernel.h"

namespace lambent {

class VulkanRayTracer final : public RayTracer, public DeviceTracer {
 public:
  /// Built for the present state of the scene, which the device scene must match. Both must outlive
  /// it. Throws std::runtime_error where memory runs out.
  VulkanRayTracer(const Scene& scene, const DeviceScene& device_scene);
  ~VulkanRayTracer() override;

  // For the host: rays are uploaded and hits read back; callers take turns on the device.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const override;
  void occlusions(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override;
  void transmittances(std::span<const Ray> rays, std::span<glm::vec3> through) const override;
  bool has_glass() const override { return has_glass_; }
  bool dims_shadows() const override { return dims_shadows_; }
  std::size_t batch_rays() const override;
  AccelerationStatistics statistics() const override { return statistics_; }
  /// To be called after the device's scene was updated.
  void update(const GeometryEdits& edits) override;

  // For passes on the device.
  void closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                    HitArray hits) const override;
  void occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                  UintArray occluded) const override;
  void transmittances(vulkan::Recorder& recorder, const RayBatch& batch, HitArray hits,
                      Vec3Array through) const override;

 private:
  struct Kernels;
  class Staging;
  class Borrowed;

  struct Answers {
    HitArray hits{};
    UintArray occluded{};
    Vec3Array through{};
    bool to_hits = false;
  };
  void trace(vulkan::Recorder& recorder, const vulkan::RayKernel& kernel, const RayBatch& batch,
             const Answers& answers) const;
  void tell_sizes();

  const Scene& scene_;
  const DeviceScene& device_scene_;
  const vulkan::Device& device_;
  const Kernels& kernels_;
  std::unique_ptr<SceneAcceleration> acceleration_;
  AccelerationStatistics statistics_;
  bool has_glass_ = false;
  bool dims_shadows_ = false;
  mutable std::mutex staging_mutex_;
  mutable std::vector<std::unique_ptr<Staging>> idle_staging_;
};

}  // namespace lambent
