// SPDX-License-Identifier: Apache-2.0
// What passes find in a world besides its public interface.
#pragma once

#include <memory>

#include "lambent/world.h"

namespace lambent {

class DeviceWorld;
class EmissiveTriangles;
class LightTree;
class RayTracer;
class SkyLevels;
struct ScenePose;

struct World::State {
  /// Builds everything; on the device, where it is not null.
  State(const Scene& scene, std::shared_ptr<vulkan::Device> device);
  ~State();

  struct History;
  std::unique_ptr<EmissiveTriangles> emissive;
  std::unique_ptr<LightTree> lights;
  std::unique_ptr<SkyLevels> sky;
  std::shared_ptr<DeviceWorld> on_device;  ///< Null on the processor.
  std::shared_ptr<RayTracer> tracer;       ///< The device's, where there is one.
  std::unique_ptr<History> history;
  std::shared_ptr<const ScenePose> pose;
};

/// Opens a world to the functions below.
struct WorldAccess {
  static const World::State& state_of(const World& world) { return *world.state_; }
};

/// What finds hits and occlusion. Lives as long as the world.
inline const RayTracer& tracer_of(const World& world) {
  return *WorldAccess::state_of(world).tracer;
}

/// What draws points on emissive surfaces. Lives until the world's next update.
inline const EmissiveTriangles& emissive_of(const World& world) {
  return *WorldAccess::state_of(world).emissive;
}

/// All lights, and the tree that points draw them from. Lives as long as the world.
inline const LightTree& lights_of(const World& world) {
  return *WorldAccess::state_of(world).lights;
}

/// The sky, for rays that stand for a cone. Lives as long as the world.
inline const SkyLevels& sky_of(const World& world) {
  return *WorldAccess::state_of(world).sky;
}

/// Where everything is. Another object after each update that found geometry to differ.
inline const std::shared_ptr<const ScenePose>& pose_of(const World& world) {
  return WorldAccess::state_of(world).pose;
}

/// The world as passes on its device find it; null on the processor. Lives as long as the world.
inline const DeviceWorld* device_world_of(const World& world) {
  return WorldAccess::state_of(world).on_device.get();
}

}  // namespace lambent
