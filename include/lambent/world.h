// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent {

namespace vulkan {
class Device;
}

/// The changes that World::update found since the update before. Another order of the scene's list
/// of instances is not a change.
struct WorldChanges {
  /// A light before and after; none before: it was added, none after: it was removed.
  struct LightChange {
    std::optional<Light> before, after;
  };
  std::uint64_t revision = 0;  ///< Counts updates that found something; 0: the world as built.
  /// World-space boxes [m] of instances that moved, deformed, appeared, vanished, or changed which
  /// rays pass through them: around each one as it was, and as it is.
  std::vector<Bounds> moved;
  /// The boxes of those instances that are not Instance::dynamic.
  std::vector<Bounds> rebuilt;
  std::vector<LightChange> lights;
  std::vector<int> materials;  ///< Indices of those that changed, themselves or by a texture.
  bool emission = false;       ///< The light or the places of emissive surfaces changed.
  bool environment = false;    ///< The sky changed.
  double refit_ms = 0.0;       ///< Wall-clock time the update took.

  /// Whether anything changed.
  bool any() const { return !moved.empty() || relights(); }
  /// Whether light changed in other ways than by where things are.
  bool relights() const { return !lights.empty() || !materials.empty() || emission || environment; }
};

/// A scene prepared for rendering: its acceleration structure and its tables of light sources.
/// Refers to the scene, which must outlive it. The scene may be edited between frames: call update
/// before the world is used again.
class World {
 public:
  /// Number of updates that changes_since can return.
  static constexpr std::size_t kLogLength = 256;

  /// Builds everything. Where several emissive triangles, or more than 16 point and spot lights,
  /// can be chosen from, this learns from up to half a million rays which surfaces see them (a
  /// tenth of a second or two). On a device (lambent/vulkan.h) rays are traced there, and passes
  /// that can run there do; null: on the processor. Throws std::invalid_argument with the reason
  /// where validate does not accept the scene, and std::runtime_error where the ray tracer cannot
  /// start or memory runs out.
  explicit World(const Scene& scene, std::shared_ptr<vulkan::Device> device = nullptr);
  /// A temporary scene would not outlive the world.
  explicit World(const Scene&& scene, std::shared_ptr<vulkan::Device> device = nullptr) = delete;
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Finds the edits of the scene since the last update and follows them, refitting or rebuilding
  /// only the parts that they affect. Any part of the scene may be edited: instances, lights,
  /// materials and the environment's numbers are compared; for meshes, textures and the
  /// environment's map, `revision` and size are. Meshes, materials and textures may be added at the
  /// end. Traces some thousand rays to follow what is known of the visibility of lights. Returns
  /// the changes; where there are none, the revision is the last one. Fails on edits of what it
  /// compares that validate would refuse, naming the culprit; the world then stays as it was, and
  /// must not be used before the scene is mended and update has been called again. Cameras, rigs
  /// and fog are not looked at. Not to be called while the world is read. Throws std::runtime_error
  /// where memory runs out.
  Expected<WorldChanges> update();

  /// Number of updates so far that found changes.
  std::uint64_t revision() const;
  /// The changes after `revision`, oldest first; none where the log no longer reaches back so far
  /// (kLogLength), or there was no such revision.
  std::optional<std::vector<WorldChanges>> changes_since(std::uint64_t revision) const;

  /// A box around an instance as of the last update, world space [m]: the transformed box of its
  /// mesh, which is loose where the instance is rotated.
  Bounds instance_bounds(int instance) const;

  const Scene& scene() const { return *scene_; }
  /// The device that the world is on; null: the processor.
  std::shared_ptr<vulkan::Device> device() const;

  /// Wall-clock time [ms] and memory [bytes] of the acceleration structure.
  double build_ms() const;
  std::size_t bytes() const;
  /// Wall-clock time that the acceleration structure took in the last update that changed it [ms].
  double refit_ms() const;

 private:
  friend struct WorldAccess;
  struct State;
  const Scene* scene_;
  std::unique_ptr<State> state_;
};

/// Bounds of the scene's open space: world_bounds less the walls that close it off, so that a field
/// fitted to it has its outermost probes in front of the walls and not inside. A side counts as
/// walled where most rays from outside pass through no more than a tenth of the scene before they
/// reach open space. Where surfaces of an object, rather than a room, face out of another side,
/// some air is added, so that there are probes in front of them, too; other sides are not changed.
/// A viewer outside the world's bounds adds air in front of the walls that face it; one inside
/// keeps sides where they are that would leave it outside of the open space. Parts that are few and
/// far from the rest are left out; or the rest is, if the viewer stands in such a part.
Bounds open_bounds(const World& world, std::optional<glm::vec3> viewer_ws = std::nullopt);

}  // namespace lambent
