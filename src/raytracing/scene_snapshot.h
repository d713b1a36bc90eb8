// SPDX-License-Identifier: Apache-2.0
// Compact copies of a scene's state, to find later edits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// All that affects the hits of rays and their light. Vertices and texels are represented by their
/// revisions.
struct SceneSnapshot {
  struct Placement {
    int mesh;
    glm::mat4 world_from_object;
    bool receives_gi;
    bool dynamic;
    std::uint32_t mask;
    bool operator==(const Placement&) const = default;
  };
  struct Shape {
    std::uint32_t revision;
    std::size_t vertices, triangles;
    int material;
    Bounds bounds;  // object space
  };
  struct Sky {
    glm::vec3 radiance;
    float rotation;
    std::uint32_t revision;
    int width, height;
    const float* pixels;  // compared, never dereferenced: another map has another address
    bool operator==(const Sky&) const = default;
  };
  std::vector<Placement> placements;
  std::vector<Shape> shapes;
  std::vector<std::uint32_t> textures;  // revisions
  std::vector<Material> materials;
  std::vector<Light> lights;
  Sky sky;
};

/// World-space box around the transformed corners of the box of a placement's mesh [m].
Bounds world_box(const SceneSnapshot& snapshot, const SceneSnapshot::Placement& placement);

/// A snapshot of the scene. Bounds of meshes that are unchanged since `before` are copied from it;
/// null: there is none.
SceneSnapshot take_snapshot(const Scene& scene, const SceneSnapshot* before);

/// What differs between two snapshots of a scene.
struct SceneEdits {
  WorldChanges changes;
  GeometryEdits geometry;
  bool geometry_differs = false;  ///< The ray tracer must be updated.
  bool emitters_differ = false;   ///< Emissive surfaces differ, or their order.
};
SceneEdits compare(const SceneSnapshot& before, const SceneSnapshot& after);

/// Checks what is new in the scene since `before`, as validate would.
Expected<void> validate_edits(const Scene& scene, const SceneSnapshot& before);

}  // namespace lambent
