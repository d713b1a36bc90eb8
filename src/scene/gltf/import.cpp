// SPDX-License-Identifier: Apache-2.0
// Converts a checked glTF document to a Scene.
#include "scene/gltf/import.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <new>
#include <optional>

#include "core/files/file_bytes.h"
#include "scene/animation/pose.h"
#include "scene/gltf/animations.h"
#include "scene/gltf/document/accessors.h"
#include "scene/gltf/fog.h"
#include "scene/gltf/lights_cameras.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/meshes.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/rounding.h"
#include "scene/gltf/textures.h"
#include "scene/gltf/volumes.h"
#include "scene/limits.h"
#include "scene/texture.h"

namespace lambent {
namespace gltf {
namespace {

// More than in any renderable scene; a small file can contain more by nested instancing.
constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

class Importer {
 public:
  Importer(Document& document, const LoadOptions& options)
      : document_(document), options_(options) {}

  Expected<Scene> run() {
    TextureLibrary textures(document_);
    LAMBENT_TRY(materials, import_materials(document_, options_, textures));
    scene_.materials = std::move(materials);
    scene_.textures = textures.decode(scene_.materials);
    LAMBENT_TRY(tree, build_node_tree(document_, options_.scene));
    LAMBENT_CHECK(import_nodes_near_origin(tree));
    if (tree.scene >= 0) scene_.environment.radiance = document_.scene_skies[tree.scene];
    drop_unused_default_material();
    motion_->finish(scene_);
    scene_.source.origin = tree.origin;
    describe_source();
    LAMBENT_CHECK(validate(scene_));
    return std::move(scene_);
  }

 private:
  // Imports the contents of nodes. If they are far from the origin, they are imported again
  // relative to an origin near their centre, from the file's numbers, whose last bits would
  // otherwise be lost.
  Expected<void> import_nodes_near_origin(NodeTree& tree) {
    const std::vector<std::string> warnings = document_.warnings;
    const std::vector<Repair> repairs = document_.repairs;
    LAMBENT_CHECK(import_nodes(tree));
    if (!is_rounded(scene_)) return {};
    move_origin(tree, origin_of(world_bounds(scene_)));
    recentre_ = true;
    scene_.meshes.clear();
    scene_.instances.clear();
    scene_.lights.clear();
    scene_.cameras.clear();
    scene_.volumes.clear();
    scene_.fog.clear();
    document_.warnings = warnings;
    document_.repairs = repairs;
    return import_nodes(tree);
  }

  Expected<void> import_nodes(const NodeTree& tree) {
    meshes_.assign(document_.model.meshes.size(), std::nullopt);
    centres_.clear();
    bounds_.clear();
    motion_.emplace(document_, tree);
    for (const int node : tree.visible) LAMBENT_CHECK(import_node(tree, node));
    return {};
  }

  Expected<void> import_node(const NodeTree& tree, int index) {
    const tinygltf::Node& node = document_.model.nodes[index];
    const glm::mat4 world_from_node(tree.world_from_node[index]);
    if (node.camera >= 0) {
      LAMBENT_TRY(camera, import_camera(document_, index, world_from_node));
      motion_->add_camera(index, static_cast<int>(scene_.cameras.size()));
      scene_.cameras.push_back(std::move(camera));
    }
    if (const auto* light = find_extension(node.extensions, "KHR_lights_punctual")) {
      const int source = integer_or(*light, "light", 0);
      LAMBENT_TRY(imported, import_light(document_, source, index, world_from_node));
      motion_->add_light(index, source, static_cast<int>(scene_.lights.size()));
      scene_.lights.push_back(std::move(imported));
    }
    place_volume(document_, index, world_from_node, scene_);
    place_fog(document_, index, world_from_node, scene_);
    if (node.mesh < 0) return {};
    LAMBENT_TRY(joint_from_bind, read_skin(node.skin));
    const Deformation deformation = deformation_of(tree, node, joint_from_bind);
    const bool bends = motion_->bends(index);
    LAMBENT_TRY(meshes, bends ? import_bending_mesh(index, deformation, joint_from_bind)
                              : shared_mesh(node.mesh, deformation));
    // Joints place a skinned mesh in the world; its node does not (specification, sec. 3.7.3.3)
    if (!deformation.joint_matrices.empty()) {
      return add_instances(meshes, index, glm::dmat4(1.0), glm::dmat4(1.0), bends);
    }
    if (const auto* instancing = find_extension(node.extensions, "EXT_mesh_gpu_instancing")) {
      return add_gpu_instances(meshes, index, *instancing, tree.world_from_node[index]);
    }
    return add_instances(meshes, index, tree.world_from_node[index], glm::dmat4(1.0),
                         bends || motion_->moves(index));
  }

