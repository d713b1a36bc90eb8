// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/device_world.h"

#include <utility>

namespace lambent {

DeviceWorld::DeviceWorld(const Scene& scene, const EmissiveTriangles& emissive,
                         std::shared_ptr<vulkan::Device> device)
    : scene_(scene),
      device_(std::move(device)),
      device_scene_(*device_, scene, emissive),
      tracer_(scene, device_scene_) {}

void DeviceWorld::update(const SceneEdits& edits, const EmissiveTriangles& emissive) {
  device_scene_.update(scene_, emissive);
  if (edits.geometry_differs) tracer_.update(edits.geometry);
}

}  // namespace lambent
