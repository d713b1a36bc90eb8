// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/device_world.h"

#include <utility>

namespace lambent {

DeviceWorld::DeviceWorld(const Scene& scene, std::shared_ptr<vulkan::Device> device)
    : scene_(scene), device_(std::move(device)) {
  meshes_.resize(scene_.meshes.size());
  for (std::size_t mesh = 0; mesh < meshes_.size(); ++mesh) upload(mesh);
  tracer_ = std::make_unique<VulkanRayTracer>(*device_, scene_, [this](std::size_t mesh) {
    vulkan::TriangleGeometry geometry;
    geometry.positions = meshes_[mesh].positions.address();
    geometry.indices = meshes_[mesh].triangles.address();
    geometry.vertices = static_cast<std::uint32_t>(scene_.meshes[mesh].positions.size());
    geometry.triangles = static_cast<std::uint32_t>(scene_.meshes[mesh].triangles.size());
    return geometry;
  });
}

void DeviceWorld::upload(std::size_t mesh) {
  meshes_[mesh].positions =
      vulkan::upload(*device_, scene_.meshes[mesh].positions, "positions", vulkan::kGeometryUsage);
  meshes_[mesh].triangles =
      vulkan::upload(*device_, scene_.meshes[mesh].triangles, "triangles", vulkan::kGeometryUsage);
}

void DeviceWorld::update(const SceneEdits& edits) {
  const std::size_t known = meshes_.size();
  meshes_.resize(scene_.meshes.size());
  for (std::size_t mesh = known; mesh < meshes_.size(); ++mesh) upload(mesh);
  for (const std::uint32_t mesh : edits.geometry.remade) upload(mesh);
  for (const std::uint32_t mesh : edits.geometry.deformed) upload(mesh);
  if (edits.geometry_differs) tracer_->update(edits.geometry);
}

}  // namespace lambent