  // The bind pose of a skin's joints; empty if there is no skin.
  Expected<std::vector<glm::dmat4>> read_skin(int index) {
    std::vector<glm::dmat4> joint_from_bind;
    if (index < 0) return joint_from_bind;
    const tinygltf::Skin& skin = document_.model.skins[index];
    if (skin.joints.empty()) {
      return document_.fail_at(entry("skins", index), "the skin has no joints");
    }
    joint_from_bind.assign(skin.joints.size(), glm::dmat4(1.0));
    if (skin.inverseBindMatrices < 0) return joint_from_bind;
    LAMBENT_TRY(matrices, read_elements(document_, skin.inverseBindMatrices, 16));
    if (matrices.size() < skin.joints.size()) {
      return document_.fail_at(entry("accessors", skin.inverseBindMatrices),
                               "has fewer matrices than the skin has joints");
    }
    for (std::size_t i = 0; i < joint_from_bind.size(); ++i) {
      for (int k = 0; k < 16; ++k) joint_from_bind[i][k / 4][k % 4] = matrices[i][k];
    }
    return joint_from_bind;
  }

  // The default morph weights and the rest pose.
  Deformation deformation_of(const NodeTree& tree, const tinygltf::Node& node,
                             const std::vector<glm::dmat4>& joint_from_bind) {
    Deformation deformation;
    const auto& defaults = document_.model.meshes[node.mesh].weights;
    bool moved = false;
    for (const double weight : node.weights.empty() ? defaults : node.weights) {
      deformation.morph_weights.push_back(static_cast<float>(weight));
      moved = moved || weight != 0.0;
    }
    if (!moved) deformation.morph_weights.clear();
    for (std::size_t i = 0; i < joint_from_bind.size(); ++i) {
      const int joint = document_.model.skins[node.skin].joints[i];
      deformation.joint_matrices.push_back(tree.world_from_node[joint] * joint_from_bind[i]);
    }
    return deformation;
  }

  // Imports meshes for this node alone, with the rig that deforms them.
  Expected<std::vector<int>> import_bending_mesh(int node, const Deformation& deformation,
                                                 const std::vector<glm::dmat4>& joint_from_bind) {
    std::vector<RigMesh> rigs;
    LAMBENT_TRY(meshes, import_mesh(document_.model.nodes[node].mesh, deformation, &rigs));
    for (RigMesh& rig : rigs) {
      const glm::dvec3 centre = centres_[rig.mesh];
      motion_->add_mesh(node, std::move(rig), joint_from_bind, centre);
    }
    return std::move(meshes);
  }

  // The scene's meshes for a glTF mesh; imported once, unless it is deformed.
  Expected<std::vector<int>> shared_mesh(int mesh, const Deformation& deformation) {
    if (!deformation.empty()) return import_mesh(mesh, deformation, nullptr);
    std::optional<std::vector<int>>& shared = meshes_[mesh];
    if (!shared) {
      LAMBENT_TRY(imported, import_mesh(mesh, deformation, nullptr));
      shared = std::move(imported);
    }
    return *shared;
  }

  Expected<std::vector<int>> import_mesh(int mesh, const Deformation& deformation,
                                         std::vector<RigMesh>* rigs) {
    std::vector<int> made;
    const auto& primitives = document_.model.meshes[mesh].primitives;
    for (int i = 0; i < static_cast<int>(primitives.size()); ++i) {
      const int default_material = static_cast<int>(scene_.materials.size()) - 1;
      const int material = primitives[i].material >= 0 ? primitives[i].material : default_material;
      const TextureView& base_map = scene_.materials[material].normal_texture;
      const TextureView& normal_map =
          base_map.texture >= 0 ? base_map : scene_.materials[material].clearcoat_normal_texture;
      const int tangent_uv_set = normal_map.texture >= 0 ? normal_map.uv_set : -1;
      RigMesh rig;
      LAMBENT_TRY(imported, import_primitive(document_, mesh, i, deformation, recentre_,
                                             tangent_uv_set, rigs != nullptr ? &rig : nullptr));
      if (!imported) continue;
      imported->mesh.material = material;
      warn_of_missing_uvs(imported->mesh, entry("meshes", mesh) + "." + entry("primitives", i));
      made.push_back(static_cast<int>(scene_.meshes.size()));
      rig.mesh = made.back();
      if (rigs != nullptr) rigs->push_back(std::move(rig));
      scene_.meshes.push_back(std::move(imported->mesh));
      centres_.push_back(imported->centre);
    }
    return made;
  }

