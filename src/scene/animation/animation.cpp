// SPDX-License-Identifier: Apache-2.0
#include "lambent/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>

#include "lambent/scene.h"
#include "scene/animation/deform.h"
#include "scene/animation/pose.h"
#include "scene/limits.h"
#include "shared/constants.h"

namespace lambent {
namespace {

using Target = Channel::Target;

/// The properties of a list of the rig that animations drive: one bit per target.
class Driven {
 public:
  Driven(const std::vector<Animation>& animations, Target first, Target last, std::size_t count)
      : bits_(count, 0) {
    for (const Animation& animation : animations) {
      for (const Channel& channel : animation.channels) {
        if (channel.target >= first && channel.target <= last) {
          bits_[channel.index] |= bit(channel.target);
        }
      }
    }
  }
  bool in(std::size_t index, Target target) const { return (bits_[index] & bit(target)) != 0; }
  bool at_all(std::size_t index) const { return bits_[index] != 0; }

 private:
  static std::uint32_t bit(Target target) { return 1u << static_cast<unsigned>(target); }
  std::vector<std::uint32_t> bits_;
};

glm::vec3 not_negative(const glm::vec3& v) {
  return glm::max(v, glm::vec3(0.0f));
}

/// Poses a scene. The copies of the rig's lists hold the current values in place of those at rest.
class Pose {
 public:
  explicit Pose(Scene& scene) : scene_(scene), rig_(scene.rig) {
    nodes_ = rig_.nodes;
    lights_ = rig_.lights;
    cameras_ = rig_.cameras;
    materials_ = rig_.materials;
  }

  void apply(const Animation& animation, float time_s) {
    for (const Channel& channel : animation.channels) apply(channel, time_s);
  }

  void set() {
    find_moving_nodes();
    bend_meshes();
    place_instances();
    set_lights();
    set_cameras();
    set_materials();
  }

 private:
  void apply(const Channel& channel, float time_s) {
    std::vector<float> value(static_cast<std::size_t>(channel.curve.components));
    evaluate(channel.curve, time_s, channel.target == Target::node_rotation, value.data());
    // Splines may overflow between finite keys
    if (!std::all_of(value.begin(), value.end(), [](float v) { return std::isfinite(v); })) return;
    const auto i = static_cast<std::size_t>(channel.index);
    const auto vec3 = [&value] { return glm::vec3(value[0], value[1], value[2]); };
    switch (channel.target) {
      case Target::node_translation:
        nodes_[i].translation = vec3();
        break;
      case Target::node_rotation:
        nodes_[i].rotation = glm::quat(value[3], value[0], value[1], value[2]);
        break;
      case Target::node_scale:
        nodes_[i].scale = vec3();
        break;
      case Target::node_weights:
        nodes_[i].weights = std::move(value);
        break;
      case Target::light_color:
        lights_[i].color = not_negative(vec3());
        break;
      case Target::light_intensity:
        lights_[i].intensity = std::max(value[0], 0.0f);
        break;
      case Target::light_range:
        lights_[i].range = std::max(value[0], 0.0f);
        break;
      case Target::light_inner_cone_angle:
        lights_[i].inner_cone_angle = value[0];
        break;
      case Target::light_outer_cone_angle:
        lights_[i].outer_cone_angle = value[0];
        break;
      case Target::material_base_color:
        materials_[i].base_color = glm::clamp(glm::vec4(vec3(), value[3]), 0.0f, 1.0f);
        break;
      case Target::material_metallic:
        materials_[i].metallic = glm::clamp(value[0], 0.0f, 1.0f);
        break;
      case Target::material_roughness:
        materials_[i].roughness = glm::clamp(value[0], 0.0f, 1.0f);
        break;
      case Target::material_emissive_factor:
        materials_[i].emissive_factor = not_negative(vec3());
        break;
      case Target::material_emissive_strength:
        materials_[i].emissive_strength = std::max(value[0], 0.0f);
        break;
      case Target::camera_vertical_fov:
        cameras_[i].vertical_fov = glm::clamp(value[0], kMinFov, kMaxFov);
        break;
      case Target::camera_vertical_extent:
        cameras_[i].vertical_extent = glm::clamp(2.0f * value[0], kMinViewExtent, kMaxViewExtent);
        break;
    }
  }

  /// Finds the nodes that some animation moves, directly or through a parent, and all nodes'
  /// transforms.
  void find_moving_nodes() {
    const Driven driven(scene_.animations, Target::node_translation, Target::node_scale,
                        nodes_.size());
    moving_.assign(nodes_.size(), 0);
    world_from_node_.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const RigNode& node = nodes_[i];
      const glm::dvec3 translation(node.translation), scale(node.scale);
      const std::array<double, 4> rotation = {node.rotation.x, node.rotation.y, node.rotation.z,
                                              node.rotation.w};
      world_from_node_[i] = node.parent_from_node != glm::dmat4(1.0)
                                ? node.parent_from_node
                                : compose_transform(&translation.x, rotation.data(), &scale.x);
      moving_[i] = driven.at_all(i);
      if (node.parent < 0) continue;
      world_from_node_[i] = world_from_node_[node.parent] * world_from_node_[i];
      moving_[i] = moving_[i] | moving_[node.parent];
    }
  }

