// SPDX-License-Identifier: Apache-2.0
// What a scene was like, in as few words as it takes to tell what was edited since.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// All that decides what rays see and what they bring back, without vertices and texels: for these
/// stand their revisions.
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
    const float* pixels;  // never read: another map is at another address
    bool operator==(const Sky&) const = default;
  };
  std::vector<Placement> placements;
  std::vector<Shape> shapes;
  std::vector<std::uint32_t> textures;  // revisions
  std::vector<Material> materials;
  std::vector<Light> lights;
  Sky sky;
};

/// World-space box of a placement: the corners of its mesh's, carried along [m].
Bounds world_box(const SceneSnapshot& snapshot, const SceneSnapshot::Placement& placement);

/// The scene as it is. Meshes that are as in `before` keep its bounds; null: there is no before.
SceneSnapshot take_snapshot(const Scene& scene, const SceneSnapshot* before);

/// What differs between two snapshots of a scene.
struct SceneEdits {
  WorldChanges changes;
  GeometryEdits geometry;
  bool geometry_differs = false;  ///< In a way that the ray tracer must hear of.
  bool emitters_differ = false;   ///< Emissive surfaces do, or their places in the list.
};
SceneEdits compare(const SceneSnapshot& before, const SceneSnapshot& after);

/// Checks what `after` has that `before` has not, as validate would. `after` is of the scene.
Expected<void> validate_edits(const Scene& scene, const SceneSnapshot& before);

}  // namespace lambent
