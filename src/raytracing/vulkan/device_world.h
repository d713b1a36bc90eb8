// SPDX-License-Identifier: Apache-2.0
// A world as passes on a device find it.
#pragma once

#include <memory>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/scene_snapshot.h"
#include "raytracing/vulkan/vulkan_raytracer.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"

namespace lambent {

class DeviceWorld {
 public:
  /// Brings the scene, which must outlive it, to the device. Throws std::runtime_error where the
  /// device's memory runs out.
  DeviceWorld(const Scene& scene, std::shared_ptr<vulkan::Device> device);

  /// Follows edits of the scene. Not to be called while the device works on the world.
  void update(const SceneEdits& edits);

  const vulkan::Device& device() const { return *device_; }
  std::shared_ptr<vulkan::Device> shared_device() const { return device_; }
  VulkanRayTracer& tracer() { return *tracer_; }
  const VulkanRayTracer& tracer() const { return *tracer_; }

 private:
  struct MeshBuffers {
    vulkan::Buffer positions, triangles;
  };
  void upload(std::size_t mesh);

  const Scene& scene_;
  std::shared_ptr<vulkan::Device> device_;
  std::vector<MeshBuffers> meshes_;
  std::unique_ptr<VulkanRayTracer> tracer_;
};

}  // namespace lambent
