// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "lambent/scene.h"
#include "scene/validate.h"

namespace lambent {
namespace {

using Target = Channel::Target;

bool within(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}
bool none_or_within(int index, std::size_t count) {
  return index == -1 || within(index, count);
}

bool finite(const std::vector<float>& values) {
  for (const float v : values) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}
bool finite(const glm::dmat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

/// The number of entries of the rig to which a target can refer, and its number of components; 0:
/// any.
struct Shape {
  std::size_t entries;
  int components;
};

Shape shape_of(Target target, const Rig& rig) {
  if (target == Target::node_weights) return {rig.nodes.size(), 0};
  if (target == Target::node_rotation) return {rig.nodes.size(), 4};
  if (target <= Target::node_scale) return {rig.nodes.size(), 3};
  if (target == Target::light_color) return {rig.lights.size(), 3};
  if (target <= Target::light_outer_cone_angle) return {rig.lights.size(), 1};
  if (target == Target::material_base_color) return {rig.materials.size(), 4};
  if (target == Target::material_emissive_factor) return {rig.materials.size(), 3};
  if (target <= Target::material_emissive_strength) return {rig.materials.size(), 1};
  return {rig.cameras.size(), 1};
}

const char* flaw_of(const Channel& channel, const Rig& rig) {
  if (const char* flaw = flaw_of(channel.curve)) return flaw;
  const Shape shape = shape_of(channel.target, rig);
  if (!within(channel.index, shape.entries)) return "drives what does not exist";
  if (shape.components != 0 && channel.curve.components != shape.components) {
    return "has not the number of components that its target has";
  }
  return nullptr;
}

const char* flaw_of(const RigMesh& mesh, const Scene& scene) {
  const Rig& rig = scene.rig;
  if (!within(mesh.mesh, scene.meshes.size())) return "refers to a mesh that does not exist";
  if (!within(mesh.node, rig.nodes.size())) return "refers to a node that does not exist";
  if (!none_or_within(mesh.skin, rig.skins.size())) return "refers to a skin that does not exist";
  const std::size_t vertices = mesh.positions.size();
  const auto fits = [vertices](std::size_t size) { return size == 0 || size == vertices; };
  bool complete = fits(mesh.normals.size()) && fits(mesh.tangents.size());
  for (const RigMesh::MorphTarget& target : mesh.targets) {
    complete = complete && fits(target.positions.size()) && fits(target.normals.size()) &&
               fits(target.tangents.size());
  }
  if (!complete || vertices != scene.meshes[mesh.mesh].positions.size()) {
    return "has not one of each attribute a vertex";
  }
  if (mesh.skin < 0) return nullptr;
  const std::size_t influences = vertices * static_cast<std::size_t>(mesh.influences);
  if (mesh.influences < 1 || mesh.joints.size() != influences ||
      mesh.weights.size() != influences || !finite(mesh.weights)) {
    return "has not the joints and finite weights that it says";
  }
  for (const std::uint32_t joint : mesh.joints) {
    if (joint >= rig.skins[mesh.skin].joints.size()) return "refers to a joint that does not exist";
  }
  return nullptr;
}

const char* flaw_of(const RigSkin& skin, std::size_t nodes) {
  if (skin.joints.empty()) return "has no joints";
  if (skin.joint_from_bind.size() != skin.joints.size()) return "has not one matrix a joint";
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    if (!within(skin.joints[i], nodes)) return "refers to a node that does not exist";
    if (!finite(skin.joint_from_bind[i])) return "has a matrix that is not finite";
  }
  return nullptr;
}

/// Checks each entry of a list of the rig. `flaw` returns the flaw of an entry, or null.
template <class T, class Flaw>
Expected<void> check(const Scene& scene, const char* name, const std::vector<T>& entries,
                     Flaw flaw) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (const char* found = flaw(entries[i], i)) {
      return fail(scene.source.path, std::string(name) + "[" + std::to_string(i) + "]", found);
    }
  }
  return {};
}

}  // namespace

const char* flaw_of(const Curve& curve) {
  const std::size_t keys = curve.times.size();
  if (keys == 0) return "has no keys";
  if (curve.components < 1) return "has no components";
  for (std::size_t k = 0; k < keys; ++k) {
    if (!std::isfinite(curve.times[k])) return "has a time that is not finite";
    if (k > 0 && !(curve.times[k] > curve.times[k - 1])) return "has times that do not ascend";
  }
  const std::size_t a_key = curve.interpolation == Interpolation::cubic ? 3 : 1;
  if (curve.values.size() != keys * a_key * static_cast<std::size_t>(curve.components)) {
    return "has not one value a key";
  }
  return finite(curve.values) ? nullptr : "has a value that is not finite";
}

Expected<void> validate_motion(const Scene& scene) {
  const Rig& rig = scene.rig;
  const std::size_t nodes = rig.nodes.size();
  for (std::size_t a = 0; a < scene.animations.size(); ++a) {
    const std::string name = "animations[" + std::to_string(a) + "].channels";
    Expected<void> fine = check(scene, name.c_str(), scene.animations[a].channels,
                                [&](const Channel& c, std::size_t) { return flaw_of(c, rig); });
    if (!fine) return fine;
  }
  const auto dangling = [](bool fine) -> const char* {
    return fine ? nullptr : "refers to what does not exist";
  };
  Expected<void> fine = check(scene, "rig.nodes", rig.nodes, [](const RigNode& n, std::size_t i) {
    if (!none_or_within(n.parent, i)) return "has a parent that does not stand before it";
    return finite(n.parent_from_node) ? nullptr : "has a transform that is not finite";
  });
  if (!fine) return fine;
  fine = check(scene, "rig.skins", rig.skins,
               [&](const RigSkin& s, std::size_t) { return flaw_of(s, nodes); });
  if (!fine) return fine;
  fine = check(scene, "rig.meshes", rig.meshes,
               [&](const RigMesh& m, std::size_t) { return flaw_of(m, scene); });
  if (!fine) return fine;
  fine = check(scene, "rig.instances", rig.instances, [&](const RigInstance& r, std::size_t) {
    return dangling(within(r.instance, scene.instances.size()) && within(r.node, nodes));
  });
  if (!fine) return fine;
  fine = check(scene, "rig.lights", rig.lights, [&](const RigLight& r, std::size_t) {
    return dangling(within(r.light, scene.lights.size()) && none_or_within(r.node, nodes));
  });
  if (!fine) return fine;
  fine = check(scene, "rig.cameras", rig.cameras, [&](const RigCamera& r, std::size_t) {
    return dangling(within(r.camera, scene.cameras.size()) && none_or_within(r.node, nodes));
  });
  if (!fine) return fine;
  return check(scene, "rig.materials", rig.materials, [&](const RigMaterial& r, std::size_t) {
    return dangling(within(r.material, scene.materials.size()));
  });
}

}  // namespace lambent
