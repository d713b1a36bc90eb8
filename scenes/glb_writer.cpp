// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, and the extensions KHR_lights_punctual,
// KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume, _unlit and
// KHR_texture_transform.
#include "scenes/glb_writer.h"

#include <cstdint>
#include <future>
#include <glm/gtc/type_ptr.hpp>
#include <set>

#include "core/files/atomic_file.h"
#include "scenes/glb_container.h"
#include "scenes/png_encoder.h"

namespace lambent::scenes {
namespace {

using nlohmann::json;

// Numbers of the glTF and glb specifications.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kNearest = 9728, kLinear = 9729, kNearestMipmapLinear = 9986,
              kLinearMipmapLinear = 9987;
constexpr int kRepeat = 10497, kMirroredRepeat = 33648, kClampToEdge = 33071;
constexpr std::size_t kMaxShortIndex = 65534;
constexpr float kDefaultIor = 1.5f;
// glTF requires clipping planes; nothing here reads them [m].
constexpr float kNear = 0.01f, kFar = 1000.0f;

template <class V>
json array(const V& v) {
  json list = json::array();
  for (int i = 0; i < V::length(); ++i) list.push_back(v[i]);
  return list;
}

json array(const glm::quat& q) {
  return json::array({q.x, q.y, q.z, q.w});
}

class Document {
 public:
  Document(const Scene& scene, const Animations& animations)
      : scene_(scene), animations_(animations) {}

