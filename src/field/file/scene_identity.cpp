// SPDX-License-Identifier: Apache-2.0
#include "field/file/scene_identity.h"

#include <glm/gtc/type_ptr.hpp>
#include <span>
#include <vector>

#include "core/checksum.h"
#include "core/little_endian.h"
#include "scene/texture.h"
#include "scene/transmission.h"

namespace lambent {
namespace {

// Texture levels with more texels than this along an edge are left out: gigabytes of them would
// take seconds, and an edit that is visible in the light changes the smaller levels, too.
constexpr int kMaxTextureEdge = 64;

/// A checksum of a sequence of numbers.
class Checksum {
 public:
  std::uint32_t value() {
    flush();
    return crc_;
  }
  void add(std::uint32_t value) { bytes_.u32(value); }
  void add(int value) { bytes_.i32(value); }
  void add(bool value) { bytes_.u32(value ? 1u : 0u); }
  void add(float value) { bytes_.f32(value); }
  template <int n>
  void add(const glm::vec<n, float>& value) {
    bytes_.f32s({glm::value_ptr(value), n});
  }
  void add(const glm::mat4& value) { bytes_.f32s({glm::value_ptr(value), 16}); }
  /// Adds the number of elements and each element.
  template <class Element>
  void add_all(const std::vector<Element>& elements) {
    add(static_cast<std::uint32_t>(elements.size()));
    for (const Element& element : elements) add(element);
    flush();
  }
  void add(const glm::uvec3& value) { bytes_.u32s({glm::value_ptr(value), 3}); }
  void add_raw(std::span<const std::uint8_t> bytes) { bytes_.raw(std::as_bytes(bytes)); }

 private:
  // Limits the size of the buffer: meshes and maps may be large
  void flush() {
    crc_ = crc32_of(bytes_.bytes(), crc_);
    bytes_.clear();
  }

  ByteWriter bytes_;
  std::uint32_t crc_ = 0;
};

void add_view(const TextureView& view, Checksum& sum) {
  sum.add(view.texture);
  if (view.texture < 0) return;
  sum.add(view.uv_set);
  sum.add(static_cast<std::uint32_t>(view.wrap_u));
  sum.add(static_cast<std::uint32_t>(view.wrap_v));
  sum.add(view.nearest);
  sum.add(view.uv_offset);
  sum.add(view.uv_rotation);
  sum.add(view.uv_scale);
}

void add_material(const Material& material, Checksum& sum) {
  sum.add(material.base_color);
  sum.add(material.metallic);
  sum.add(material.roughness);
  sum.add(material.emission);
  sum.add(material.normal_scale);
  sum.add(material.ior);
  sum.add(material.specular);
  sum.add(material.specular_color);
  sum.add(material.transmission);
  sum.add(material.bounds_volume);
  sum.add(material.absorption);
  sum.add(static_cast<std::uint32_t>(material.alpha_mode));
  sum.add(material.alpha_cutoff);
  sum.add(material.double_sided);
  sum.add(material.unlit);
  sum.add(material.lambert);
  // The checksum of a scene without layers or films must be the same as before these existed
  const bool layered = has_layers(material);
  if (layered) {
    sum.add(material.clearcoat);
    sum.add(material.clearcoat_roughness);
    sum.add(material.clearcoat_normal_scale);
    sum.add(material.sheen_color);
    sum.add(material.sheen_roughness);
  }
  const bool filmed = has_film(material);
  if (filmed) {
    sum.add(material.iridescence);
    sum.add(material.iridescence_ior);
    sum.add(material.iridescence_thickness_min);
    sum.add(material.iridescence_thickness_max);
  }
  for (const TextureView* view : texture_views(material)) {
    if (!layered && is_of_layers(material, view)) continue;
    if (!filmed && is_of_film(material, view)) continue;
    add_view(*view, sum);
  }
}

void add_texture(const Texture& texture, Checksum& sum) {
  sum.add(texture.srgb);
  sum.add(texture.levels.front().width);
  sum.add(texture.levels.front().height);
  for (const TextureLevel& level : texture.levels) {
    if (level.width > kMaxTextureEdge || level.height > kMaxTextureEdge) continue;
    sum.add_raw(level.rgba);
  }
}

void add_light(const Light& light, Checksum& sum) {
  sum.add(static_cast<std::uint32_t>(light.type));
  sum.add(light.intensity);
  sum.add(light.position_ws);
  sum.add(light.direction_ws);
  sum.add(light.range);
  sum.add(light.inner_cone_angle);
  sum.add(light.outer_cone_angle);
}

/// Adds the vertices and triangles of a mesh.
void add_shape(const Mesh& mesh, Checksum& sum) {
  sum.add_all(mesh.positions);
  sum.add_all(mesh.triangles);
}

/// Returns for each mesh whether a static instance uses it.
std::vector<bool> still_meshes(const Scene& scene) {
  std::vector<bool> still(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) {
    if (!instance.dynamic) still[instance.mesh] = true;
  }
  return still;
}

std::uint32_t geometry_of(const Scene& scene, const std::vector<bool>& still) {
  Checksum sum;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (still[m]) add_shape(scene.meshes[m], sum);
  }
  for (const Instance& instance : scene.instances) {
    sum.add(instance.mesh);
    sum.add(instance.dynamic);
    if (!instance.dynamic) sum.add(instance.world_from_object);
  }
  return sum.value();
}

std::uint32_t light_of_scene(const Scene& scene, const std::vector<bool>& still,
                             const FieldSettings& settings) {
  Checksum sum;
  sum.add(settings.max_bounces);
  sum.add(settings.max_albedo);
  for (const Light& light : scene.lights) add_light(light, sum);
  for (const Material& material : scene.materials) add_material(material, sum);
  for (const Texture& texture : scene.textures) add_texture(texture, sum);
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    sum.add(mesh.material);
    for (const std::vector<glm::vec2>& uvs : mesh.uvs) sum.add_all(uvs);
    sum.add_all(mesh.colors);
    if (still[m]) continue;
    add_shape(mesh, sum);
  }
  for (const Instance& instance : scene.instances) {
    sum.add(instance.casts_gi);
    sum.add(instance.ignored_by_probes);
    if (instance.dynamic) sum.add(instance.world_from_object);
  }
  sum.add(scene.environment.radiance);
  sum.add(scene.environment.rotation);
  sum.add(scene.environment.map.width);
  sum.add_all(scene.environment.map.pixels);
  return sum.value();
}

}  // namespace

SceneIdentity identify(const Scene& scene, const FieldSettings& settings) {
  SceneIdentity identity;
  identity.triangles = triangle_count(scene);
  for (const Mesh& mesh : scene.meshes) identity.vertices += mesh.positions.size();
  identity.instances = static_cast<std::uint32_t>(scene.instances.size());
  const std::vector<bool> still = still_meshes(scene);
  identity.geometry = geometry_of(scene, still);
  identity.light = light_of_scene(scene, still, settings);
  return identity;
}

}  // namespace lambent
