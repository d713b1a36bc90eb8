// SPDX-License-Identifier: Apache-2.0
// A world in a device's memory.
#pragma once

#include <memory>

#include "lambent/scene.h"
#include "raytracing/scene_snapshot.h"
#include "raytracing/vulkan/device_scene.h"
#include "raytracing/vulkan/vulkan_raytracer.h"
#include "vulkan/device.h"

namespace lambent {

class EmissiveTriangles;
class LightTree;

class DeviceWorld {
 public:
  /// Uploads a scene, which must outlive it, and its lights to the device. Throws
  /// std::runtime_error where the device's memory runs out.
  DeviceWorld(const Scene& scene, const EmissiveTriangles& emissive, const LightTree& lights,
              std::shared_ptr<vulkan::Device> device);

  /// Updates to edits of the scene and of its lights. Not to be called while the device works on
  /// the world; command buffers recorded before become invalid.
  void update(const SceneEdits& edits, const EmissiveTriangles& emissive, const LightTree& lights);

  /// Replaces the table of the lights' visibility, under the same conditions.
  void update_light_visibility(const LightVisibility& visibility) {
    device_scene_.update_light_visibility(scene_, visibility);
  }

  const vulkan::Device& device() const { return *device_; }
  std::shared_ptr<vulkan::Device> shared_device() const { return device_; }
  const DeviceScene& scene() const { return device_scene_; }
  VulkanRayTracer& tracer() { return tracer_; }
  const VulkanRayTracer& tracer() const { return tracer_; }

 private:
  const Scene& scene_;
  std::shared_ptr<vulkan::Device> device_;
  DeviceScene device_scene_;
  VulkanRayTracer tracer_;
};

}  // namespace lambent
