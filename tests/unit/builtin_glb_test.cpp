// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "scenes/glb_writer.h"
#include "scenes/recipes.h"

namespace lambent::scenes::builtin_glb_test {
namespace {

using testing::HasSubstr;

// Numbers go through decimal text and rotations through quaternions.
constexpr float kNoise = 2e-6f;

/// The scene as it comes back from a file.
Scene round_trip(const AnimatedScene& made, const std::string& name) {
  const std::string path = testing::TempDir() + "lambent_builtin_" + name + ".glb";
  const Expected<std::size_t> bytes = write_glb(made.scene, path, made.animations);
  EXPECT_TRUE(bytes);
  EXPECT_EQ(*bytes, std::filesystem::file_size(path));
  Expected<Scene> loaded = load_scene(path);
  std::filesystem::remove(path);
  if (!loaded) throw std::runtime_error(loaded.error().message());
  return std::move(*loaded);
}

void expect_near(const glm::mat4& a, const glm::mat4& b, const std::string& name) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(a[c][r], b[c][r], 10.0f * kNoise) << name;
  }
}

/// All triangles of the world as sorted corner lists, in hundredths of a millimetre.
std::vector<std::array<int, 9>> world_triangles(const Scene& scene) {
  constexpr float kPerMetre = 1e5f;
  std::vector<std::array<int, 9>> list;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const glm::uvec3& t : mesh.triangles) {
      std::array<std::array<int, 3>, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const glm::vec4 p = instance.world_from_object * glm::vec4(mesh.positions[t[k]], 1.0f);
        for (int c = 0; c < 3; ++c) corners[k][c] = static_cast<int>(std::lround(p[c] * kPerMetre));
      }
      // Keep the winding: turn the smallest corner to the front.
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      std::array<int, 9> flat;
      for (int i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
      list.push_back(flat);
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

class EveryGlb : public testing::TestWithParam<std::string> {};

TEST_P(EveryGlb, ComesBackAsItWas) {
  const AnimatedScene made =
      GetParam() == "atrium" ? make_atrium(32) : make_animated(GetParam()).value();
  const Scene& a = made.scene;
  const Scene b = round_trip(made, GetParam());
  EXPECT_TRUE(world_triangles(a) == world_triangles(b));
  EXPECT_EQ(a.environment.radiance, b.environment.radiance);
  EXPECT_EQ(b.source.animations, static_cast<int>(made.animations.size()));

  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    EXPECT_EQ(a.lights[i].type, b.lights[i].type);
    EXPECT_LT(glm::distance(a.lights[i].intensity, b.lights[i].intensity),
              kNoise * glm::length(a.lights[i].intensity));
    EXPECT_EQ(a.lights[i].position_ws, b.lights[i].position_ws);
    if (a.lights[i].type == Light::Type::point) continue;
    EXPECT_LT(glm::distance(a.lights[i].direction_ws, b.lights[i].direction_ws), kNoise);
  }
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    EXPECT_EQ(a.cameras[i].name, b.cameras[i].name);
    EXPECT_EQ(a.cameras[i].orthographic, b.cameras[i].orthographic);
    if (a.cameras[i].orthographic) {
      EXPECT_NEAR(a.cameras[i].vertical_extent, b.cameras[i].vertical_extent, kNoise);
    } else {
      EXPECT_NEAR(a.cameras[i].vertical_fov, b.cameras[i].vertical_fov, kNoise);
    }
    EXPECT_NEAR(a.cameras[i].aspect, b.cameras[i].aspect, kNoise);
    expect_near(a.cameras[i].world_from_view, b.cameras[i].world_from_view, a.cameras[i].name);
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    const Material &m = a.materials[i], &n = b.materials[i];
    EXPECT_EQ(m.name, n.name);
    EXPECT_EQ(m.base_color, n.base_color);
    EXPECT_EQ(m.roughness, n.roughness);
    EXPECT_EQ(m.metallic, n.metallic);
    EXPECT_EQ(m.specular, n.specular);
    EXPECT_EQ(m.double_sided, n.double_sided);
    EXPECT_LT(glm::distance(m.emission, n.emission), kNoise * 100.0f);
    for (const auto view : {&Material::base_color_texture, &Material::metallic_roughness_texture,
                            &Material::normal_texture}) {
      ASSERT_EQ((m.*view).texture >= 0, (n.*view).texture >= 0);
      if ((m.*view).texture < 0) continue;
      const Texture &s = a.textures[(m.*view).texture], &t = b.textures[(n.*view).texture];
      EXPECT_EQ(s.srgb, t.srgb) << s.name;
      EXPECT_TRUE(s.levels[0].rgba == t.levels[0].rgba) << s.name;
    }
  }
  EXPECT_EQ(a.textures.size(), b.textures.size());
}

