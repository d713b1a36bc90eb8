// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "lambent/scene.h"
#include "support/hand_made.h"

namespace lambent::scene_validate_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Scene good_scene() {
  Scene scene;
  scene.materials.push_back(test::lambert(glm::vec3(0.5f)));
  test::add(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0));
  Texture texture;
  texture.levels.push_back({3, 2, std::vector<std::uint8_t>(24)});
  build_mips(texture);
  scene.textures.push_back(texture);
  scene.lights.push_back(Light{});
  scene.cameras.push_back(look_at({0, 0, 1}, {0, 0, 0}, 1.0f));
  scene.environment.map = Image(2, 1, 3);
  return scene;
}

TEST(Validate, AcceptsAGoodScene) {
  const Expected<void> result = validate(good_scene());
  EXPECT_TRUE(result) << result.error().message();
  EXPECT_TRUE(validate(Scene{}));
}

TEST(Validate, NamesTheFirstThingWrong) {
  struct Case {
    const char* place;
    std::function<void(Scene&)> spoil;
  };
  const Case cases[] = {
      {"textures[0]", [](Scene& s) { s.textures[0].levels.clear(); }},
      {"volumes[0]", [](Scene& s) { s.volumes.resize(1), s.volumes[0].size.y = -1.0f; }},
      {"volumes[0]", [](Scene& s) { s.volumes.resize(1), s.volumes[0].size.z = kNan; }},
      {"volumes[0]", [](Scene& s) { s.volumes.resize(1), s.volumes[0].centre.x = 2e9f; }},
      {"textures[0]", [](Scene& s) { s.textures[0].levels.pop_back(); }},
      {"textures[0]", [](Scene& s) { s.textures[0].levels[0].rgba.pop_back(); }},
      {"textures[0]", [](Scene& s) { s.textures[0].levels[1].width = 2; }},
      {"materials[0]", [](Scene& s) { s.materials[0].base_color.r = 1.5f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].roughness = kNan; }},
      {"materials[0]", [](Scene& s) { s.materials[0].emission.g = -1.0f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].ior = 0.5f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].normal_texture.texture = 1; }},
      {"materials[0]", [](Scene& s) { s.materials[0].normal_texture.uv_set = 2; }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].material = 1; }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].normals.clear(); }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].normals[2] *= 2.0f; }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].positions[1].x = kNan; }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].uvs[0].pop_back(); }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].tangents.assign(4, glm::vec4(1, 0, 0, 0)); }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].triangles[1].z = 4; }},
      {"instances[0]", [](Scene& s) { s.instances[0].mesh = -1; }},
      {"instances[0]", [](Scene& s) { s.instances[0].world_from_object[1].y = 0.0f; }},
      {"instances[0]", [](Scene& s) { s.instances[0].world_from_object[0].w = 1.0f; }},
      {"instances[0]", [](Scene& s) { s.instances[0].world_from_object[3].y = 2e9f; }},
      {"instances[0]", [](Scene& s) { s.instances[0].world_from_object *= 1e11f; }},
      {"instances[0]",
       [](Scene& s) {
         for (int axis = 0; axis < 3; ++axis) s.instances[0].world_from_object[axis] *= 1e11f;
       }},
      {"lights[0]", [](Scene& s) { s.lights[0].intensity.b = -1.0f; }},
      {"lights[0]", [](Scene& s) { s.lights[0].intensity.b = 2e12f; }},
      {"lights[0]", [](Scene& s) { s.lights[0].position_ws.x = 2e9f; }},
      {"lights[0]",
       [](Scene& s) {
         s.lights[0].type = Light::Type::directional;
         s.lights[0].intensity.b = 2e10f;
       }},
      {"lights[0]",
       [](Scene& s) {
         s.lights[0].type = Light::Type::directional;
         s.lights[0].direction_ws = glm::vec3(0.0f);
       }},
      {"lights[0]",
       [](Scene& s) {
         s.lights[0].type = Light::Type::spot;
         s.lights[0].inner_cone_angle = 1.0f;
       }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].vertical_fov = 0.0f; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].vertical_fov = 3.1415f; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].vertical_fov = kNan; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].world_from_view[3].z = 1e19f; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].aspect = 1e30f; }},
      {"cameras[0]",
       [](Scene& s) {
         s.cameras[0].orthographic = true;
         s.cameras[0].vertical_extent = 1e10f;
       }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].world_from_view[0] *= 2.0f; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].aspect = -1.0f; }},
      {"cameras[0]",
       [](Scene& s) {
         s.cameras[0].orthographic = true;
         s.cameras[0].aspect = kNan;
       }},
      {"environment", [](Scene& s) { s.environment.radiance.r = kNan; }},
      {"environment", [](Scene& s) { s.environment.radiance.r = 2e10f; }},
      {"environment", [](Scene& s) { s.environment.map.pixels[4] = 2e10f; }},
      {"environment",
       [](Scene& s) {
         s.environment.map.pixels[4] = 1e6f;
         s.environment.radiance.r = 1e5f;
       }},
      {"materials[0]", [](Scene& s) { s.materials[0].emission.r = 2e10f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].normal_scale = 1e30f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].specular_color.r = 1e30f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].clearcoat = 1.5f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].clearcoat_roughness = -0.1f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].clearcoat_normal_scale = 1e30f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].sheen_color.g = 2.0f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].sheen_roughness = kNan; }},
      {"materials[0]", [](Scene& s) { s.materials[0].sheen_color_texture.texture = 99; }},
      {"materials[0]", [](Scene& s) { s.materials[0].iridescence = 1.1f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].iridescence_ior = 0.9f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].iridescence_thickness_min = -1.0f; }},
      {"materials[0]", [](Scene& s) { s.materials[0].iridescence_thickness_max = kNan; }},
      {"materials[0]", [](Scene& s) { s.materials[0].iridescence_texture.texture = 99; }},
      {"materials[0]", [](Scene& s) { s.materials[0].emission_texture.uv_scale.x = 1e30f; }},
      {"meshes[0]", [](Scene& s) { s.meshes[0].positions[0].x = 2e9f; }},
      {"environment", [](Scene& s) { s.environment.map.pixels[4] = -1.0f; }},
      {"environment", [](Scene& s) { s.environment.map.pixels.pop_back(); }},
  };
  int index = 0;
  for (const Case& test_case : cases) {
    Scene scene = good_scene();
    test_case.spoil(scene);
    const Expected<void> result = validate(scene);
    ASSERT_FALSE(result) << index;
    EXPECT_EQ(result.error().place, test_case.place) << index;
    ++index;
  }
}

TEST(Bounds, AreEmptyAsSoonAsOneAxisIs) {
  EXPECT_TRUE(Bounds{}.empty());
  for (int axis = 0; axis < 3; ++axis) {
    Bounds bounds{glm::vec3(0.0f), glm::vec3(1.0f)};
    EXPECT_FALSE(bounds.empty());
    bounds.max[axis] = 0.0f;
    EXPECT_FALSE(bounds.empty());
    bounds.max[axis] = -1.0f;
    EXPECT_TRUE(bounds.empty()) << axis;
  }
}

}  // namespace
}  // namespace lambent::scene_validate_test
