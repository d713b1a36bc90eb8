// SPDX-License-Identifier: Apache-2.0
// A scene in a device's memory, as kernels read it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/vulkan/scene_records.h"
#include "scene/light_tree/light_visibility.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/texture.h"

namespace lambent {

class EmissiveTriangles;
class LightTree;

/// An array of records on a device. Only records that differ are written again.
template <class Record>
class DeviceTable {
 public:
  std::uint64_t address() const { return buffer_.address(); }
  std::size_t bytes() const { return buffer_.bytes(); }

  /// Replaces the contents. The device must not be reading them.
  void set(const vulkan::Device& device, std::vector<Record> records, const std::string& name) {
    const std::size_t bytes = records.size() * sizeof(Record);
    if (buffer_.handle() == VK_NULL_HANDLE || bytes > buffer_.bytes()) {
      buffer_ = vulkan::upload(device, records, name);
    } else {
      std::size_t first = 0, last = records.size();
      const auto same = [&](std::size_t i) {
        return i < records_.size() &&
               std::ranges::equal(bytes_of(records_[i]), bytes_of(records[i]));
      };
      while (first < last && same(first)) ++first;
      while (last > first && same(last - 1)) --last;
      vulkan::write(device, std::span<const Record>(records).subspan(first, last - first), buffer_,
                    first);
    }
    records_ = std::move(records);
  }

 private:
  static std::span<const std::byte> bytes_of(const Record& record) {
    return std::as_bytes(std::span(&record, 1));
  }

  std::vector<Record> records_;  // copy of the device's contents
  vulkan::Buffer buffer_;
};

class DeviceScene {
 public:
  /// Uploads a scene and its lights to the device, which must outlive it. Throws std::runtime_error
  /// where memory runs out or the device takes no more textures.
  DeviceScene(const vulkan::Device& device, const Scene& scene, const EmissiveTriangles& emissive,
              const LightTree& lights);

  /// Updates to edits: records are compared; for meshes, textures and the environment's map, their
  /// `revision` and size are. Not to be called while the device works with the scene. Command
  /// buffers recorded before become invalid. Throws as the constructor does.
  void update(const Scene& scene, const EmissiveTriangles& emissive, const LightTree& lights);

  /// Replaces the table of the lights' visibility, under the same conditions.
  void update_light_visibility(const Scene& scene, const LightVisibility& visibility);

  /// The scene's address for kernels. It does not change in updates.
  SceneArray address() const { return {record_.address()}; }
  /// The textures that kernels which read them need bound (Recorder::bind_textures).
  VkDescriptorSet textures() const { return texture_set_.handle(); }
  /// The addresses of a mesh's attributes. Acceleration structures can be built from positions and
  /// triangles (VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR).
  const MeshRecord& mesh(std::size_t index) const { return mesh_records_[index]; }

  /// Number of lights that every point samples.
  std::uint32_t enumerated_lights() const { return enumerated_lights_; }
  /// Number of nodes of the light tree, which holds all others.
  std::uint32_t light_tree_size() const { return tree_size_; }
  bool has_light_tree() const { return tree_size_ > 0; }
  bool has_emitters() const { return emitter_count_ > 0; }
  /// Whether coats sample part of the sky as a light; see bright_sky.h.
  bool has_bright_sky() const { return bright_cells_ > 0; }
  /// Whether some surfaces may be mirrors, see mirrors/mirror_math.h.
  bool has_mirrors() const { return has_mirrors_; }
  const vulkan::Device& device() const { return device_; }
  /// Memory held on the device [bytes].
  std::size_t bytes() const;

 private:
  /// The state of a mesh at its upload. Meshes that were uploaded together share a buffer.
  struct MeshData {
    std::uint32_t revision;
    std::size_t vertices, triangles;
    std::uint32_t attributes;
    std::shared_ptr<vulkan::Buffer> buffer;
    std::size_t offset, bytes;
  };
  struct TextureData {
    std::uint32_t revision;
    vulkan::Texture texture;
  };
  struct SkyData {
    std::uint32_t revision = 0;
    const float* pixels = nullptr;  // compared, never dereferenced: another map, another address
    int width = 0, height = 0;
    bool operator==(const SkyData&) const = default;
  };
  void update_textures(const Scene& scene);
  void update_materials(const Scene& scene);
  void update_meshes(const Scene& scene);
  void update_lights(const EmissiveTriangles& emissive, const LightTree& lights);
  void upload_light_visibility(const LightVisibility& visibility);
  void update_instances(const Scene& scene);
  void update_sky(const Environment& environment);
  void update_record(const Environment& environment);

  const vulkan::Device& device_;
  std::vector<TextureData> texture_data_;
  vulkan::TextureSet texture_set_;
  std::vector<MeshData> mesh_data_;
  std::vector<MeshRecord> mesh_records_;
  std::uint32_t enumerated_lights_ = 0, emitter_count_ = 0, tree_size_ = 0;
  SkyData sky_data_;
  vulkan::Buffer sky_map_, bright_sky_;
  float bright_limit_ = 0.0f, bright_total_ = 0.0f;
  std::uint32_t bright_cells_ = 0;
  bool has_mirrors_ = false;
  DeviceTable<MaterialRecord> materials_;
  DeviceTable<MeshRecord> meshes_;
  DeviceTable<InstanceRecord> instances_;
  DeviceTable<LightRecord> lights_;
  DeviceTable<EmitterRecord> emitters_;
  DeviceTable<std::uint32_t> asked_;
  DeviceTable<LightTreeNode> light_tree_, light_groups_;
  LightVisibilityGrid visibility_grid_{};
  DeviceTable<std::uint32_t> visibility_rows_, visibility_weights_;
  DeviceTable<SceneRecord> record_;
};

}  // namespace lambent
