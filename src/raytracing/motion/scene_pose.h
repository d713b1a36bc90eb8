// SPDX-License-Identifier: Apache-2.0
// Where a scene's surfaces are at one revision of a world: what it takes to find a point of them
// again in another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

struct GeometryEdits;

/// Poses share what does not differ between them. Whoever keeps one can tell where all points were,
/// however many updates have passed.
struct ScenePose {
  struct Placement {
    std::uint64_t identity;  ///< The same for the same instance in all poses of a world.
    glm::mat4 world_from_object;
  };
  struct Shape {
    std::uint32_t revision;  ///< Mesh::revision.
    std::size_t vertices, triangles;
    /// Object space [m]. Kept of meshes that the scene's animations bend and of those that were
    /// bent before; null: not kept.
    std::shared_ptr<const std::vector<glm::vec3>> positions;
  };
  std::vector<Placement> placements;  ///< One an instance.
  std::vector<Shape> shapes;          ///< One a mesh.
  std::uint64_t identities = 0;       ///< That were given so far.
};

/// The scene as a world is built over it.
std::shared_ptr<const ScenePose> first_pose(const Scene& scene);

/// The scene as it is, `edits` after `before`.
std::shared_ptr<const ScenePose> next_pose(const Scene& scene, const GeometryEdits& edits,
                                           const ScenePose& before);

/// What an instance was like in an earlier pose.
struct InstanceBefore {
  glm::mat4 world_from_object{1.0f};
  /// Of its mesh, object space [m]; null: as they are.
  std::shared_ptr<const std::vector<glm::vec3>> positions;
  bool known = false;  ///< It was there, and so were its mesh's vertices.
};

/// What each instance of the pose `now` was like in `before`, a pose of the same world.
std::vector<InstanceBefore> instances_before(const ScenePose& before, const ScenePose& now,
                                             const Scene& scene);

}  // namespace lambent
