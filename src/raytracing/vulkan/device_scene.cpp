// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/device_scene.h"

#include <algorithm>
#include <cstring>

#include "raytracing/mirrors/find_mirrors.h"
#include "raytracing/vulkan/mesh_layout.h"
#include "scene/attributes.h"
#include "scene/latitude_longitude.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "scene/sky/sky_levels.h"
#include "scene/texture.h"

namespace lambent {
namespace {

TextureViewRecord record_of(const Scene& scene, const TextureView& view) {
  TextureViewRecord record{};
  record.texture = view.texture;
  if (view.texture < 0) return record;
  record.sampling =
      static_cast<uint>(view.wrap_u) | (static_cast<uint>(view.wrap_v) << kSamplingWrapBits) |
      (view.nearest ? kSamplingNearest : 0) | (view.uv_set == 1 ? kSamplingSecondUvs : 0);
  record.uv_scale = view.uv_scale;
  record.uv_rotation = uv_rotation(view);
  record.uv_offset = view.uv_offset;
  const Texture& texture = scene.textures[view.texture];
  record.width = texture.levels.front().width;
  record.height = texture.levels.front().height;
  record.levels = static_cast<int>(texture.levels.size());
  return record;
}

MaterialRecord record_of(const Scene& scene, const Material& m) {
  MaterialRecord record{};
  record.base_color = m.base_color;
  record.emission = m.emission;
  record.metallic = m.metallic;
  record.roughness = m.roughness;
  record.normal_scale = m.normal_scale;
  record.ior = m.ior;
  record.specular = m.specular;
  record.specular_color = m.specular_color;
  record.transmission = m.transmission;
  record.absorption = m.absorption;
  record.alpha_cutoff = m.alpha_cutoff;
  record.alpha_mode = static_cast<uint>(m.alpha_mode);
  record.flags = (m.double_sided ? kMaterialDoubleSided : 0) | (m.unlit ? kMaterialUnlit : 0) |
                 (m.lambert ? kMaterialLambert : 0) | (may_emit(m) ? kMaterialMayEmit : 0) |
                 (m.bounds_volume ? kMaterialBoundsVolume : 0) |
                 (is_transmissive(m) ? kMaterialLetsThrough : 0) |
                 (has_layers(m) ? kMaterialHasLayers : 0) | (has_film(m) ? kMaterialHasFilm : 0);
  record.base_color_texture = record_of(scene, m.base_color_texture);
  record.metallic_roughness_texture = record_of(scene, m.metallic_roughness_texture);
  record.normal_texture = record_of(scene, m.normal_texture);
  record.emission_texture = record_of(scene, m.emission_texture);
  record.specular_texture = record_of(scene, m.specular_texture);
  record.specular_color_texture = record_of(scene, m.specular_color_texture);
  record.transmission_texture = record_of(scene, m.transmission_texture);
  record.clearcoat = m.clearcoat;
  record.clearcoat_roughness = m.clearcoat_roughness;
  record.clearcoat_normal_scale = m.clearcoat_normal_scale;
  record.sheen_roughness = m.sheen_roughness;
  record.sheen_color = m.sheen_color;
  record.clearcoat_texture = record_of(scene, m.clearcoat_texture);
  record.clearcoat_roughness_texture = record_of(scene, m.clearcoat_roughness_texture);
  record.clearcoat_normal_texture = record_of(scene, m.clearcoat_normal_texture);
  record.sheen_color_texture = record_of(scene, m.sheen_color_texture);
  record.sheen_roughness_texture = record_of(scene, m.sheen_roughness_texture);
  record.iridescence = m.iridescence;
  record.iridescence_ior = m.iridescence_ior;
  record.iridescence_thickness_min = m.iridescence_thickness_min;
  record.iridescence_thickness_max = m.iridescence_thickness_max;
  record.iridescence_texture = record_of(scene, m.iridescence_texture);
  record.iridescence_thickness_texture = record_of(scene, m.iridescence_thickness_texture);
  return record;
}

vulkan::Texture upload_texture(const vulkan::Device& device, const Texture& texture) {
  std::vector<vulkan::TexelLevel> levels;
  for (const TextureLevel& level : texture.levels) {
    levels.push_back({static_cast<std::uint32_t>(level.width),
                      static_cast<std::uint32_t>(level.height), level.rgba});
  }
  return {device, levels, texture.srgb, texture.name.empty() ? "texture" : texture.name};
}

}  // namespace

DeviceScene::DeviceScene(const vulkan::Device& device, const Scene& scene,
                         const EmissiveTriangles& emissive, const LightTree& lights)
    : device_(device), texture_set_(device) {
  update(scene, emissive, lights);
}

void DeviceScene::update(const Scene& scene, const EmissiveTriangles& emissive,
                         const LightTree& lights) {
  update_textures(scene);
  update_materials(scene);
  update_meshes(scene);
  update_lights(emissive, lights);
  update_instances(scene);
  update_sky(scene.environment);
  update_record(scene.environment);
}

void DeviceScene::update_textures(const Scene& scene) {
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& texture = scene.textures[i];
    const bool known = i < texture_data_.size();
    if (known && texture_data_[i].revision == texture.revision) continue;
    if (!known) texture_data_.emplace_back();
    texture_data_[i] = {texture.revision, upload_texture(device_, texture)};
    texture_set_.set(static_cast<std::uint32_t>(i), texture_data_[i].texture);
  }
}