INSTANTIATE_TEST_SUITE_P(BuiltinGlb, EveryGlb, testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(BuiltinGlb, IsTheSameEveryTime) {
  const AnimatedScene made = make_atrium(16);
  EXPECT_TRUE(encode_glb(made.scene, made.animations).value() ==
              encode_glb(made.scene, made.animations).value());
}

TEST(BuiltinGlb, KeepsTheSkyInTheExtrasOfTheScene) {
  Scene scene = make("cornell").value();
  EXPECT_THAT(encode_glb(scene).value(), testing::Not(HasSubstr("lambent_sky_radiance")));
  scene.environment.radiance = {0.25f, 0.5f, 1.0f};
  EXPECT_THAT(encode_glb(scene).value(),
              HasSubstr(R"("extras":{"lambent_sky_radiance":[0.25,0.5,1.0]})"));
}

TEST(BuiltinGlb, KeepsWhatInstancesSayOfGlobalIllumination) {
  AnimatedScene made = make_animated("cornell").value();
  made.scene.instances[1].casts_gi = false;
  made.scene.instances[2].receives_gi = false;
  made.scene.instances[3].ignored_by_probes = true;
  const Scene back = round_trip(made, "flags");
  ASSERT_EQ(back.instances.size(), made.scene.instances.size());
  for (std::size_t i = 0; i < back.instances.size(); ++i) {
    EXPECT_EQ(back.instances[i].casts_gi, i != 1) << i;
    EXPECT_EQ(back.instances[i].receives_gi, i != 2) << i;
    EXPECT_EQ(back.instances[i].ignored_by_probes, i == 3) << i;
  }
}

TEST(BuiltinGlb, RefusesWhatGltfCannotHold) {
  Scene scene = make("cornell").value();
  scene.environment.map = Image(2, 1, 3);
  EXPECT_THAT(encode_glb(scene).error().message(), HasSubstr("environment map"));
  scene = make("cornell").value();
  scene.textures.push_back({"t", false, {{1, 1, {0, 0, 0, 255}}}});
  scene.materials[0].metallic_roughness_texture.texture = 0;
  EXPECT_THAT(encode_glb(scene).error().message(), HasSubstr("white"));
}

TEST(BuiltinGlb, FailureNamesTheFile) {
  const Expected<std::size_t> bytes = write_glb(make("cornell").value(), "/no/such/folder/a.glb");
  ASSERT_FALSE(bytes);
  EXPECT_THAT(bytes.error().message(), HasSubstr("/no/such/folder/a.glb"));
}

/// Our scene against the file that the truth images were made from.
void expect_same_geometry(const std::string& name, const std::string& file) {
  const std::string path = std::string(LAMBENT_SHARED_DIR) + "/scenes/" + file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Scene ours = make(name).value(), theirs = load_scene(path).value();
  EXPECT_TRUE(world_triangles(ours) == world_triangles(theirs));
  ASSERT_EQ(ours.cameras.size(), theirs.cameras.size());
  for (std::size_t i = 0; i < ours.cameras.size(); ++i) {
    EXPECT_EQ(ours.cameras[i].name, theirs.cameras[i].name);
    EXPECT_NEAR(ours.cameras[i].vertical_fov, theirs.cameras[i].vertical_fov, kNoise);
    expect_near(ours.cameras[i].world_from_view, theirs.cameras[i].world_from_view, name);
  }
  ASSERT_EQ(ours.materials.size(), theirs.materials.size());
  for (std::size_t i = 0; i < ours.materials.size(); ++i) {
    EXPECT_EQ(ours.materials[i].name, theirs.materials[i].name);
    EXPECT_EQ(ours.materials[i].base_color, theirs.materials[i].base_color);
    EXPECT_LT(glm::distance(ours.materials[i].emission, theirs.materials[i].emission), 1e-5f);
  }
  ASSERT_EQ(ours.lights.size(), theirs.lights.size());
  for (std::size_t i = 0; i < ours.lights.size(); ++i) {
    EXPECT_LT(glm::distance(ours.lights[i].intensity, theirs.lights[i].intensity), 1e-4f);
    EXPECT_EQ(ours.lights[i].position_ws, theirs.lights[i].position_ws);
  }
}

TEST(BuiltinGlb, CornellEqualsTheMeasuredOne) {
  expect_same_geometry("cornell", "cornell_box/cornell_box.glb");
}

TEST(BuiltinGlb, TwoRoomsEqualThoseOfTheTruth) {
  expect_same_geometry("two-rooms", "two_rooms/two_rooms.glb");
  expect_same_geometry("two-rooms-sealed", "two_rooms/two_rooms_sealed.glb");
}

}  // namespace
}  // namespace lambent::scenes::builtin_glb_test
