// SPDX-License-Identifier: Apache-2.0
// From a checked glTF document to a Scene.
#include "scene/gltf_import.h"

#include <cmath>
#include <new>
#include <optional>

#include "core/file_bytes.h"
#include "scene/gltf_accessors.h"
#include "scene/gltf_lights_cameras.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_meshes.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_textures.h"

namespace lambent {
namespace gltf {
namespace {

// More than any renderable scene; a small file can ask for more by instancing instances.
constexpr std::size_t kMaxInstances = std::size_t{1} << 22;

bool invertible(const glm::mat4& m) {
  const glm::mat4 inverse = glm::inverse(m);
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(inverse[i / 4][i % 4])) return false;
  }
  return true;
}

class Importer {
 public:
  Importer(Document& document, const LoadOptions& options)
      : document_(document), options_(options), meshes_(document.model.meshes.size()) {}

  Expected<Scene> run() {
    TextureLibrary textures(document_);
    LAMBENT_TRY(materials, import_materials(document_, options_, textures));
    scene_.materials = std::move(materials);
    LAMBENT_TRY(tree, build_node_tree(document_, options_.scene));
    for (const int node : tree.visible) LAMBENT_CHECK(import_node(tree, node));
    if (tree.scene >= 0) scene_.environment.radiance = document_.scene_skies[tree.scene];
    drop_unused_default_material();
    LAMBENT_TRY(decoded, textures.decode());
    scene_.textures = std::move(decoded);
    describe_source();
    LAMBENT_CHECK(validate(scene_));
    return std::move(scene_);
  }

 private:
  Expected<void> import_node(const NodeTree& tree, int index) {
    const tinygltf::Node& node = document_.model.nodes[index];
    const glm::mat4& world_from_node = tree.world_from_node[index];
    if (node.camera >= 0) {
      LAMBENT_TRY(camera, import_camera(document_, index, world_from_node));
      scene_.cameras.push_back(std::move(camera));
    }
    if (const auto* light = find_extension(node.extensions, "KHR_lights_punctual")) {
      LAMBENT_TRY(imported,
                  import_light(document_, integer_or(*light, "light", 0), index, world_from_node));
      scene_.lights.push_back(std::move(imported));
    }
    if (node.mesh < 0) return {};
    LAMBENT_TRY(deformation, deformation_of(tree, node));
    // Joints place a skinned mesh in the world; its node does not (specification, sec. 3.7.3.3)
    if (!deformation.joint_matrices.empty()) {
      LAMBENT_TRY(bent, import_mesh(node.mesh, deformation));
      return add_instances(bent, index, glm::mat4(1.0f));
    }
    LAMBENT_TRY(meshes, shared_mesh(node.mesh, deformation));
    if (const auto* instancing = find_extension(node.extensions, "EXT_mesh_gpu_instancing")) {
      return add_gpu_instances(meshes, index, *instancing, world_from_node);
    }
    return add_instances(meshes, index, world_from_node);
  }

  // The default morph weights and the rest pose.
  Expected<Deformation> deformation_of(const NodeTree& tree, const tinygltf::Node& node) {
    Deformation deformation;
    const auto& defaults = document_.model.meshes[node.mesh].weights;
    bool moved = false;
    for (const double weight : node.weights.empty() ? defaults : node.weights) {
      deformation.morph_weights.push_back(static_cast<float>(weight));
      moved = moved || weight != 0.0;
    }
    if (!moved) deformation.morph_weights.clear();
    if (node.skin < 0) return deformation;

    const tinygltf::Skin& skin = document_.model.skins[node.skin];
    if (skin.joints.empty()) {
      return document_.fail_at(entry("skins", node.skin), "the skin has no joints");
    }
    Elements bind;
    if (skin.inverseBindMatrices >= 0) {
      LAMBENT_TRY(matrices, read_elements(document_, skin.inverseBindMatrices, 16));
      if (matrices.size() < skin.joints.size()) {
        return document_.fail_at(entry("accessors", skin.inverseBindMatrices),
                                 "has fewer matrices than the skin has joints");
      }
      bind = std::move(matrices);
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      glm::mat4 joint_from_bind(1.0f);
      for (int k = 0; bind.size() != 0 && k < 16; ++k) joint_from_bind[k / 4][k % 4] = bind[i][k];
      deformation.joint_matrices.push_back(tree.world_from_node[skin.joints[i]] * joint_from_bind);
    }
    return deformation;
  }

