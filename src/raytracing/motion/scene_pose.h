// SPDX-License-Identifier: Apache-2.0
// Poses: where a scene's surfaces are at one revision of a world. With two poses, a point of a
// surface can be found again at another revision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

struct GeometryEdits;

/// Poses share what does not differ between them. With a pose, the positions of all points at its
/// revision can be recovered, however many updates have passed.
struct ScenePose {
  struct Placement {
    std::uint64_t identity;  ///< The same for the same instance in all poses of a world.
    glm::mat4 world_from_object;
  };
  struct Shape {
    std::uint32_t revision;  ///< Mesh::revision.
    std::size_t vertices, triangles;
    /// Object space [m]. Stored for meshes that the scene's animations deform and for those that
    /// were deformed before; null: not stored.
    std::shared_ptr<const std::vector<glm::vec3>> positions;
  };
  std::vector<Placement> placements;  ///< One for each instance.
  std::vector<Shape> shapes;          ///< One for each mesh.
  std::uint64_t identities = 0;       ///< Number of identities assigned so far.
};

/// The pose of a scene for which a world is being built.
std::shared_ptr<const ScenePose> first_pose(const Scene& scene);

/// The pose of a scene after `edits` to the pose `before`.
std::shared_ptr<const ScenePose> next_pose(const Scene& scene, const GeometryEdits& edits,
                                           const ScenePose& before);

/// The state of an instance in an earlier pose.
struct InstanceBefore {
  glm::mat4 world_from_object{1.0f};
  /// Its mesh's positions, object space [m]; null: they are the present ones.
  std::shared_ptr<const std::vector<glm::vec3>> positions;
  bool known = false;  ///< The instance existed, and its vertices' positions are known.
};

/// The state in `before` of each instance of `now`; both are poses of the same world.
std::vector<InstanceBefore> instances_before(const ScenePose& before, const ScenePose& now,
                                             const Scene& scene);

}  // namespace lambent
