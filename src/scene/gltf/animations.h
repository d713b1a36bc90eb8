// SPDX-License-Identifier: Apache-2.0
// Import of a file's animations to curves and a rig.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf/document/document.h"
#include "scene/gltf/nodes.h"

namespace lambent::gltf {

/// Collects the objects that animations move while a scene is imported, and finally makes its rig.
class MotionImporter {
 public:
  /// Reads the curves; invalid channels are dropped with a warning. The tree must outlive it.
  MotionImporter(Document& document, const NodeTree& tree);

  /// Whether the node moves, directly or through a parent.
  bool moves(int node) const { return moves_[node]; }
  /// Whether the mesh in this node is deformed, by animated weights or joints.
  bool bends(int node) const;

  void add_instance(int node, int instance, const glm::dmat4& node_from_object);
  /// `source`: index into the file's lights.
  void add_light(int node, int source, int light);
  void add_camera(int node, int camera);
  /// `mesh`: complete except for its node and skin; `joint_from_bind`: that of the skin, if it has
  /// one; `centre`: see ImportedMesh.
  void add_mesh(int node, RigMesh mesh, const std::vector<glm::dmat4>& joint_from_bind,
                const glm::dvec3& centre);

  /// Adds animations and rig to the scene whose parts were added. Adds nothing if nothing moves.
  void finish(Scene& scene);

 private:
  enum class List { nodes, meshes, materials, lights, cameras };
  /// A channel whose target is an index of the file.
  struct Driver {
    std::size_t animation;
    List list;
    int index;
    Channel channel;
  };
  void read(std::size_t animation, const ChannelSource& source);
  void mark_moving();
  const char* read_curve(const ChannelSource& source, Driver& driver) const;
  bool is_moved() const { return tree_.origin != glm::dvec3(0.0); }
  int weights_of(int mesh) const;
  bool is_driven(List list, int index) const;
  int rig_skin(int skin, const std::vector<glm::dmat4>& joint_from_bind, const glm::dvec3& centre);
  void add_nodes();
  void add_materials(const Scene& scene);
  void add_channel(const Driver& driver, Animation& animation) const;

  Document& document_;
  const NodeTree& tree_;
  std::vector<Driver> drivers_;
  std::vector<int> rig_node_of_;        // by the file's node
  std::vector<bool> moves_, weighted_;  // by the file's node
  std::vector<int> rig_skin_of_;        // by the file's skin; -1: not yet
  // indices in the file of the rig's lights and cameras
  std::vector<int> light_sources_, camera_sources_;
  Rig rig_;
};

}  // namespace lambent::gltf