  // The scene's meshes for a glTF mesh; made once unless it is bent.
  Expected<std::vector<int>> shared_mesh(int mesh, const Deformation& deformation) {
    if (!deformation.empty()) return import_mesh(mesh, deformation);
    std::optional<std::vector<int>>& shared = meshes_[mesh];
    if (!shared) {
      LAMBENT_TRY(imported, import_mesh(mesh, deformation));
      shared = std::move(imported);
    }
    return *shared;
  }

  Expected<std::vector<int>> import_mesh(int mesh, const Deformation& deformation) {
    std::vector<int> made;
    const auto& primitives = document_.model.meshes[mesh].primitives;
    for (int i = 0; i < static_cast<int>(primitives.size()); ++i) {
      const int default_material = static_cast<int>(scene_.materials.size()) - 1;
      const int material = primitives[i].material >= 0 ? primitives[i].material : default_material;
      const TextureView& normal_map = scene_.materials[material].normal_texture;
      const int tangent_uv_set = normal_map.texture >= 0 ? normal_map.uv_set : -1;
      LAMBENT_TRY(imported, import_primitive(document_, mesh, i, deformation, tangent_uv_set));
      if (!imported) continue;
      imported->material = material;
      warn_of_missing_uvs(*imported, entry("meshes", mesh) + "." + entry("primitives", i));
      made.push_back(static_cast<int>(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(*imported));
    }
    return made;
  }

  void warn_of_missing_uvs(const Mesh& mesh, const std::string& place) {
    const Material& m = scene_.materials[mesh.material];
    for (const TextureView* view :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
          &m.emission_texture, &m.specular_texture, &m.specular_color_texture}) {
      if (view->texture < 0 || !mesh.uvs[view->uv_set].empty()) continue;
      document_.repaired("textured primitives lack texture coordinates and read (0, 0)", 1, place);
      return;
    }
  }

  Expected<void> add_instances(const std::vector<int>& meshes, int node,
                               const glm::mat4& world_from_object) {
    if (!invertible(world_from_object)) {
      document_.repaired("instances flattened to nothing were left out", meshes.size(),
                         entry("nodes", node));
      return {};
    }
    if (scene_.instances.size() + meshes.size() > kMaxInstances) {
      return document_.fail_at(
          entry("nodes", node),
          "the scene has more than " + std::to_string(kMaxInstances) + " instances");
    }
    for (const int mesh : meshes) {
      scene_.instances.push_back({document_.model.nodes[node].name, mesh, world_from_object});
    }
    return {};
  }

  // EXT_mesh_gpu_instancing: translation, rotation and scale of each instance, relative to the
  // node.
  Expected<void> add_gpu_instances(const std::vector<int>& meshes, int node,
                                   const tinygltf::Value& instancing,
                                   const glm::mat4& world_from_node) {
    const tinygltf::Value& attributes = instancing.Get("attributes");
    struct Attribute {
      const char* name;
      int components;
      Elements elements;
    };
    Attribute read[] = {{"TRANSLATION", 3, {}}, {"ROTATION", 4, {}}, {"SCALE", 3, {}}};
    // Custom attributes, which mean nothing to us, count instances too
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
      const glm::mat4 node_from_instance(compose_transform(given[0], given[1], given[2]));
      LAMBENT_CHECK(add_instances(meshes, node, world_from_node * node_from_instance));
    }
    return {};
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
    source.animations = static_cast<int>(model.animations.size());
    source.skins = static_cast<int>(model.skins.size());
    source.scenes = static_cast<int>(model.scenes.size());
    for (const tinygltf::Mesh& mesh : model.meshes) {
      for (const tinygltf::Primitive& primitive : mesh.primitives) {
        source.morph_targets += static_cast<int>(primitive.targets.size());
      }
    }
    if (source.animations > 0) {
      document_.warn("Animations are not evaluated; the scene stands in its rest pose.");
    }
    if (triangle_count(scene_) == 0) document_.warn("The scene has no triangles.");
    document_.warn_of_repairs();
    source.warnings = std::move(document_.warnings);
  }

  Document& document_;
  const LoadOptions& options_;
  std::vector<std::optional<std::vector<int>>> meshes_;  // by glTF mesh; none: not yet imported
  Scene scene_;
};

// The boundary behind which libraries may throw.
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
