// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

namespace lambent {

struct Scene;

/// How a curve is interpolated between two keys.
enum class Interpolation : std::uint8_t { step, linear, cubic };

/// A value over time. It is constant before the first key and after the last one.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  int components = 1;  ///< Numbers per value, >= 1.
  /// Times of the keys [s], finite and strictly ascending; at least one.
  std::vector<float> times;
  /// `components` numbers per key. Cubic curves have three times as many: the in-tangent, the value
  /// and the out-tangent. Tangents are in units of the value per second.
  std::vector<float> values;
};

/// Writes the value of a curve at a time to `value`: `components` numbers. With `rotation` the
/// values are quaternions (x, y, z, w), which are interpolated along the sphere; the result has
/// unit length.
void evaluate(const Curve& curve, float time_s, bool rotation, float* value);

/// The property that a curve drives. Its numbers have the meaning and the unit that glTF gives
/// them. The comment of each target begins with its number of components.
struct Channel {
  enum class Target : std::uint8_t {
    node_translation,            ///< 3 [m]. `index` is into Rig::nodes, as for the next three.
    node_rotation,               ///< 4: a quaternion (x, y, z, w).
    node_scale,                  ///< 3
    node_weights,                ///< One per morph target.
    light_color,                 ///< 3. `index` is into Rig::lights, as for the next four.
    light_intensity,             ///< 1: multiplies the color.
    light_range,                 ///< 1: [m]
    light_inner_cone_angle,      ///< 1: [rad]
    light_outer_cone_angle,      ///< 1: [rad]
    material_base_color,         ///< 4. `index` is into Rig::materials, as for the next four.
    material_metallic,           ///< 1
    material_roughness,          ///< 1
    material_emissive_factor,    ///< 3
    material_emissive_strength,  ///< 1: multiplies the factor.
    camera_vertical_fov,         ///< 1: [rad]. `index` is into Rig::cameras, as for the next.
    camera_vertical_extent,      ///< 1: half the height of an orthographic view [m].
  };
  Target target = Target::node_translation;
  int index = 0;
  Curve curve;
};

/// Curves that play together.
struct Animation {
  std::string name;  ///< For display; may be empty.
  std::vector<Channel> channels;
};

/// A node of a hierarchy: a transform relative to its parent.
struct RigNode {
  int parent = -1;  ///< Index into Rig::nodes, lower than its own; -1: the world.
  /// [m]. Double precision, since parents may be far from the origin.
  glm::dvec3 translation{0.0};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< Unit; (w, x, y, z).
  glm::vec3 scale{1.0f};
  /// Replaces translation, rotation and scale where it is not the identity. A node with such a
  /// matrix is not animated itself.
  glm::dmat4 parent_from_node{1.0};
  std::vector<float> weights;  ///< Rest weights of the morph targets.
};

/// Joints that move the vertices of meshes.
struct RigSkin {
  std::vector<int> joints;                  ///< Indices into Rig::nodes; at least one.
  std::vector<glm::dmat4> joint_from_bind;  ///< One per joint.
};

/// A mesh whose vertices follow morph weights and joints. No other instance shares it.
struct RigMesh {
  /// Displacements of a morph target, one per vertex in each list; normals and tangents may be
  /// empty.
  struct MorphTarget {
    std::vector<glm::vec3> positions, normals, tangents;
  };
  int mesh = 0;                      ///< Index into Scene::meshes.
  int node = 0;                      ///< Index into Rig::nodes: the node whose weights are used.
  int skin = -1;                     ///< Index into Rig::skins; -1: none.
  std::vector<glm::vec3> positions;  ///< Undeformed, one per vertex of the mesh.
  std::vector<glm::vec3> normals;    ///< Undeformed; empty: normals of the triangles.
  std::vector<glm::vec4> tangents;   ///< Undeformed; empty: from the uvs if needed.
  std::vector<MorphTarget> targets;
  int influences = 0;                 ///< Joints per vertex; 0 without a skin.
  std::vector<std::uint32_t> joints;  ///< Indices into RigSkin::joints: `influences` per vertex.
  std::vector<float> weights;         ///< Weights of these joints; scaled to a sum of 1 when used.
};

/// An instance that follows a node.
struct RigInstance {
  int instance = 0;  ///< Index into Scene::instances.
  int node = 0;      ///< Index into Rig::nodes.
  glm::dmat4 node_from_object{1.0};
};

/// A light that can be animated: its node, and the numbers that glTF stores separately.
struct RigLight {
  int light = 0;           ///< Index into Scene::lights.
  int node = -1;           ///< It points along the node's -Z; -1: it does not move.
  glm::vec3 color{1.0f};   ///< At rest; color * intensity is Light::intensity.
  float intensity = 1.0f;  ///< At rest.
  float range = 0.0f;      ///< At rest [m].
  float inner_cone_angle = 0.0f, outer_cone_angle = 0.785398163f;  ///< At rest [rad].
};

/// A camera that can be animated.
struct RigCamera {
  int camera = 0;                     ///< Index into Scene::cameras.
  int node = -1;                      ///< It looks along the node's -Z; -1: it does not move.
  float vertical_fov = 0.785398163f;  ///< At rest [rad].
  float vertical_extent = 1.0f;       ///< At rest: full height [m].
};

/// A material that can be animated.
struct RigMaterial {
  int material = 0;  ///< Index into Scene::materials.
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emissive_factor{0.0f};
  float emissive_strength = 1.0f;  ///< Times `emissive_factor`, this is Material::emission.
};

/// Everything that animations can move, and how its parts are connected. It refers to the scene's
/// lists by index: code that removes entries from these lists must update the rig, too.
struct Rig {
  std::vector<RigNode> nodes;  ///< Parents before their children.
  std::vector<RigSkin> skins;
  std::vector<RigMesh> meshes;
  std::vector<RigInstance> instances;
  std::vector<RigLight> lights;
  std::vector<RigCamera> cameras;
  std::vector<RigMaterial> materials;
};

/// The time of the last key of an animation [s]; 0 where it has no keys.
float duration(const Animation& animation);

/// Poses a scene at a time. Sets only properties that some animation of the scene drives:
/// transforms of instances, vertices of meshes (and their revision), lights, cameras and numbers of
/// materials. A property that the chosen animation does not drive, but another one does, gets its
/// rest value. Call World::update afterwards. `animation` is an index, or -1: all of them at once,
/// where a later one takes precedence. The scene must be valid. Throws std::bad_alloc where memory
/// runs out.
void animate(Scene& scene, int animation, float time_s);

/// Gives every property that some animation of the scene drives its rest value. Call World::update
/// afterwards, as after animate().
void rest(Scene& scene);

}  // namespace lambent
