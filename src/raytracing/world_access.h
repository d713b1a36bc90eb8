// SPDX-License-Identifier: Apache-2.0
// Access to the parts of a world that its public interface does not show.
#pragma once

#include <memory>

#include "lambent/world.h"

namespace lambent {

class DeviceWorld;
class EmissiveTriangles;
class LightTree;
class LightVisibility;
class RayTracer;
class SkyLevels;
struct SceneEdits;
struct ScenePose;

struct World::State {
  /// Builds everything, on the device where that is not null.
  State(const Scene& scene, std::shared_ptr<vulkan::Device> device);
  ~State();

  /// Picks lights by their visibility from now on.
  void set_light_visibility(LightVisibility visibility);
  /// Follows edits to which all else was updated. `builds_before`: LightTree::builds() before.
  void follow_light_visibility(const World& world, const SceneEdits& edits, int builds_before);

  struct History;
  std::unique_ptr<EmissiveTriangles> emissive;
  std::unique_ptr<LightTree> lights;
  std::unique_ptr<SkyLevels> sky;
  std::shared_ptr<DeviceWorld> on_device;  ///< Null on the processor.
  std::shared_ptr<RayTracer> tracer;       ///< The device's, where there is one.
  std::unique_ptr<History> history;
  std::shared_ptr<const ScenePose> pose;
};

/// Gives the functions below access to a world's state.
struct WorldAccess {
  static const World::State& state_of(const World& world) { return *world.state_; }
};

/// The world's ray tracer. Lives as long as the world.
inline const RayTracer& tracer_of(const World& world) {
  return *WorldAccess::state_of(world).tracer;
}

/// The world's emissive triangles. Lives until the world's next update.
inline const EmissiveTriangles& emissive_of(const World& world) {
  return *WorldAccess::state_of(world).emissive;
}

/// All lights, and the tree that samples are drawn from. Lives as long as the world.
inline const LightTree& lights_of(const World& world) {
  return *WorldAccess::state_of(world).lights;
}

/// The sky, for rays that stand for a cone. Lives as long as the world.
inline const SkyLevels& sky_of(const World& world) {
  return *WorldAccess::state_of(world).sky;
}

/// The poses of all instances. A new object after each update in which geometry differed.
inline const std::shared_ptr<const ScenePose>& pose_of(const World& world) {
  return WorldAccess::state_of(world).pose;
}

/// The world in its device's memory; null on the processor. Lives as long as the world.
inline const DeviceWorld* device_world_of(const World& world) {
  return WorldAccess::state_of(world).on_device.get();
}

}  // namespace lambent
