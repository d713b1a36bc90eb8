// SPDX-License-Identifier: Apache-2.0
// Layout: a magic text, a version, then the members of Scene in the order of `fields` below, all in
// words of 4 bytes, little-endian; lists and texts after their length in 8 bytes. One list of
// members serves reading and writing.
#include "scene/prepared.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/files/atomic_file.h"
#include "core/files/file_bytes.h"
#include "core/little_endian.h"
#include "scene/texture.h"

namespace lambent {
namespace {

constexpr std::string_view kMagic = "lambent prepared";
constexpr std::uint32_t kVersion = 6;

template <class T>
using Word = std::integral_constant<bool, std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0>;

class Writer {
 public:
  template <class T>
  using Of = const T;

  void text(const std::string& value) {
    bytes_.u64(value.size());
    bytes_.raw(std::as_bytes(std::span(value)));
  }
  template <class T>
  void number(const T& value) {
    static_assert(Word<T>::value);
    words(&value, 1);
  }
  void flag(bool value) { bytes_.u32(value ? 1 : 0); }
  template <class E>
  void choice(E value, E /*last*/) {
    bytes_.u32(static_cast<std::uint32_t>(value));
  }
  template <class T>
  void numbers(const std::vector<T>& values) {
    bytes_.u64(values.size());
    if constexpr (sizeof(T) == 1) {
      bytes_.raw(std::as_bytes(std::span(values)));
    } else {
      words(values.data(), values.size());
    }
  }
  template <class T>
  void list(const char*, const std::vector<T>& values) {
    bytes_.u64(values.size());
    for (const T& value : values) fields(*this, value);
  }

  void header() {
    bytes_.raw(std::as_bytes(std::span(kMagic)));
    bytes_.u32(kVersion);
  }
  std::span<const std::byte> bytes() const { return bytes_.bytes(); }

 private:
  template <class T>
  void words(const T* values, std::size_t count) {
    static_assert(Word<T>::value);
    bytes_.u32s({reinterpret_cast<const std::uint32_t*>(values), count * (sizeof(T) / 4)});
  }

  ByteWriter bytes_;
};

/// After the first error it reads nothing more, and it stores that error.
class Reader {
 public:
  template <class T>
  using Of = T;

  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  void text(std::string& value) {
    std::vector<char> characters;
    numbers(characters);
    value.assign(characters.begin(), characters.end());
  }
  template <class T>
  void number(T& value) {
    if (has(1, sizeof(T))) words(&value, 1);
  }
  void flag(bool& value) {
    std::uint32_t word = 0;
    number(word);
    if (word > 1) fail_with("a flag is neither 0 nor 1");
    value = word == 1;
  }
  template <class E>
  void choice(E& value, E last) {
    std::uint32_t word = 0;
    number(word);
    if (word > static_cast<std::uint32_t>(last)) {
      fail_with("a choice is not among those that there are");
      return;
    }
    value = static_cast<E>(word);
  }
  template <class T>
  void numbers(std::vector<T>& values) {
    std::uint64_t count = 0;
    length(count);
    if (!has(count, sizeof(T))) return;
    values.resize(count);
    if constexpr (sizeof(T) == 1) {
      for (T& value : values) value = static_cast<T>(bytes_.u8());
    } else {
      words(values.data(), values.size());
    }
  }
  template <class T>
  void list(const char* name, std::vector<T>& values) {
    std::uint64_t count = 0;
    length(count);
    // Grow the list as entries are read, so that a corrupt count costs no memory
    for (std::uint64_t i = 0; i < count && cause_ == nullptr; ++i) {
      place_ = std::string(name) + "[" + std::to_string(i) + "]";
      fields(*this, values.emplace_back());
    }
    if (cause_ == nullptr) place_.clear();
  }

  void header() {
    std::string magic(kMagic.size(), '\0');
    if (has(magic.size(), 1)) {
      for (char& character : magic) character = static_cast<char>(bytes_.u8());
    }
    if (magic != kMagic) return fail_with("is not a prepared scene of Lambent");
    std::uint32_t version = 0;
    number(version);
    if (version != kVersion) fail_with("is of another version of Lambent: prepare the scene again");
  }
  void end() {
    if (bytes_.left() != 0) fail_with("goes on after its end");
  }

  const char* cause() const { return cause_; }
  const std::string& place() const { return place_; }

 private:
  bool has(std::uint64_t count, std::size_t size) {
    if (cause_ == nullptr && count > bytes_.left() / size) fail_with("ends too early");
    return cause_ == nullptr;
  }
  void length(std::uint64_t& count) {
    if (has(1, sizeof(count))) count = bytes_.u64();
  }
  void fail_with(const char* cause) {
    if (cause_ == nullptr) cause_ = cause;
  }
  template <class T>
  void words(T* values, std::size_t count) {
    static_assert(Word<T>::value);
    bytes_.u32s({reinterpret_cast<std::uint32_t*>(values), count * (sizeof(T) / 4)});
  }