  void warn_of_missing_uvs(const Mesh& mesh, const std::string& place) {
    const Material& m = scene_.materials[mesh.material];
    for (const TextureView* view : texture_views(m)) {
      if (view->texture < 0 || !mesh.uvs[view->uv_set].empty()) continue;
      document_.repaired("textured primitives lack texture coordinates and read (0, 0)", 1, place);
      return;
    }
  }

  // Places meshes at `world_from_node` * `node_from_object`. `dynamic`: they are expected to move.
  Expected<void> add_instances(const std::vector<int>& meshes, int node,
                               const glm::dmat4& world_from_node,
                               const glm::dmat4& node_from_object, bool dynamic) {
    const glm::mat4 unmoved(world_from_node * node_from_object);
    const std::string place = entry("nodes", node);
    if (largest_scale(unmoved) > kMaxScale) {
      return document_.fail_at(place, "the mesh is scaled by more than 1e10");
    }
    // A skinned mesh is in world space already, where joints have placed its vertices
    const bool skinned = document_.model.nodes[node].skin >= 0;
    const auto node_from_mesh = [&](int mesh) {
      return skinned ? node_from_object : glm::translate(node_from_object, centres_[mesh]);
    };
    for (const int mesh : meshes) {
      const glm::mat4 world_from_mesh(world_from_node * node_from_mesh(mesh));
      if (stays_in_reach(world_from_mesh, bounds_of(mesh))) continue;
      return document_.fail_at(place, "the mesh reaches beyond 1e9 m from the origin");
    }
    if (!drawable(unmoved) && !motion_->moves(node)) {
      document_.repaired("instances scaled to a line or a point were left out", meshes.size(),
                         place);
      return {};
    }
    if (scene_.instances.size() + meshes.size() > kMaxInstances) {
      return document_.fail_at(
          place, "the scene has more than " + std::to_string(kMaxInstances) + " instances");
    }
    const NodeFlags& flags = document_.node_flags[node];
    for (const int mesh : meshes) {
      const glm::dmat4 node_from_object_here = node_from_mesh(mesh);
      if (!skinned) {
        const int instance = static_cast<int>(scene_.instances.size());
        motion_->add_instance(node, instance, node_from_object_here);
      }
      Instance instance;
      instance.name = document_.model.nodes[node].name;
      instance.mesh = mesh;
      const glm::mat4 world_from_object(world_from_node * node_from_object_here);
      instance.world_from_object = drawable_or_speck(world_from_object, bounds_of(mesh));
      instance.casts_gi = flags.casts_gi;
      instance.receives_gi = flags.receives_gi;
      instance.ignored_by_probes = flags.ignored_by_probes;
      instance.dynamic = dynamic;
      scene_.instances.push_back(std::move(instance));
    }
    return {};
  }

