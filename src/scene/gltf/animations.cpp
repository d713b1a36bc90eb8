// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, sec. 3.11 "Animations", and the README of
// KHR_animation_pointer.
#include "scene/gltf/animations.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <span>
#include <utility>

#include "scene/gltf/document/accessors.h"
#include "scene/gltf/lights_cameras.h"
#include "scene/validate.h"

namespace lambent::gltf {
namespace {

using Target = Channel::Target;
constexpr const char* kLights = "/extensions/KHR_lights_punctual/lights/";

/// The index after `prefix`, and the rest of the pointer, if it starts with the prefix.
struct Match {
  std::size_t index;
  std::string rest;
};
std::optional<Match> match(const std::string& pointer, const char* prefix) {
  if (!pointer.starts_with(prefix)) return std::nullopt;
  const char* first = pointer.data() + std::strlen(prefix);
  const char* last = pointer.data() + pointer.size();
  Match found{};
  const auto [stop, error] = std::from_chars(first, last, found.index);
  if (error != std::errc()) return std::nullopt;
  found.rest.assign(stop, last);
  return found;
}

/// A property that can be driven, and its number of components; 0: the number of morph targets.
struct Property {
  const char* name;
  Target target;
  int components;
};
constexpr Property kNodeProperties[] = {{"/translation", Target::node_translation, 3},
                                        {"/rotation", Target::node_rotation, 4},
                                        {"/scale", Target::node_scale, 3},
                                        {"/weights", Target::node_weights, 0}};
constexpr Property kMeshProperties[] = {{"/weights", Target::node_weights, 0}};
constexpr Property kLightProperties[] = {
    {"/color", Target::light_color, 3},
    {"/intensity", Target::light_intensity, 1},
    {"/range", Target::light_range, 1},
    {"/spot/innerConeAngle", Target::light_inner_cone_angle, 1},
    {"/spot/outerConeAngle", Target::light_outer_cone_angle, 1}};
constexpr Property kMaterialProperties[] = {
    {"/pbrMetallicRoughness/baseColorFactor", Target::material_base_color, 4},
    {"/pbrMetallicRoughness/metallicFactor", Target::material_metallic, 1},
    {"/pbrMetallicRoughness/roughnessFactor", Target::material_roughness, 1},
    {"/emissiveFactor", Target::material_emissive_factor, 3},
    {"/extensions/KHR_materials_emissive_strength/emissiveStrength",
     Target::material_emissive_strength, 1}};
constexpr Property kCameraProperties[] = {
    {"/perspective/yfov", Target::camera_vertical_fov, 1},
    {"/orthographic/ymag", Target::camera_vertical_extent, 1}};

}  // namespace

MotionImporter::MotionImporter(Document& document, const NodeTree& tree)
    : document_(document),
      tree_(tree),
      rig_node_of_(tree.order.size()),
      weighted_(tree.order.size(), false),
      rig_skin_of_(document.model.skins.size(), -1) {
  for (std::size_t i = 0; i < tree.order.size(); ++i) {
    rig_node_of_[tree.order[i]] = static_cast<int>(i) + (is_moved() ? 1 : 0);
  }
  for (std::size_t a = 0; a < document.animations.size(); ++a) {
    for (const ChannelSource& source : document.animations[a].channels) read(a, source);
  }
  mark_moving();
}

int MotionImporter::weights_of(int mesh) const {
  const auto& primitives = document_.model.meshes[mesh].primitives;
  return primitives.empty() ? 0 : static_cast<int>(primitives.front().targets.size());
}

void MotionImporter::read(std::size_t animation, const ChannelSource& source) {
  const tinygltf::Model& model = document_.model;
  const auto drop = [&](const std::string& why) { document_.drop_channel(source.place, why); };
  struct Table {
    const char* prefix;
    List list;
    std::size_t size;
    std::span<const Property> properties;
  };
  const Table tables[] = {
      {"/nodes/", List::nodes, model.nodes.size(), kNodeProperties},
      {"/meshes/", List::meshes, model.meshes.size(), kMeshProperties},
      {"/materials/", List::materials, model.materials.size(), kMaterialProperties},
      {kLights, List::lights, model.lights.size(), kLightProperties},
      {"/cameras/", List::cameras, model.cameras.size(), kCameraProperties},
  };
  for (const Table& table : tables) {
    const std::optional<Match> found = match(source.pointer, table.prefix);
    if (!found) continue;
    if (found->index >= table.size) return drop("their target does not exist");
    for (const Property& property : table.properties) {
      if (found->rest != property.name) continue;
      Driver driver{animation, table.list, static_cast<int>(found->index), {}};
      driver.channel.target = property.target;
      driver.channel.curve.components = property.components;
      if (const char* flaw = read_curve(source, driver)) return drop(flaw);
      drivers_.push_back(std::move(driver));
      return;
    }
  }
  drop("what they drive is not supported");
}

/// Reads keys. Returns null, or a description of the error.
const char* MotionImporter::read_curve(const ChannelSource& source, Driver& driver) const {
  Curve& curve = driver.channel.curve;
  if (driver.list == List::nodes && curve.components > 0 &&
      !document_.model.nodes[driver.index].matrix.empty()) {
    return "their node has a matrix";
  }
  if (curve.components == 0) {
    const int mesh =
        driver.list == List::meshes ? driver.index : document_.model.nodes[driver.index].mesh;
    curve.components = mesh < 0 ? 0 : weights_of(mesh);
    if (curve.components == 0) return "their mesh has no morph targets";
  }
  Expected<Elements> times = read_elements(document_, source.input);
  Expected<Elements> values = read_elements(document_, source.output);
  if (!times || !values) return "their keys are out of reach or not finite";
  const bool weights = driver.channel.target == Target::node_weights;
  if (times->components != 1 || values->components != (weights ? 1 : curve.components)) {
    return "their keys have the wrong number of components";
  }
  curve.interpolation = source.interpolation;
  curve.times = std::move(times->values);
  curve.values = std::move(values->values);
  if (flaw_of(curve) == nullptr) return nullptr;
  const bool ascending = std::adjacent_find(curve.times.begin(), curve.times.end(),
                                            std::greater_equal<>()) == curve.times.end();
  return ascending ? "they have not one value a key" : "their times do not ascend";
}

void MotionImporter::mark_moving() {
  moves_.assign(tree_.order.size(), false);
  for (const Driver& driver : drivers_) {
    if (driver.list == List::nodes && driver.channel.target != Target::node_weights) {
      moves_[driver.index] = true;
    }
    if (driver.channel.target != Target::node_weights) continue;
    if (driver.list == List::nodes) weighted_[driver.index] = true;
    for (std::size_t i = 0; driver.list == List::meshes && i < weighted_.size(); ++i) {
      const tinygltf::Node& node = document_.model.nodes[i];
      if (node.mesh == driver.index && node.weights.empty()) weighted_[i] = true;
    }
  }
  for (const int node : tree_.order) {
    const int parent = tree_.parents[node];
    if (parent >= 0 && moves_[parent]) moves_[node] = true;
  }
}

bool MotionImporter::bends(int node) const {
  const int skin = document_.model.nodes[node].skin;
  if (weighted_[node] || skin < 0) return weighted_[node];
  const auto& joints = document_.model.skins[skin].joints;
  return std::any_of(joints.begin(), joints.end(), [this](int joint) { return moves(joint); });
}

bool MotionImporter::is_driven(List list, int index) const {
  return std::any_of(drivers_.begin(), drivers_.end(), [&](const Driver& driver) {
    return driver.list == list && driver.index == index;
  });
}

void MotionImporter::add_instance(int node, int instance, const glm::dmat4& node_from_object) {
  if (moves(node)) rig_.instances.push_back({instance, rig_node_of_[node], node_from_object});
}

void MotionImporter::add_light(int node, int source, int light) {
  if (!moves(node) && !is_driven(List::lights, source)) return;
  const tinygltf::Light& from = document_.model.lights[source];
  RigLight rigged;
  rigged.light = light;
  rigged.node = rig_node_of_[node];
  rigged.color = glm::max(vec3_of(from.color, glm::vec3(1.0f)), glm::vec3(0.0f));
  rigged.intensity = static_cast<float>(from.intensity);
  rigged.range = static_cast<float>(from.range);
  rigged.inner_cone_angle = static_cast<float>(from.spot.innerConeAngle);
  rigged.outer_cone_angle = static_cast<float>(from.spot.outerConeAngle);
  rig_.lights.push_back(rigged);
  light_sources_.push_back(source);
}

void MotionImporter::add_camera(int node, int camera) {
  const int source = document_.model.nodes[node].camera;
  if (!moves(node) && !is_driven(List::cameras, source)) return;
  const tinygltf::Camera& from = document_.model.cameras[source];
  RigCamera rigged;
  rigged.camera = camera;
  rigged.node = rig_node_of_[node];
  rigged.vertical_fov = vertical_fov_of(from);
  rigged.vertical_extent = static_cast<float>(2.0 * std::abs(from.orthographic.ymag));
  rig_.cameras.push_back(rigged);
  camera_sources_.push_back(source);
}

int MotionImporter::rig_skin(int skin, const std::vector<glm::dmat4>& joint_from_bind,
                             const glm::dvec3& centre) {
  // A mesh whose vertices were recentred needs a skin with a bind pose of its own
  const bool shared = centre == glm::dvec3(0.0);
  if (shared && rig_skin_of_[skin] >= 0) return rig_skin_of_[skin];
  const int index = static_cast<int>(rig_.skins.size());
  RigSkin& made = rig_.skins.emplace_back();
  for (const int joint : document_.model.skins[skin].joints) {
    made.joints.push_back(rig_node_of_[joint]);
  }
  for (const glm::dmat4& matrix : joint_from_bind) {
    made.joint_from_bind.push_back(glm::translate(matrix, centre));
  }
  if (shared) rig_skin_of_[skin] = index;
  return index;
}

void MotionImporter::add_mesh(int node, RigMesh mesh,
                              const std::vector<glm::dmat4>& joint_from_bind,
                              const glm::dvec3& centre) {
  const int skin = document_.model.nodes[node].skin;
  mesh.node = rig_node_of_[node];
  if (skin >= 0) mesh.skin = rig_skin(skin, joint_from_bind, centre);
  rig_.meshes.push_back(std::move(mesh));
}

void MotionImporter::add_nodes() {
  // Add a root node that transforms the file's coordinates to the scene's
  if (is_moved()) rig_.nodes.emplace_back().translation = -tree_.origin;
  for (const int index : tree_.order) {
    const tinygltf::Node& from = document_.model.nodes[index];
    RigNode node;
    if (tree_.parents[index] >= 0) {
      node.parent = rig_node_of_[tree_.parents[index]];
    } else if (is_moved()) {
      node.parent = 0;
    }
    if (from.translation.size() == 3) node.translation = glm::make_vec3(from.translation.data());
    node.scale = vec3_of(from.scale, glm::vec3(1.0f));
    if (from.rotation.size() == 4) {
      const glm::dquat q(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]);
      if (glm::length(q) > 0.0) node.rotation = glm::quat(glm::normalize(q));
    }
    if (from.matrix.size() == 16) {
      for (int i = 0; i < 16; ++i) {
        const bool last_row = i % 4 == 3;
        node.parent_from_node[i / 4][i % 4] = last_row ? (i == 15 ? 1.0 : 0.0) : from.matrix[i];
      }
    }
    const std::vector<double>& weights = from.weights.empty() && from.mesh >= 0
                                             ? document_.model.meshes[from.mesh].weights
                                             : from.weights;
    node.weights.assign(weights.begin(), weights.end());
    rig_.nodes.push_back(std::move(node));
  }
}