  std::string encode() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "lambent make-scene"}};
    write_textures();
    for (const Material& material : scene_.materials) write_material(material);
    for (const Mesh& mesh : scene_.meshes) write_mesh(mesh);
    write_nodes();
    for (const Animation& animation : animations_) write_animation(animation);
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    return glb_.assemble();
  }

 private:
  json& use(json& object, const char* extension) {
    extensions_.insert(extension);
    return object["extensions"][extension];
  }

  int add_positions(const std::vector<glm::vec3>& positions) {
    const int index = glb_.add_vectors(positions, "VEC3", kArrayBuffer);
    Bounds bounds;
    for (const glm::vec3& p : positions) bounds.add(p);
    root_["accessors"][index]["min"] = array(bounds.min);
    root_["accessors"][index]["max"] = array(bounds.max);
    return index;
  }

  int add_indices(const Mesh& mesh) {
    const std::size_t count = 3 * mesh.triangles.size();
    json accessor = {{"count", count}, {"type", "SCALAR"}};
    if (mesh.positions.size() > kMaxShortIndex) {
      accessor["componentType"] = kUnsignedInt;
      return glb_.add_accessor(accessor, mesh.triangles.data(), count * 4, kElementArrayBuffer);
    }
    accessor["componentType"] = kUnsignedShort;
    std::vector<std::uint16_t> narrow;
    narrow.reserve(count);
    for (const glm::uvec3& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) narrow.push_back(static_cast<std::uint16_t>(t[k]));
    }
    return glb_.add_accessor(accessor, narrow.data(), count * 2, kElementArrayBuffer);
  }

  void write_textures() {
    std::vector<std::future<std::string>> encoding;
    for (const Texture& texture : scene_.textures) {
      encoding.push_back(std::async([&texture] { return encode_png(texture.levels.front()); }));
    }
    for (std::size_t i = 0; i < encoding.size(); ++i) {
      const std::string png = encoding[i].get();
      const int view = glb_.add_view(png.data(), png.size(), 0);
      root_["images"].push_back(
          {{"name", scene_.textures[i].name}, {"mimeType", "image/png"}, {"bufferView", view}});
    }
  }

  static int wrap_code(Wrap wrap) {
    if (wrap == Wrap::repeat) return kRepeat;
    return wrap == Wrap::mirrored_repeat ? kMirroredRepeat : kClampToEdge;
  }

  /// The index of an object in a list of the root; the object is added if it is missing.
  int index_in(const char* list, const json& object) {
    json& objects = root_[list];
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (objects[i] == object) return static_cast<int>(i);
    }
    objects.push_back(object);
    return static_cast<int>(objects.size()) - 1;
  }

  json texture_info(const TextureView& view) {
    const json sampler = {{"wrapS", wrap_code(view.wrap_u)},
                          {"wrapT", wrap_code(view.wrap_v)},
                          {"magFilter", view.nearest ? kNearest : kLinear},
                          {"minFilter", view.nearest ? kNearestMipmapLinear : kLinearMipmapLinear}};
    const json texture = {{"sampler", index_in("samplers", sampler)}, {"source", view.texture}};
    json info = {{"index", index_in("textures", texture)}};
    if (view.uv_set != 0) info["texCoord"] = view.uv_set;
    if (view.uv_offset != glm::vec2(0.0f) || view.uv_rotation != 0.0f ||
        view.uv_scale != glm::vec2(1.0f)) {
      use(info, "KHR_texture_transform") = {{"offset", array(view.uv_offset)},
                                            {"rotation", view.uv_rotation},
                                            {"scale", array(view.uv_scale)}};
    }
    return info;
  }

  void write_texture(json& object, const char* name, const TextureView& view) {
    if (view.texture >= 0) object[name] = texture_info(view);
  }

  void write_material(const Material& m) {
    const bool metal_left = !m.lambert;
    const glm::vec3 color = glm::vec3(m.base_color) * (metal_left ? 1.0f : 1.0f - m.metallic);
    json out = {{"name", m.name}};
    json& pbr = out["pbrMetallicRoughness"];
    pbr = {{"baseColorFactor", array(glm::vec4(color, m.base_color.a))},
           {"metallicFactor", metal_left ? m.metallic : 0.0f},
           {"roughnessFactor", m.roughness}};
    write_texture(pbr, "baseColorTexture", m.base_color_texture);
    write_texture(pbr, "metallicRoughnessTexture", m.metallic_roughness_texture);
    write_texture(out, "normalTexture", m.normal_texture);
    if (m.normal_texture.texture >= 0) out["normalTexture"]["scale"] = m.normal_scale;
    write_emission(m, out);
    write_specular(m, out);
    write_transmission(m, out);
    if (m.alpha_mode == AlphaMode::mask) {
      out["alphaMode"] = "MASK";
      out["alphaCutoff"] = m.alpha_cutoff;
    } else if (m.alpha_mode == AlphaMode::blend) {
      out["alphaMode"] = "BLEND";
    }
    if (m.double_sided) out["doubleSided"] = true;
    if (m.unlit) use(out, "KHR_materials_unlit") = json::object();
    root_["materials"].push_back(std::move(out));
  }

  /// glTF's factor is at most 1, so brighter emission is written as its strength.
  void write_emission(const Material& m, json& out) {
    const float brightest = glm::max(m.emission.x, glm::max(m.emission.y, m.emission.z));
    if (brightest <= 0.0f) return;
    const float strength = glm::max(brightest, 1.0f);
    out["emissiveFactor"] = array(m.emission / strength);
    if (strength > 1.0f) {
      use(out, "KHR_materials_emissive_strength") = {{"emissiveStrength", strength}};
    }
    write_texture(out, "emissiveTexture", m.emission_texture);
  }

  void write_specular(const Material& m, json& out) {
    if (m.lambert) {
      use(out, "KHR_materials_specular") = {{"specularFactor", 0.0f}};
      return;
    }
    if (m.ior != kDefaultIor) use(out, "KHR_materials_ior") = {{"ior", m.ior}};
    if (m.specular == 1.0f && m.specular_color == glm::vec3(1.0f) &&
        m.specular_texture.texture < 0 && m.specular_color_texture.texture < 0) {
      return;
    }
    json& specular = use(out, "KHR_materials_specular");
    specular = {{"specularFactor", m.specular}, {"specularColorFactor", array(m.specular_color)}};
    write_texture(specular, "specularTexture", m.specular_texture);
    write_texture(specular, "specularColorTexture", m.specular_color_texture);
  }

  void write_transmission(const Material& m, json& out) {
    if (m.lambert || m.transmission <= 0.0f) return;
    json& transmission = use(out, "KHR_materials_transmission");
    transmission = {{"transmissionFactor", m.transmission}};
    write_texture(transmission, "transmissionTexture", m.transmission_texture);
    if (!m.bounds_volume) return;
    // The attenuation colour is the transmittance over one metre; any thickness above 0 declares a
    // volume
    use(out, "KHR_materials_volume") = {{"thicknessFactor", 1.0f},
                                        {"attenuationDistance", 1.0f},
                                        {"attenuationColor", array(glm::exp(-m.absorption))}};
  }

  void write_mesh(const Mesh& mesh) {
    json primitive = {{"material", mesh.material}};
    json& attributes = primitive["attributes"];
    attributes["POSITION"] = add_positions(mesh.positions);
    attributes["NORMAL"] = glb_.add_vectors(mesh.normals, "VEC3", kArrayBuffer);
    const bool mapped = scene_.materials[mesh.material].normal_texture.texture >= 0;
    if (mapped && !mesh.tangents.empty()) {
      attributes["TANGENT"] = glb_.add_vectors(mesh.tangents, "VEC4", kArrayBuffer);
    }
    for (int set = 0; set < 2; ++set) {
      if (mesh.uvs[set].empty()) continue;
      attributes["TEXCOORD_" + std::to_string(set)] =
          glb_.add_vectors(mesh.uvs[set], "VEC2", kArrayBuffer);
    }
    if (!mesh.colors.empty())
      attributes["COLOR_0"] = glb_.add_vectors(mesh.colors, "VEC4", kArrayBuffer);
    primitive["indices"] = add_indices(mesh);
    root_["meshes"].push_back({{"name", mesh.name}, {"primitives", {primitive}}});
  }

  /// The track of an instance or light, or null. Moving nodes must be written as TRS.
  const Track* track_of(Track::Target target, std::size_t index) const {
    for (const Animation& animation : animations_) {
      for (const Track& track : animation.tracks) {
        if (track.target == target && track.index == static_cast<int>(index)) return &track;
      }
    }
    return nullptr;
  }

  int add_node(json node) {
    root_["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(root_["nodes"].size()) - 1;
    roots_.push_back(index);
    return index;
  }

  void write_nodes() {
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      json node = {{"name", instance.name}, {"mesh", instance.mesh}};
      if (const Track* track = track_of(Track::Target::instance, i)) {
        place(node, track->keyframes.front().translation, track->keyframes.front().rotation);
      } else if (instance.world_from_object != glm::mat4(1.0f)) {
        const float* m = glm::value_ptr(instance.world_from_object);
        node["matrix"] = std::vector<float>(m, m + 16);
      }
      if (!instance.casts_gi) node["extras"]["lambent_casts_gi"] = false;
      if (!instance.receives_gi) node["extras"]["lambent_receives_gi"] = false;
      if (instance.ignored_by_probes) node["extras"]["lambent_ignored_by_probes"] = true;
      instance_nodes_.push_back(add_node(std::move(node)));
    }
    for (const Light& light : scene_.lights) light_nodes_.push_back(write_light(light));
    for (const Camera& camera : scene_.cameras) write_camera(camera);
    json scene = {{"nodes", roots_}};
    if (scene_.environment.radiance != glm::vec3(0.0f)) {
      scene["extras"]["lambent_sky_radiance"] = array(scene_.environment.radiance);
    }
    root_["scenes"].push_back(std::move(scene));
    root_["scene"] = 0;
  }

  static void place(json& node, const glm::vec3& translation, const glm::quat& rotation) {
    if (translation != glm::vec3(0.0f)) node["translation"] = array(translation);
    if (rotation != glm::quat(1.0f, 0.0f, 0.0f, 0.0f)) node["rotation"] = array(rotation);
  }

  int write_light(const Light& light) {
    const float strongest =
        glm::max(light.intensity.x, glm::max(light.intensity.y, light.intensity.z));
    const float intensity = strongest > 0.0f ? strongest : 1.0f;
    json out = {{"name", light.name},
                {"intensity", intensity},
                {"color", array(light.intensity / intensity)}};
    if (light.type == Light::Type::directional) out["type"] = "directional";
    if (light.type == Light::Type::point) out["type"] = "point";
    if (light.type == Light::Type::spot) {
      out["type"] = "spot";
      out["spot"] = {{"innerConeAngle", light.inner_cone_angle},
                     {"outerConeAngle", light.outer_cone_angle}};
    }
    if (light.range > 0.0f) out["range"] = light.range;
    json& lights = use(root_, "KHR_lights_punctual")["lights"];
    lights.push_back(std::move(out));

    json node = {{"name", light.name}};
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    const glm::vec3 forward(0.0f, 0.0f, -1.0f);
    const bool directed = light.type != Light::Type::point;
    place(node, light.position_ws,
          directed ? glm::quat(forward, light.direction_ws) : glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
    return add_node(std::move(node));
  }

  void write_camera(const Camera& camera) {
    json out = {{"name", camera.name}};
    if (camera.orthographic) {
      const float half_height = 0.5f * camera.vertical_extent;
      const float aspect = camera.aspect > 0.0f ? camera.aspect : 1.0f;
      out["type"] = "orthographic";
      out["orthographic"] = {
          {"xmag", half_height * aspect}, {"ymag", half_height}, {"znear", 0.0f}, {"zfar", kFar}};
    } else {
      out["type"] = "perspective";
      out["perspective"] = {{"yfov", camera.vertical_fov}, {"znear", kNear}};
      if (camera.aspect > 0.0f) out["perspective"]["aspectRatio"] = camera.aspect;
    }
    root_["cameras"].push_back(std::move(out));
    json node = {{"name", camera.name}, {"camera", root_["cameras"].size() - 1}};
    place(node, glm::vec3(camera.world_from_view[3]),
          glm::quat_cast(glm::mat3(camera.world_from_view)));
    add_node(std::move(node));
  }

  void write_animation(const Animation& animation) {
    json out = {{"name", animation.name}};
    for (const Track& track : animation.tracks) {
      std::vector<float> times;
      std::vector<glm::vec3> translations;
      std::vector<glm::vec4> rotations;
      for (const Keyframe& key : track.keyframes) {
        times.push_back(key.time);
        translations.push_back(key.translation);
        rotations.emplace_back(key.rotation.x, key.rotation.y, key.rotation.z, key.rotation.w);
      }
      const int input = glb_.add_vectors(times, "SCALAR", 0);
      root_["accessors"][input]["min"] = {times.front()};
      root_["accessors"][input]["max"] = {times.back()};
      const bool light = track.target == Track::Target::light;
      const int node = (light ? light_nodes_ : instance_nodes_)[track.index];
      add_channel(out, node, "translation", input, glb_.add_vectors(translations, "VEC3", 0));
      add_channel(out, node, "rotation", input, glb_.add_vectors(rotations, "VEC4", 0));
    }
    root_["animations"].push_back(std::move(out));
  }

  static void add_channel(json& animation, int node, const char* path, int input, int output) {
    animation["samplers"].push_back({{"input", input}, {"output", output}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  const Scene& scene_;
  const Animations& animations_;
  GlbContainer glb_;
  json& root_ = glb_.root;
  std::set<std::string> extensions_;
  std::vector<int> roots_, instance_nodes_, light_nodes_;
};

}  // namespace

Expected<std::string> encode_glb(const Scene& scene, const Animations& animations) {
  if (!scene.environment.map.empty()) {
    return fail("", "environment", "glTF has no place for an environment map");
  }
  for (const Material& material : scene.materials) {
    if (material.lambert && material.metallic_roughness_texture.texture >= 0) {
      return fail("", "material " + material.name,
                  "glTF has no Lambert material with a metallic-roughness texture");
    }
  }
  std::string bytes = Document(scene, animations).encode();
  if (bytes.size() > GlbContainer::kMaxBytes) {
    return fail("", "", "the scene is larger than the 4 GiB that a .glb file can hold");
  }
  return bytes;
}

Expected<std::size_t> write_glb(const Scene& scene, const std::string& path,
                                const Animations& animations) {
  Expected<std::string> bytes = encode_glb(scene, animations);
  if (!bytes) {
    bytes.error().file = path;
    return tl::unexpected(bytes.error());
  }
  if (const Expected<void> written = write_file_atomically(path, std::string_view(*bytes));
      !written) {
    return tl::unexpected(written.error());
  }
  return bytes->size();
}

}  // namespace lambent::scenes
