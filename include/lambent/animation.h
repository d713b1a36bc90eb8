// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

namespace lambent {

struct Scene;

/// How a curve goes from one key to the next.
enum class Interpolation : std::uint8_t { step, linear, cubic };

/// A value over time. Before its first key and after its last one it stays as it is there.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  int components = 1;        ///< Numbers a value, >= 1.
  std::vector<float> times;  ///< Of the keys [s], finite, each above the one before; at least one.
  /// `components` numbers a key; cubic curves have three times as many: the tangent in, the value,
  /// the tangent out, these in units of the value a second.
  std::vector<float> values;
};

/// The value of a curve at a time, `components` numbers. `rotation`: the values are quaternions
/// (x, y, z, w); they are interpolated along the sphere and the result is unit.
void evaluate(const Curve& curve, float time_s, bool rotation, float* value);

/// What a curve drives. The numbers have the meaning and the unit that glTF gives them.
struct Channel {
  enum class Target : std::uint8_t {
    node_translation,            ///< 3: [m]. Index into Rig::nodes, as in the next three.
    node_rotation,               ///< 4: a quaternion x, y, z, w.
    node_scale,                  ///< 3
    node_weights,                ///< One a morph target.
    light_color,                 ///< 3. Index into Rig::lights, as in the next four.
    light_intensity,             ///< 1: multiplies the color.
    light_range,                 ///< 1: [m]
    light_inner_cone_angle,      ///< 1: [rad]
    light_outer_cone_angle,      ///< 1: [rad]
    material_base_color,         ///< 4. Index into Rig::materials, as in the next four.
    material_metallic,           ///< 1
    material_roughness,          ///< 1
    material_emissive_factor,    ///< 3
    material_emissive_strength,  ///< 1: multiplies the factor.
    camera_vertical_fov,         ///< 1: [rad]. Index into Rig::cameras, as in the next one.
    camera_vertical_extent,      ///< 1: half the height of an orthographic view [m].
  };
  Target target = Target::node_translation;
  int index = 0;
  Curve curve;
};

/// Curves that play together.
struct Animation {
  std::string name;  ///< For people; may be empty.
  std::vector<Channel> channels;
};

/// A place in a hierarchy, relative to its parent.
struct RigNode {
  int parent = -1;              ///< Index into Rig::nodes, below its own; -1: the world.
  glm::dvec3 translation{0.0};  ///< [m]; in double, as parents may stand far from the origin.
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< Unit; (w, x, y, z).
  glm::vec3 scale{1.0f};
  /// Stands for the three where it is not the identity; a node with such a matrix is not animated
  /// itself.
  glm::dmat4 parent_from_node{1.0};
  std::vector<float> weights;  ///< Of morph targets, at rest.
};

/// Joints that carry the vertices of meshes.
struct RigSkin {
  std::vector<int> joints;                  ///< Indices into Rig::nodes; at least one.
  std::vector<glm::dmat4> joint_from_bind;  ///< One a joint.
};

/// A mesh whose vertices follow morph weights and joints. No other instance shares it.
struct RigMesh {
  /// Displacements of a morph target, one a vertex each; normals and tangents may be empty.
  struct MorphTarget {
    std::vector<glm::vec3> positions, normals, tangents;
  };
  int mesh = 0;                      ///< Index into Scene::meshes.
  int node = 0;                      ///< Index into Rig::nodes: whose weights count.
  int skin = -1;                     ///< Index into Rig::skins; -1: none.
  std::vector<glm::vec3> positions;  ///< Before all bending, one a vertex of the mesh.
  std::vector<glm::vec3> normals;    ///< Likewise; empty: those of the triangles.
  std::vector<glm::vec4> tangents;   ///< Likewise; empty: made from texture coordinates if needed.
  std::vector<MorphTarget> targets;
  int influences = 0;                 ///< Joints a vertex; 0 without a skin.
  std::vector<std::uint32_t> joints;  ///< Into RigSkin::joints: `influences` a vertex.
  std::vector<float> weights;         ///< Of these joints; scaled to a sum of 1 when used.
};

/// An instance that stands where its node does.
struct RigInstance {
  int instance = 0;  ///< Index into Scene::instances.
  int node = 0;      ///< Index into Rig::nodes.
  glm::dmat4 node_from_object{1.0};
};

/// A light that can be animated: where it is, and what glTF keeps apart of its numbers.
struct RigLight {
  int light = 0;           ///< Index into Scene::lights.
  int node = -1;           ///< It shines along the node's -Z; -1: it stays where it is.
  glm::vec3 color{1.0f};   ///< At rest; times the intensity it is Light::intensity.
  float intensity = 1.0f;  ///< At rest.
  float range = 0.0f;      ///< At rest [m].
  float inner_cone_angle = 0.0f, outer_cone_angle = 0.785398163f;  ///< At rest [rad].
};

/// A camera that can be animated.
struct RigCamera {
  int camera = 0;                     ///< Index into Scene::cameras.
  int node = -1;                      ///< It looks along the node's -Z; -1: it stays where it is.
  float vertical_fov = 0.785398163f;  ///< At rest [rad].
  float vertical_extent = 1.0f;       ///< At rest: full height [m].
};

/// A material that can be animated.
struct RigMaterial {
  int material = 0;  ///< Index into Scene::materials.
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emissive_factor{0.0f};
  float emissive_strength = 1.0f;  ///< Times the factor it is Material::emission.
};

/// What animations move, and how it hangs together. Refers to the scene's lists by index: who
/// removes entries of these mends the rig, too.
struct Rig {
  std::vector<RigNode> nodes;  ///< Parents before their children.
  std::vector<RigSkin> skins;
  std::vector<RigMesh> meshes;
  std::vector<RigInstance> instances;
  std::vector<RigLight> lights;
  std::vector<RigCamera> cameras;
  std::vector<RigMaterial> materials;
};

/// When the last key of an animation is reached [s]; 0 where it has none.
float duration(const Animation& animation);

/// Poses a scene at a time: sets what the scene's animations drive, and nothing else: transforms of
/// instances, vertices of meshes (and their revision), lights, cameras and numbers of materials. A
/// property that the chosen animation does not drive, but another one does, goes to its rest value.
/// Follow with World::update. `animation` is an index, or -1: all of them at once, later ones
/// first. The scene must be valid. Throws std::bad_alloc where memory runs out.
void animate(Scene& scene, int animation, float time_s);

}  // namespace lambent