void MotionImporter::add_materials(const Scene& scene) {
  for (int i = 0; i < static_cast<int>(document_.model.materials.size()); ++i) {
    if (!is_driven(List::materials, i)) continue;
    const tinygltf::Material& from = document_.model.materials[i];
    RigMaterial material;
    material.material = i;
    material.base_color = scene.materials[i].base_color;
    material.metallic = scene.materials[i].metallic;
    material.roughness = scene.materials[i].roughness;
    material.emissive_factor = glm::max(vec3_of(from.emissiveFactor, glm::vec3(0.0f)), 0.0f);
    if (const auto* e = find_extension(from.extensions, "KHR_materials_emissive_strength")) {
      material.emissive_strength = static_cast<float>(number_or(*e, "emissiveStrength", 1.0));
    }
    rig_.materials.push_back(material);
  }
}

/// Adds a channel for each object of the scene that was made from the driven object of the file.
void MotionImporter::add_channel(const Driver& driver, Animation& animation) const {
  const auto add = [&](std::size_t index) {
    animation.channels.push_back(driver.channel);
    animation.channels.back().index = static_cast<int>(index);
  };
  const auto add_where = [&](const std::vector<int>& sources) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (sources[i] == driver.index) add(i);
    }
  };
  switch (driver.list) {
    case List::nodes:
      add(rig_node_of_[driver.index]);
      break;
    case List::meshes:
      for (std::size_t node = 0; node < document_.model.nodes.size(); ++node) {
        const tinygltf::Node& shown = document_.model.nodes[node];
        if (shown.mesh == driver.index && shown.weights.empty()) add(rig_node_of_[node]);
      }
      break;
    case List::materials:
      for (std::size_t i = 0; i < rig_.materials.size(); ++i) {
        if (rig_.materials[i].material == driver.index) add(i);
      }
      break;
    case List::lights:
      add_where(light_sources_);
      break;
    case List::cameras:
      add_where(camera_sources_);
      break;
  }
}

void MotionImporter::finish(Scene& scene) {
  if (drivers_.empty()) return;
  add_nodes();
  add_materials(scene);
  for (const AnimationSource& source : document_.animations) {
    scene.animations.push_back({source.name, {}});
  }
  for (const Driver& driver : drivers_) add_channel(driver, scene.animations[driver.animation]);
  scene.rig = std::move(rig_);
}

}  // namespace lambent::gltf
