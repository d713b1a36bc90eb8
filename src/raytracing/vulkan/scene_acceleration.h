// SPDX-License-Identifier: Apache-2.0
// The acceleration structures of a scene on a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "vulkan/acceleration.h"

namespace lambent {

/// Returns where a mesh's vertices and triangles are in the device's memory. SceneAcceleration
/// sets `opaque` and `deforms`.
using GeometryOfMesh = std::function<vulkan::TriangleGeometry(std::size_t mesh)>;

/// One structure of triangles for each mesh that is placed, and one over all instances, whose
/// custom indices are those into Scene::instances. Meshes always have structures of their own, so
/// that a moving instance costs no more than rebuilding the one over instances.
class SceneAcceleration {
 public:
  /// The scene and the device must outlive it; `geometry_of` is called again in each update.
  SceneAcceleration(const vulkan::Device& device, const Scene& scene, GeometryOfMesh geometry_of);

  /// Updates to edits, once the device has the vertices of meshes that differ. Waits for the
  /// device. Throws std::runtime_error where memory runs out.
  void update(const GeometryEdits& edits);

  VkDeviceAddress address() const { return instances_.address(); }
  std::size_t bytes() const;

 private:
  /// A mesh's structure, and the mesh's state when it was built.
  struct Shape {
    vulkan::AccelerationStructure structure;
    float half_area = 0.0f;            // [m^2]
    std::uint32_t triangles_hash = 0;  // hash of the vertex indices
    bool deforms = false;              // its vertices have moved, and may again
  };

  vulkan::TriangleGeometry geometry(std::size_t mesh) const;
  void build_missing();
  void place_instances(vulkan::Recorder& recorder);

  const vulkan::Device& device_;
  const Scene& scene_;
  GeometryOfMesh geometry_of_;
  std::vector<Shape> shapes_;  // by mesh
  vulkan::TriangleBuilder builder_;
  vulkan::InstanceStructure instances_;
};

}  // namespace lambent
