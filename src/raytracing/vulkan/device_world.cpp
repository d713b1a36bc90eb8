// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/device_world.h"

#include <utility>

namespace lambent {

DeviceWorld::DeviceWorld(const Scene& scene, const EmissiveTriangles& emissive,
                         const LightTree& lights, std::shared_ptr<vulkan::Device> device)
    : scene_(scene),
      device_(std::move(device)),
      device_scene_(*device_, scene, emissive, lights),
      tracer_(scene, device_scene_) {}

void DeviceWorld::update(const SceneEdits& edits, const EmissiveTriangles& emissive,
                         const LightTree& lights) {
  device_scene_.update(scene_, emissive, lights);
  if (edits.geometry_differs) tracer_.update(edits.geometry);
}

}  // namespace lambent