  // EXT_mesh_gpu_instancing: translation, rotation and scale of each instance, relative to the
  // node.
  Expected<void> add_gpu_instances(const std::vector<int>& meshes, int node,
                                   const tinygltf::Value& instancing,
                                   const glm::dmat4& world_from_node) {
    const tinygltf::Value& attributes = instancing.Get("attributes");
    struct Attribute {
      const char* name;
      int components;
      Elements elements;
    };
    Attribute read[] = {{"TRANSLATION", 3, {}}, {"ROTATION", 4, {}}, {"SCALE", 3, {}}};
    // Custom attributes, which are not read, determine the number of instances, too
    std::size_t count = 0;
    for (const std::string& name : attributes.Keys()) {
      const int accessor = attributes.Get(name).GetNumberAsInt();
      const std::size_t instances = document_.model.accessors[accessor].count;
      if (count != 0 && instances != count) {
        return document_.fail_at(entry("nodes", node) + ".extensions.EXT_mesh_gpu_instancing",
                                 "the attributes have different counts");
      }
      count = instances;
    }
    for (Attribute& attribute : read) {
      if (!attributes.Has(attribute.name)) continue;
      const int accessor = attributes.Get(attribute.name).GetNumberAsInt();
      LAMBENT_TRY(elements, read_elements(document_, accessor, attribute.components));
      attribute.elements = std::move(elements);
    }
    for (std::size_t i = 0; i < count; ++i) {
      double values[3][4] = {};
      const double* given[3] = {};
      for (int a = 0; a < 3; ++a) {
        if (read[a].elements.size() == 0) continue;
        for (int k = 0; k < read[a].components; ++k) values[a][k] = read[a].elements[i][k];
        given[a] = values[a];
      }
      LAMBENT_CHECK(add_instances(meshes, node, world_from_node,
                                  compose_transform(given[0], given[1], given[2]),
                                  motion_->moves(node) || motion_->bends(node)));
    }
    return {};
  }

  // Bounds of a mesh of the scene, computed once.
  const Bounds& bounds_of(int mesh) {
    while (bounds_.size() < scene_.meshes.size()) {
      bounds_.push_back(mesh_bounds(scene_.meshes[bounds_.size()]));
    }
    return bounds_[mesh];
  }

  void drop_unused_default_material() {
    const int fallback = static_cast<int>(scene_.materials.size()) - 1;
    for (const Mesh& mesh : scene_.meshes) {
      if (mesh.material == fallback) return;
    }
    scene_.materials.pop_back();
  }

  void describe_source() {
    const tinygltf::Model& model = document_.model;
    SceneSource& source = scene_.source;
    source.path = document_.file;
    source.generator = model.asset.generator;
    source.extensions = model.extensionsUsed;
    source.nodes = static_cast<int>(model.nodes.size());
    source.animations = static_cast<int>(document_.animations.size());
    source.skins = static_cast<int>(model.skins.size());
    source.scenes = static_cast<int>(model.scenes.size());
    for (const tinygltf::Mesh& mesh : model.meshes) {
      for (const tinygltf::Primitive& primitive : mesh.primitives) {
        source.morph_targets += static_cast<int>(primitive.targets.size());
      }
    }
    if (triangle_count(scene_) == 0) document_.warn("The scene has no triangles.");
    const Bounds bounds = world_bounds(scene_);
    for (const std::string& sentence :
         {warning_of_move(bounds, source.origin), warning_of_size(bounds)}) {
      if (!sentence.empty()) document_.warn(sentence);
    }
    document_.warn_of_repairs();
    source.warnings = std::move(document_.warnings);
  }

  Document& document_;
  const LoadOptions& options_;
  std::vector<std::optional<std::vector<int>>> meshes_;  // by glTF mesh; none: not yet imported
  bool recentre_ = false;            // whether to move vertices far from their mesh's origin
  std::vector<glm::dvec3> centres_;  // by mesh of the scene: see ImportedMesh
  std::vector<Bounds> bounds_;       // by mesh of the scene
  std::optional<MotionImporter> motion_;
  Scene scene_;
};

// Catches the exceptions of libraries.
Expected<Scene> import(ByteSpan bytes, const std::string& file, bool file_access,
                       const LoadOptions& options) {
  try {
    LAMBENT_TRY(document, read_document(bytes, file, file_access));
    return Importer(document, options).run();
  } catch (const std::bad_alloc&) {
    return fail(file, "", "not enough memory to import the scene", Error::Kind::failed);
  } catch (const std::exception& error) {
    return fail(file, "", std::string("the file is malformed: ") + error.what());
  }
}

}  // namespace
}  // namespace gltf

Expected<Scene> load_scene(const std::string& path, const LoadOptions& options) {
  const Expected<std::vector<std::byte>> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes->data());
  return gltf::import({begin, bytes->size()}, path, true, options);
}

Expected<Scene> load_scene_from_memory(std::span<const std::uint8_t> bytes,
                                       const LoadOptions& options) {
  return gltf::import(bytes, "(memory)", false, options);
}

}  // namespace lambent
