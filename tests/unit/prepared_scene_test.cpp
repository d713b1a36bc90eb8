// SPDX-License-Identifier: Apache-2.0
// Prepared scenes: what was saved comes back, and nothing else is believed.
#include "scene/prepared.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "core/files/file_bytes.h"
#include "support/hand_made.h"
#include "support/temporary_directory.h"

namespace lambent::prepared_scene_test {
namespace {

using ::testing::HasSubstr;

/// A texture of one colour a level, so that levels can be told apart.
Texture texture(int size) {
  Texture texture;
  texture.name = "checks";
  texture.srgb = true;
  for (int side = size; side >= 1; side /= 2) {
    TextureLevel level{side, side, std::vector<std::uint8_t>(4u * side * side, 7)};
    level.rgba[0] = static_cast<std::uint8_t>(side);
    texture.levels.push_back(level);
  }
  return texture;
}

Material every_number_its_own() {
  Material m;
  m.name = "m";
  m.base_color = {0.1f, 0.2f, 0.3f, 0.4f};
  m.metallic = 0.5f;
  m.roughness = 0.6f;
  m.emission = {7.0f, 8.0f, 9.0f};
  m.normal_scale = 1.1f;
  m.ior = 1.2f;
  m.specular = 0.13f;
  m.specular_color = {1.4f, 1.5f, 1.6f};
  m.alpha_mode = AlphaMode::mask;
  m.alpha_cutoff = 0.17f;
  m.double_sided = m.unlit = m.lambert = true;
  m.base_color_texture = {
      0, 1, Wrap::clamp_to_edge, Wrap::mirrored_repeat, true, {1.0f, 2.0f}, 0.3f, {4.0f, 5.0f}};
  m.metallic_roughness_texture.uv_offset.x = 2.0f;
  m.normal_texture.uv_offset.x = 3.0f;
  m.emission_texture.uv_offset.x = 4.0f;
  m.specular_texture.uv_offset.x = 5.0f;
  m.specular_color_texture.uv_offset.x = 6.0f;
  m.clearcoat = 0.21f;
  m.clearcoat_roughness = 0.22f;
  m.clearcoat_normal_scale = 2.3f;
  m.sheen_color = {0.24f, 0.25f, 0.26f};
  m.sheen_roughness = 0.27f;
  m.clearcoat_texture.uv_offset.x = 7.0f;
  m.clearcoat_roughness_texture.uv_offset.x = 8.0f;
  m.clearcoat_normal_texture.uv_offset.x = 9.0f;
  m.sheen_color_texture.uv_offset.x = 10.0f;
  m.sheen_roughness_texture.uv_offset.x = 11.0f;
  m.iridescence = 0.28f;
  m.iridescence_ior = 1.29f;
  m.iridescence_thickness_min = 30.0f;
  m.iridescence_thickness_max = 310.0f;
  m.iridescence_texture.uv_offset.x = 12.0f;
  m.iridescence_thickness_texture.uv_offset.x = 13.0f;
  return m;
}

/// A scene in which no member is as it is by itself.
Scene scene() {
  Scene scene;
  scene.textures = {texture(8)};
  scene.materials = {test::lambert(glm::vec3(0.5f)), every_number_its_own()};
  Mesh mesh = test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  mesh.name = "quad";
  mesh.tangents.assign(4, {1.0f, 0.0f, 0.0f, -1.0f});
  mesh.uvs[1].assign(4, {0.25f, 0.75f});
  mesh.colors.assign(4, {0.1f, 0.2f, 0.3f, 1.0f});
  glm::mat4 moved(1.0f);
  moved[3] = {1.0f, 2.0f, 3.0f, 1.0f};
  test::add(scene, mesh, moved);
  Instance& instance = scene.instances[0];
  instance.name = "placed";
  instance.casts_gi = instance.receives_gi = false;
  instance.ignored_by_probes = instance.dynamic = true;
  Light light;
  light.name = "lamp";
  light.type = Light::Type::spot;
  light.intensity = {1, 2, 3};
  light.position_ws = {4, 5, 6};
  light.direction_ws = {1, 0, 0};
  light.range = 7.0f;
  light.inner_cone_angle = 0.1f;
  light.outer_cone_angle = 0.2f;
  scene.lights = {light};
  Camera camera = look_at({1, 2, 3}, {4, 5, 7}, 0.6f);
  camera.name = "eye";
  camera.orthographic = true;
  camera.vertical_extent = 2.0f;
  camera.aspect = 1.5f;
  scene.cameras = {camera};
  scene.environment.radiance = {1, 2, 3};
  scene.environment.map = Image(4, 2, 3);
  scene.environment.map.at(1, 1)[2] = 5.0f;
  scene.environment.rotation = 0.4f;
  ProbeVolume volume;
  volume.name = "finer";
  volume.centre = {1, 2, 3};
  volume.size = {4, 5, 6};
  volume.axes = glm::mat3(0, 1, 0, 0, 0, 1, 1, 0, 0);
  volume.probe_count = {2, 3, 4};
  volume.probe_spacing = 0.5f;
  volume.priority = 3;
  scene.volumes = {volume};
  FogVolume fog;
  fog.name = "mist";
  fog.centre = {1.0f, 2.0f, 3.0f};
  fog.density = 0.5f;
  fog.albedo = {0.1f, 0.2f, 0.3f};
  fog.anisotropy = 0.6f;
  fog.scale_height = 7.0f;
  scene.fog = {fog};
  scene.source.origin = {1e5, 2.5, -3e6};
  return scene;
}

class PreparedScene : public ::testing::Test {
 protected:
  std::string path() const { return folder.file("scene"); }
  std::vector<std::byte> saved() {
    EXPECT_TRUE(save_prepared(scene(), path()));
    return read_file(path()).value();
  }
  Expected<Scene> load(std::span<const std::byte> bytes) {
    std::ofstream(path(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return load_prepared(path());
  }

  test::TemporaryDirectory folder;
};

TEST_F(PreparedScene, ComesBackAsItWas) {
  const Scene before = scene();
  const std::vector<std::byte> bytes = saved();
  const Scene after = load_prepared(path()).value();
  ASSERT_EQ(after.textures.size(), 1u);
  EXPECT_EQ(after.textures[0].name, "checks");
  EXPECT_TRUE(after.textures[0].srgb);
  ASSERT_EQ(after.textures[0].levels.size(), 4u);
  EXPECT_EQ(after.textures[0].levels[1].rgba, before.textures[0].levels[1].rgba);
  EXPECT_EQ(after.materials, before.materials);
  EXPECT_EQ(after.meshes[0].name, "quad");
  EXPECT_EQ(after.meshes[0].positions, before.meshes[0].positions);
  EXPECT_EQ(after.meshes[0].normals, before.meshes[0].normals);
  EXPECT_EQ(after.meshes[0].tangents, before.meshes[0].tangents);
  EXPECT_EQ(after.meshes[0].uvs, before.meshes[0].uvs);
  EXPECT_EQ(after.meshes[0].colors, before.meshes[0].colors);
  EXPECT_EQ(after.meshes[0].triangles, before.meshes[0].triangles);
  EXPECT_EQ(after.meshes[0].material, 1);
  EXPECT_EQ(after.instances[0].world_from_object, before.instances[0].world_from_object);
  EXPECT_FALSE(after.instances[0].casts_gi || after.instances[0].receives_gi);
  EXPECT_TRUE(after.instances[0].ignored_by_probes && after.instances[0].dynamic);
  EXPECT_EQ(after.lights, before.lights);
  EXPECT_EQ(after.cameras[0].world_from_view, before.cameras[0].world_from_view);
  EXPECT_EQ(after.cameras[0].vertical_extent, 2.0f);
  EXPECT_EQ(after.environment.map.pixels, before.environment.map.pixels);
  EXPECT_EQ(after.volumes[0].axes, before.volumes[0].axes);
  EXPECT_EQ(after.fog, before.fog);
  EXPECT_EQ(after.source.path, path());
  EXPECT_EQ(after.source.origin, before.source.origin);
  // All that is not named above, too: the same file is made of it
  ASSERT_TRUE(save_prepared(after, path()));
  EXPECT_EQ(read_file(path()).value(), bytes);
}

TEST_F(PreparedScene, IsRefusedWhereItIsCutShort) {
  const std::vector<std::byte> bytes = saved();
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    ASSERT_FALSE(load(std::span(bytes).first(size))) << size;
  }
  EXPECT_TRUE(load(bytes));
}

TEST_F(PreparedScene, IsRefusedWithSomethingBehindItsEnd) {
  std::vector<std::byte> bytes = saved();
  bytes.push_back(std::byte{0});
  const auto loaded = load(bytes);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message(), HasSubstr("after its end"));
}

// Wherever a length may stand: no memory is asked for that the file does not back.
TEST_F(PreparedScene, IsRefusedOrSoundWhateverStandsInIt) {
  const std::vector<std::byte> bytes = saved();
  for (const int value : {0xFF, 0x40}) {
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 4) {
      std::vector<std::byte> broken = bytes;
      std::memset(&broken[at], value, 8);
      if (const auto loaded = load(broken)) {
        ASSERT_TRUE(validate(*loaded)) << at;
      } else {
        ASSERT_FALSE(loaded.error().cause.empty());
      }
    }
  }
}

TEST_F(PreparedScene, OfAnotherVersionIsToldApart) {
  std::vector<std::byte> bytes = saved();
  bytes[16] = std::byte{99};
  EXPECT_THAT(load(bytes).error().message(), HasSubstr("another version"));
  EXPECT_THAT(load(std::span(bytes).subspan(1)).error().message(),
              HasSubstr("not a prepared scene"));
}

TEST_F(PreparedScene, KeepsTheLevelsThatFit) {
  Scene limited = scene();
  limit_textures(limited, 5);
  ASSERT_EQ(limited.textures[0].levels.size(), 3u);
  EXPECT_EQ(limited.textures[0].levels[0].width, 4);
  EXPECT_TRUE(validate(limited));
}

}  // namespace
}  // namespace lambent::prepared_scene_test