  glm::mat4 world_from_node(int node) const { return glm::mat4(world_from_node_[node]); }

  void place_instances() {
    std::vector<std::optional<Bounds>> bounds(scene_.meshes.size());
    for (const RigInstance& placed : rig_.instances) {
      if (moving_[placed.node] == 0) continue;
      Instance& instance = scene_.instances[placed.instance];
      std::optional<Bounds>& mesh = bounds[instance.mesh];
      if (!mesh) mesh = mesh_bounds(scene_.meshes[instance.mesh]);
      const glm::mat4 world_from_object(world_from_node_[placed.node] * placed.node_from_object);
      instance.world_from_object = drawable_or_speck(world_from_object, *mesh);
    }
  }

  void bend_meshes() {
    if (rig_.meshes.empty()) return;
    std::unordered_map<int, std::vector<int>> instances_of;
    for (const RigMesh& mesh : rig_.meshes) instances_of[mesh.mesh];
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const auto bent = instances_of.find(scene_.instances[i].mesh);
      if (bent != instances_of.end()) bent->second.push_back(static_cast<int>(i));
    }
    for (const RigMesh& mesh : rig_.meshes) {
      std::vector<glm::mat4> world_from_bind;
      if (mesh.skin >= 0) {
        const RigSkin& skin = rig_.skins[mesh.skin];
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
          world_from_bind.emplace_back(world_from_node_[skin.joints[j]] * skin.joint_from_bind[j]);
        }
      }
      deform_mesh(scene_, mesh, nodes_[mesh.node].weights, world_from_bind,
                  instances_of[mesh.mesh]);
    }
  }

  void set_lights() {
    const Driven driven(scene_.animations, Target::light_color, Target::light_outer_cone_angle,
                        lights_.size());
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const RigLight& now = lights_[i];
      Light& light = scene_.lights[now.light];
      if (now.node >= 0 && moving_[now.node] != 0) place(light, world_from_node(now.node));
      if (driven.in(i, Target::light_color) || driven.in(i, Target::light_intensity)) {
        light.intensity =
            limited(glm::dvec3(now.color) * static_cast<double>(now.intensity),
                    light.type == Light::Type::directional ? kMaxIrradiance : kMaxIntensity);
      }
      if (driven.in(i, Target::light_range)) light.range = now.range;
      if (driven.in(i, Target::light_inner_cone_angle) ||
          driven.in(i, Target::light_outer_cone_angle)) {
        light.outer_cone_angle = glm::clamp(now.outer_cone_angle, 0.0f, 0.5f * kPi);
        light.inner_cone_angle = glm::clamp(now.inner_cone_angle, 0.0f, light.outer_cone_angle);
      }
    }
  }

  void set_cameras() {
    const Driven driven(scene_.animations, Target::camera_vertical_fov,
                        Target::camera_vertical_extent, cameras_.size());
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const RigCamera& now = cameras_[i];
      Camera& camera = scene_.cameras[now.camera];
      if (now.node >= 0 && moving_[now.node] != 0) place(camera, world_from_node(now.node));
      if (driven.in(i, Target::camera_vertical_fov)) camera.vertical_fov = now.vertical_fov;
      if (driven.in(i, Target::camera_vertical_extent)) {
        camera.vertical_extent = now.vertical_extent;
      }
    }
  }

  void set_materials() {
    const Driven driven(scene_.animations, Target::material_base_color,
                        Target::material_emissive_strength, materials_.size());
    for (std::size_t i = 0; i < materials_.size(); ++i) {
      const RigMaterial& now = materials_[i];
      Material& material = scene_.materials[now.material];
      if (driven.in(i, Target::material_base_color)) material.base_color = now.base_color;
      if (driven.in(i, Target::material_metallic)) material.metallic = now.metallic;
      if (driven.in(i, Target::material_roughness)) material.roughness = now.roughness;
      if (driven.in(i, Target::material_emissive_factor) ||
          driven.in(i, Target::material_emissive_strength)) {
        material.emission =
            limited(glm::dvec3(now.emissive_factor) * static_cast<double>(now.emissive_strength),
                    kMaxRadiance);
      }
    }
  }

  Scene& scene_;
  const Rig& rig_;
  std::vector<RigNode> nodes_;
  std::vector<RigLight> lights_;
  std::vector<RigCamera> cameras_;
  std::vector<RigMaterial> materials_;
  std::vector<std::uint8_t> moving_;  // by node
  std::vector<glm::dmat4> world_from_node_;
};

}  // namespace

void animate(Scene& scene, int animation, float time_s) {
  if (scene.animations.empty()) return;
  Pose pose(scene);
  const std::span<const Animation> all(scene.animations);
  for (const Animation& playing :
       animation < 0 ? all : all.subspan(static_cast<std::size_t>(animation), 1)) {
    pose.apply(playing, time_s);
  }
  pose.set();
}

void rest(Scene& scene) {
  if (!scene.animations.empty()) Pose(scene).set();
}

}  // namespace lambent