void DeviceScene::update_materials(const Scene& scene) {
  std::vector<MaterialRecord> records;
  records.reserve(scene.materials.size());
  for (const Material& material : scene.materials) records.push_back(record_of(scene, material));
  materials_.set(device_, std::move(records), "materials");
  has_mirrors_ = lambent::has_mirrors(scene);
}

void DeviceScene::update_meshes(const Scene& scene) {
  // Overwrite changed meshes whose size is the same, and collect the others for one new buffer
  mesh_data_.resize(scene.meshes.size());
  mesh_records_.resize(scene.meshes.size());
  std::vector<std::size_t> placed;
  std::size_t fresh_bytes = 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    MeshData& data = mesh_data_[i];
    const std::uint32_t attributes = attributes_of(mesh);
    const bool fits = data.buffer != nullptr && data.vertices == mesh.positions.size() &&
                      data.triangles == mesh.triangles.size() && data.attributes == attributes;
    if (fits && data.revision == mesh.revision) {
      mesh_records_[i].material = static_cast<uint>(mesh.material);
      continue;
    }
    const std::size_t bytes = bytes_of(mesh);
    if (fits) {
      std::vector<std::byte> content(bytes);
      write_mesh(mesh, content);
      vulkan::write(device_, std::span<const std::byte>(content), *data.buffer, data.offset);
      data.revision = mesh.revision;
      mesh_records_[i].material = static_cast<uint>(mesh.material);
      continue;
    }
    data = {mesh.revision,
            mesh.positions.size(),
            mesh.triangles.size(),
            attributes,
            nullptr,
            fresh_bytes,
            bytes};
    fresh_bytes += bytes;
    placed.push_back(i);
  }

  // Upload the new ones together, as devices allow few allocations
  if (!placed.empty()) {
    std::vector<std::byte> content(fresh_bytes);
    for (const std::size_t i : placed) {
      const MeshData& data = mesh_data_[i];
      write_mesh(scene.meshes[i], std::span(content).subspan(data.offset, data.bytes));
    }
    const auto buffer = std::make_shared<vulkan::Buffer>(
        vulkan::upload(device_, content, "meshes",
                       VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR));
    for (const std::size_t i : placed) {
      mesh_data_[i].buffer = buffer;
      mesh_records_[i] = record_of(scene.meshes[i], buffer->address() + mesh_data_[i].offset);
    }
  }
  meshes_.set(device_, mesh_records_, "mesh records");
}

void DeviceScene::update_lights(const EmissiveTriangles& emissive, const LightTree& lights) {
  emitter_count_ = static_cast<std::uint32_t>(emissive.size());
  enumerated_lights_ = static_cast<std::uint32_t>(lights.asked().size());
  tree_size_ = static_cast<std::uint32_t>(lights.nodes().size());
  emitters_.set(device_, emissive.entries(), "emitters");
  lights_.set(device_, lights.lights(), "lights");
  asked_.set(device_, lights.asked(), "lights asked");
  light_tree_.set(device_, lights.nodes(), "light tree");
  light_groups_.set(device_, lights.groups().nodes(), "light groups");
  upload_light_visibility(lights.visibility());
}