  ByteReader bytes_;
  const char* cause_ = nullptr;
  std::string place_;
};

// Members of each struct. `File::Of` is const for a writer.

template <class File>
void fields(File& file, typename File::template Of<TextureLevel>& level) {
  file.number(level.width);
  file.number(level.height);
  file.numbers(level.rgba);
}

template <class File>
void fields(File& file, typename File::template Of<Texture>& texture) {
  file.text(texture.name);
  file.flag(texture.srgb);
  file.list("levels", texture.levels);
}

template <class File>
void fields(File& file, typename File::template Of<TextureView>& view) {
  file.number(view.texture);
  file.number(view.uv_set);
  file.choice(view.wrap_u, Wrap::clamp_to_edge);
  file.choice(view.wrap_v, Wrap::clamp_to_edge);
  file.flag(view.nearest);
  file.number(view.uv_offset);
  file.number(view.uv_rotation);
  file.number(view.uv_scale);
}

template <class File>
void fields(File& file, typename File::template Of<Material>& material) {
  file.text(material.name);
  file.number(material.base_color);
  file.number(material.metallic);
  file.number(material.roughness);
  file.number(material.emission);
  file.number(material.normal_scale);
  file.number(material.ior);
  file.number(material.specular);
  file.number(material.specular_color);
  file.number(material.transmission);
  file.flag(material.bounds_volume);
  file.number(material.absorption);
  file.choice(material.alpha_mode, AlphaMode::blend);
  file.number(material.alpha_cutoff);
  file.flag(material.double_sided);
  file.flag(material.unlit);
  file.flag(material.lambert);
  file.number(material.clearcoat);
  file.number(material.clearcoat_roughness);
  file.number(material.clearcoat_normal_scale);
  file.number(material.sheen_color);
  file.number(material.sheen_roughness);
  file.number(material.iridescence);
  file.number(material.iridescence_ior);
  file.number(material.iridescence_thickness_min);
  file.number(material.iridescence_thickness_max);
  for (auto* view : texture_views(material)) fields(file, *view);
}

template <class File>
void fields(File& file, typename File::template Of<Mesh>& mesh) {
  file.text(mesh.name);
  file.numbers(mesh.positions);
  file.numbers(mesh.normals);
  file.numbers(mesh.tangents);
  for (auto& uvs : mesh.uvs) file.numbers(uvs);
  file.numbers(mesh.colors);
  file.numbers(mesh.triangles);
  file.number(mesh.material);
}

template <class File>
void fields(File& file, typename File::template Of<Instance>& instance) {
  file.text(instance.name);
  file.number(instance.mesh);
  file.number(instance.world_from_object);
  file.flag(instance.casts_gi);
  file.flag(instance.receives_gi);
  file.flag(instance.ignored_by_probes);
  file.flag(instance.dynamic);
}

template <class File>
void fields(File& file, typename File::template Of<Light>& light) {
  file.text(light.name);
  file.choice(light.type, Light::Type::spot);
  file.number(light.intensity);
  file.number(light.position_ws);
  file.number(light.direction_ws);
  file.number(light.range);
  file.number(light.inner_cone_angle);
  file.number(light.outer_cone_angle);
}

template <class File>
void fields(File& file, typename File::template Of<Camera>& camera) {
  file.text(camera.name);
  file.number(camera.world_from_view);
  file.flag(camera.orthographic);
  file.number(camera.vertical_fov);
  file.number(camera.vertical_extent);
  file.number(camera.aspect);
}

template <class File>
void fields(File& file, typename File::template Of<ProbeVolume>& volume) {
  file.text(volume.name);
  file.number(volume.centre);
  file.number(volume.size);
  file.number(volume.axes);
  file.number(volume.probe_count);
  file.number(volume.probe_spacing);
  file.number(volume.priority);
}

template <class File>
void fields(File& file, typename File::template Of<FogVolume>& fog) {
  file.text(fog.name);
  file.number(fog.centre);
  file.number(fog.size);
  file.number(fog.axes);
  file.number(fog.density);
  file.number(fog.albedo);
  file.number(fog.anisotropy);
  file.number(fog.scale_height);
}

template <class File>
void fields(File& file, typename File::template Of<Scene>& scene) {
  file.list("textures", scene.textures);
  file.list("materials", scene.materials);
  file.list("meshes", scene.meshes);
  file.list("instances", scene.instances);
  file.list("lights", scene.lights);
  file.list("cameras", scene.cameras);
  file.number(scene.environment.radiance);
  file.number(scene.environment.map.width);
  file.number(scene.environment.map.height);
  file.number(scene.environment.map.channels);
  file.numbers(scene.environment.map.pixels);
  file.number(scene.environment.rotation);
  file.list("volumes", scene.volumes);
  file.list("fog", scene.fog);
  file.number(scene.source.origin);
}

}  // namespace

Expected<void> save_prepared(const Scene& scene, const std::string& path) {
  Writer writer;
  writer.header();
  fields(writer, scene);
  return write_file_atomically(path, writer.bytes());
}

Expected<Scene> load_prepared(const std::string& path) {
  const Expected<std::vector<std::byte>> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  Reader reader(*bytes);
  Scene scene;
  reader.header();
  if (reader.cause() == nullptr) fields(reader, scene);
  if (reader.cause() == nullptr) reader.end();
  if (reader.cause() != nullptr) return fail(path, reader.place(), reader.cause());
  scene.source.path = path;
  if (const Expected<void> valid = validate(scene); !valid) return tl::unexpected(valid.error());
  return scene;
}

void limit_textures(Scene& scene, int texels) {
  for (Texture& texture : scene.textures) {
    const auto first = std::find_if(
        texture.levels.begin(), texture.levels.end(),
        [texels](const auto& level) { return std::max(level.width, level.height) <= texels; });
    texture.levels.erase(texture.levels.begin(), first);
  }
}

}  // namespace lambent
