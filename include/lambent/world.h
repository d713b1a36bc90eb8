// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "lambent/scene.h"

namespace lambent {

class RayTracer;
class EmissiveTriangles;

/// A scene made ready for light: its acceleration structure and its tables of light sources.
/// Refers to the scene, which must outlive it and keep still.
class World {
 public:
  /// Builds everything. Throws std::runtime_error where the ray tracer cannot start or memory runs
  /// out.
  explicit World(const Scene& scene);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  const Scene& scene() const { return *scene_; }
  /// What finds hits and occlusion, and what draws points on emissive surfaces: for passes, not
  /// part of the public interface. Both live as long as the world.
  const RayTracer& tracer() const { return *tracer_; }
  const EmissiveTriangles& emissive() const { return *emissive_; }

  /// Wall-clock time [ms] and memory [bytes] of the acceleration structure.
  double build_ms() const;
  std::size_t bytes() const;

 private:
  const Scene* scene_;
  std::unique_ptr<RayTracer> tracer_;
  std::unique_ptr<EmissiveTriangles> emissive_;
};

/// Bounds of the scene's open space: world_bounds less the walls that close it off, so that a field
/// fitted to it has its outermost probes in front of the walls and not inside. A side counts as
/// walled where most rays from outside pass through no more than a tenth of the scene before they
/// reach open space; other sides stay as they are.
Bounds open_bounds(const World& world);

}  // namespace lambent