void DeviceScene::update_light_visibility(const Scene& scene, const LightVisibility& visibility) {
  upload_light_visibility(visibility);
  update_record(scene.environment);
}

void DeviceScene::upload_light_visibility(const LightVisibility& visibility) {
  visibility_grid_ = visibility.grid();
  visibility_rows_.set(device_, visibility.rows(), "rows of visibility");
  std::vector<std::uint32_t> weights(visibility.weights().size() / sizeof(std::uint32_t));
  if (!weights.empty()) {
    std::memcpy(weights.data(), visibility.weights().data(), visibility.weights().size());
  }
  visibility_weights_.set(device_, std::move(weights), "visibility of lights");
}

void DeviceScene::update_instances(const Scene& scene) {
  std::vector<InstanceRecord> records;
  records.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    const uint flags = (instance.receives_gi ? kInstanceReceivesGi : 0) |
                       (instance.casts_gi ? kInstanceCastsGi : 0);
    records.push_back({instance.world_from_object, static_cast<uint>(instance.mesh), flags});
  }
  instances_.set(device_, std::move(records), "instances");
}

void DeviceScene::update_sky(const Environment& environment) {
  const Image& map = environment.map;
  const SkyData now = map.empty()
                          ? SkyData{}
                          : SkyData{environment.revision, map.pixels.data(), map.width, map.height};
  if (sky_map_.handle() != VK_NULL_HANDLE && now == sky_data_) return;
  std::vector<glm::vec3> texels;
  const SkyLevels sky(environment);
  const int levels = map.empty() ? 0 : map_level_count(map.height);
  const auto append = [&](const Image& level) {
    for (std::size_t i = 0; i < level.pixels.size(); i += 3) {
      texels.emplace_back(level.pixels[i], level.pixels[i + 1], level.pixels[i + 2]);
    }
  };
  for (int k = 0; k < levels; ++k) append(sky.level(k));
  for (int k = 1; k < levels && sky.has_bright_part(); ++k) append(sky.dim_level(k));
  sky_map_ = vulkan::upload(device_, texels, "sky");
  bright_sky_ = vulkan::upload(device_, sky.bright_cells(), "bright part of the sky");
  bright_limit_ = sky.bright_limit();
  bright_total_ = sky.bright_total();
  bright_cells_ = static_cast<std::uint32_t>(sky.bright_cells().size());
  sky_data_ = now;
}

void DeviceScene::update_record(const Environment& environment) {
  SceneRecord record{};
  record.instances.address = instances_.address();
  record.meshes.address = meshes_.address();
  record.materials.address = materials_.address();
  record.lights.address = lights_.address();
  record.asked.address = asked_.address();
  record.emitters.address = emitters_.address();
  record.light_tree.address = light_tree_.address();
  record.light_groups.address = light_groups_.address();
  record.visibility_rows.address = visibility_rows_.address();
  record.visibility_weights.address = visibility_weights_.address();
  record.visibility_grid = visibility_grid_;
  record.environment.map.texels.address = sky_map_.address();
  record.asked_count = enumerated_lights_;
  record.emitter_count = emitter_count_;
  record.light_tree_size = tree_size_;
  record.environment.radiance = environment.radiance;
  record.environment.rotation = environment.rotation;
  record.environment.map.width = sky_data_.width;
  record.environment.map.height = sky_data_.height;
  record.environment.bright_cells.address = bright_sky_.address();
  record.environment.bright_limit = bright_limit_;
  record.environment.bright_total = bright_total_;
  record.environment.bright_cell_count = bright_cells_;
  record_.set(device_, {record}, "scene");
}

std::size_t DeviceScene::bytes() const {
  std::size_t sum = sky_map_.bytes() + bright_sky_.bytes() + materials_.bytes() + meshes_.bytes() +
                    instances_.bytes() + lights_.bytes() + emitters_.bytes() + asked_.bytes() +
                    light_tree_.bytes() + light_groups_.bytes() + visibility_rows_.bytes() +
                    visibility_weights_.bytes() + record_.bytes();
  for (const MeshData& data : mesh_data_) sum += data.bytes;
  for (const TextureData& data : texture_data_) sum += data.texture.bytes();
  return sum;
}

}  // namespace lambent
