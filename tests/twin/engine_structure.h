// SPDX-License-Identifier: Apache-2.0
// An acceleration structure of a scene as an engine has it: nothing of it is known but its handle.
#pragma once

#include <vector>

#include "lambent/scene.h"
#include "vulkan/acceleration.h"
#include "vulkan/device_memory.h"

namespace lambent::test {

class EngineStructure {
 public:
  EngineStructure(const vulkan::Device& device, const Scene& scene)
      : device_(device), instances_(device) {
    std::vector<vulkan::TriangleGeometry> geometries;
    for (const Mesh& mesh : scene.meshes) {
      positions_.push_back(
          vulkan::upload(device, mesh.positions, "positions", vulkan::kGeometryUsage));
      triangles_.push_back(
          vulkan::upload(device, mesh.triangles, "triangles", vulkan::kGeometryUsage));
      geometries.push_back({positions_.back().address(), triangles_.back().address(),
                            static_cast<std::uint32_t>(mesh.positions.size()),
                            static_cast<std::uint32_t>(mesh.triangles.size())});
    }
    shapes_ = vulkan::TriangleBuilder(device).build(geometries);
    place(scene);
  }

  /// Follows instances that have moved.
  void place(const Scene& scene) {
    std::vector<vulkan::PlacedStructure> placed;
    for (const Instance& instance : scene.instances) {
      const auto index = static_cast<std::uint32_t>(placed.size());
      placed.push_back(
          {instance.world_from_object, shapes_[instance.mesh].address(), index, kMask});
    }
    device_.run([&](vulkan::Recorder& to) { instances_.build(to, placed); });
  }

  VkAccelerationStructureKHR handle() const { return instances_.handle(); }
  VkDeviceAddress address() const { return instances_.address(); }

  /// A mask of the engine's own, which shares no bit with those of our own worlds' probe rays.
  static constexpr std::uint8_t kMask = 0x80;

 private:
  const vulkan::Device& device_;
  std::vector<vulkan::Buffer> positions_, triangles_;
  std::vector<vulkan::AccelerationStructure> shapes_;
  vulkan::InstanceStructure instances_;
};

}  // namespace lambent::test
