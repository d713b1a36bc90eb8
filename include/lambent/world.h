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

/// What World::update found to differ from the update before. That an instance has come to stand at
/// another place in the scene's list is no change.
struct WorldChanges {
  /// A light before and after; none before: it was added, none after: it was removed.
  struct LightChange {
    std::optional<Light> before, after;
  };
  std::uint64_t revision = 0;  ///< Counts updates that found something; 0: the world as built.
  /// World-space boxes where geometry that moved, deformed, appeared, vanished, or came to let
  /// other rays through stood before and stands now, one each [m].
  std::vector<Bounds> moved;
  /// The same of those that are not `dynamic`: what has been built anew rather than set in motion.
  std::vector<Bounds> rebuilt;
  std::vector<LightChange> lights;
  std::vector<int> materials;  ///< Indices of those that differ, in themselves or in a texture.
  bool emission = false;       ///< What emissive surfaces send, or where they are, differs.
  bool environment = false;    ///< The sky differs.
  double refit_ms = 0.0;       ///< Wall-clock time the update took.

  /// Whether anything differs.
  bool any() const {
    return !moved.empty() || !lights.empty() || !materials.empty() || emission || environment;
  }
};

/// A scene made ready for light: its acceleration structure and its tables of light sources.
/// Refers to the scene, which must outlive it. The scene may be edited between frames: call update
/// before the world is used again.
class World {
 public:
  /// Updates that changes_since reaches back.
  static constexpr std::size_t kLogLength = 256;

  /// Builds everything. The scene must be one that validate accepts. On a device (lambent/vulkan.h)
  /// rays are traced there, and passes that can run there do; null: on the processor. Throws
  /// std::runtime_error where the ray tracer cannot start or memory runs out.
  explicit World(const Scene& scene, std::shared_ptr<vulkan::Device> device = nullptr);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Finds what was edited in the scene since the last update, and follows, refitting or rebuilding
  /// only what that touches. Any part of the scene may be edited: instances, lights, materials and
  /// the environment's numbers are compared; of meshes, textures and the environment's map the
  /// `revision` is (and their size). Meshes, materials and textures may be added at the end.
  /// Returns what differs; where nothing does, nothing changes and the revision is the last one.
  /// Fails on edits that validate would refuse, naming the culprit; the world then stays as it
  /// was, and must not be used before the scene is mended and update has been called again.
  /// Not to be called while the world is read. Throws std::runtime_error where memory runs out.
  Expected<WorldChanges> update();

  /// Updates that found something so far.
  std::uint64_t revision() const;
  /// The changes after `revision`, oldest first; none where the log no longer reaches back so far
  /// (kLogLength), or there was no such revision.
  std::optional<std::vector<WorldChanges>> changes_since(std::uint64_t revision) const;

  /// A box around an instance as it was at the last update, world space [m]: that of its mesh,
  /// carried along, which is loose where it is turned.
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
/// some air is added, so that probes stand in front of them, too; all else stays as it is. A viewer
/// outside of the world's bounds adds air in front of the walls that face it.
Bounds open_bounds(const World& world, std::optional<glm::vec3> viewer_ws = std::nullopt);

}  // namespace lambent
