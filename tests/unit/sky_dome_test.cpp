// SPDX-License-Identifier: Apache-2.0
// Skies that scenes bring as meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "first_picture/daylight.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "scene/latitude_longitude.h"
#include "shared/color.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::sky_dome_test {
namespace {

using glm::vec3;
using test::box_mesh;

constexpr float kRadius = 300.0f;
const vec3 kBlue(1.0f, 2.0f, 4.0f);

/// A house-sized box on a lawn, under a dome that emits kBlue.
Scene under_a_dome() {
  Scene scene =
      test::scene_of({box_mesh({-5, 0, -5}, {5, 4, 5}), box_mesh({-200, -1, -200}, {200, 0, 200})});
  scene.materials.push_back(test::lambert(vec3(0.0f), kBlue));
  test::add(scene, test::sphere(kRadius, 16, 1));
  return scene;
}

vec3 radiance(const Environment& sky, const vec3& direction) {
  const vec2 uv = latitude_longitude_from_direction(glm::normalize(direction), 0.0f);
  const float* texel = sky.map.at(static_cast<int>(uv.x * static_cast<float>(sky.map.width)),
                                  static_cast<int>(uv.y * static_cast<float>(sky.map.height)));
  return sky.radiance * vec3(texel[0], texel[1], texel[2]);
}

TEST(SkyDome, BecomesTheSky) {
  Scene scene = under_a_dome();
  const std::optional<Scene> dome = take_sky_dome(scene);
  ASSERT_TRUE(dome.has_value());
  const Bounds left = world_bounds(scene);
  EXPECT_EQ(left.max, vec3(200, 4, 200));
  EXPECT_EQ(scene.instances.size(), 3u);
  scene.environment = sky_of_dome(*dome, {3, 1.6f, 9});
  for (const vec3& way : {vec3(0, 1, 0), vec3(1, 0.1f, 0), vec3(-1, -1, 2)}) {
    EXPECT_EQ(radiance(scene.environment, way), kBlue);
  }
  // What is left is a world that can be traced
  const World world(scene);
  EXPECT_EQ(choose_first_light(world, look_at({0, 2, 20}, {0, 2, 0}, 0.8f)), FirstLight::scene);
}

// Most triangles are a terrain's, which reaches two thirds of the way to the sky.
TEST(SkyDome, MayBeNearALargeTerrain) {
  Scene scene = under_a_dome();
  for (int copies = 0; copies < 3; ++copies) scene.instances.push_back(scene.instances[1]);
  EXPECT_TRUE(take_sky_dome(scene).has_value());
}

TEST(SkyDome, MayBeMostlyBlack) {
  Scene scene = under_a_dome();
  Texture texture;
  constexpr int kTexels = 16;
  std::vector<std::uint8_t> one_is_white(4 * kTexels, 0);
  std::fill_n(one_is_white.begin(), 4, std::uint8_t{255});
  texture.levels.push_back({kTexels, 1, std::move(one_is_white)});
  build_mips(texture);
  scene.textures.push_back(texture);
  scene.materials[1].emission_texture.texture = 0;
  Scene cave = scene;
  cave.materials[1].base_color = glm::vec4(0.3f, 0.2f, 0.2f, 1.0f);
  EXPECT_TRUE(take_sky_dome(scene).has_value());
  EXPECT_FALSE(take_sky_dome(cave).has_value()) << "a hall whose walls glow in places";
}

TEST(SkyDome, IsSeenFromTheCamera) {
  // Two colours, above and below a plane 30 m over the ground: the limit is at the horizon of an
  // eye at that height, and above that of one on the ground
  Scene scene = under_a_dome();
  Mesh& sphere = scene.meshes[2];
  scene.materials[1] = {};
  scene.materials[1].unlit = true;
  for (const vec3& p : sphere.positions) {
    sphere.colors.emplace_back(p.y > 30.0f ? vec3(0.2f) : vec3(0.8f), 1.0f);
  }
  const std::optional<Scene> dome = take_sky_dome(scene);
  ASSERT_TRUE(dome.has_value());
  const vec3 way(1.0f, 0.0f, 0.3f);
  EXPECT_GT(radiance(sky_of_dome(*dome, vec3(0.0f)), way).x, 0.75f);
  EXPECT_LT(radiance(sky_of_dome(*dome, vec3(0.0f, 70.0f, 0.0f)), way).x, 0.25f);
}

TEST(SkyDome, HasItsTextureOnTheSameSide) {
  Scene scene = under_a_dome();
  // A texture whose left half is bright; the sphere's u grows from +Z towards +X
  Texture texture;
  texture.levels.push_back({2, 1, {255, 255, 255, 255, 10, 0, 0, 255}});
  build_mips(texture);
  scene.textures.push_back(texture);
  scene.materials[1].emission_texture.texture = 0;
  const std::optional<Scene> dim = take_sky_dome(scene);
  ASSERT_TRUE(dim.has_value());
  const Environment sky = sky_of_dome(*dim, vec3(0.0f));
  EXPECT_NEAR(radiance(sky, {1, 0.2f, 0}).x, kBlue.x, 0.01f);
  EXPECT_LT(radiance(sky, {-1, 0.2f, 0}).x, 0.1f * kBlue.x);
}

TEST(SkyDome, MayBeHalfASphere) {
  Scene scene = under_a_dome();
  Mesh& sphere = scene.meshes[2];
  std::erase_if(sphere.triangles, [&](const glm::uvec3& t) {
    return sphere.positions[t.x].y + sphere.positions[t.y].y + sphere.positions[t.z].y < 0.0f;
  });
  const std::optional<Scene> dome = take_sky_dome(scene);
  ASSERT_TRUE(dome.has_value());
  const Environment sky = sky_of_dome(*dome, {0, 2, 9});
  EXPECT_EQ(radiance(sky, {0, 1, 3}), kBlue);
  EXPECT_EQ(radiance(sky, {0, -1, 3}), vec3(0.0f));
}

TEST(SkyDome, OfColoursIsAsBrightAsTheSunNeeds) {
  Scene scene = under_a_dome();
  scene.materials[1] = {};
  scene.materials[1].unlit = true;
  scene.materials[1].base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  Scene sunny = scene;
  sunny.lights.push_back(test::sun(vec3(100.0f), {0, -1, 0}));
  const Environment sky = sky_of_dome(*take_sky_dome(scene), vec3(0.0f));
  EXPECT_FLOAT_EQ(radiance(sky, {0, 1, 0}).x, 0.5f);
  // A clear sky's radiance is about a fifteenth of its sun's irradiance
  const Environment brighter = sky_of_dome(*take_sky_dome(sunny), vec3(0.0f));
  EXPECT_NEAR(radiance(brighter, {0, 1, 0}).x, 3.4f, 0.3f);
}

const vec3 kPaintedBlue(0.15f, 0.35f, 0.9f), kPaintedGrey(0.5f, 0.54f, 0.62f);

/// The scene under an unlit dome with one colour near the horizon and another above.
Scene under_colours(const vec3& low, const vec3& high) {
  Scene scene = under_a_dome();
  scene.materials[1] = {};
  scene.materials[1].unlit = true;
  Mesh& sphere = scene.meshes[2];
  for (const vec3& p : sphere.positions) {
    sphere.colors.emplace_back(p.y < 0.3f * kRadius ? low : high, 1.0f);
  }
  return scene;
}

/// Whether the scene, whose dome becomes its sky, gets a sun beside it.
bool gets_a_sun(Scene& scene) {
  const Camera camera = look_at({0, 2, 20}, {0, 2, 0}, 0.8f);
  scene.environment = sky_of_dome(take_sky_dome(scene).value(), {0, 2, 20});
  const World world(scene);
  const std::size_t lights = scene.lights.size();
  const Environment before = scene.environment;
  const bool added = add_sun_to_sky(world, camera, scene);
  EXPECT_EQ(scene.lights.size(), lights + (added ? 1 : 0));
  EXPECT_EQ(scene.environment.radiance != before.radiance, added);
  EXPECT_EQ(scene.environment.revision != before.revision, added);
  return added;
}

TEST(SkyDome, OfAClearDayGetsASun) {
  Scene scene = under_colours(kPaintedBlue, kPaintedBlue);
  ASSERT_TRUE(gets_a_sun(scene));
  EXPECT_EQ(scene.lights[0].type, Light::Type::directional);
  EXPECT_EQ(scene.lights[0].intensity, kDaySunIrradiance);
  const vec3 above = radiance(scene.environment, {0, 1, 0});
  EXPECT_NEAR(luminance(above), kDaySkyLuminance, 0.02f) << "as bright as the sun needs";
  EXPECT_NEAR(above.z / above.x, kPaintedBlue.z / kPaintedBlue.x, 0.02f) << "and as painted";

  Scene hazy = under_colours({0.8f, 0.85f, 0.9f}, kPaintedBlue);
  EXPECT_TRUE(gets_a_sun(hazy));
  Scene emissive = under_a_dome();
  emissive.materials[1].emission = kPaintedBlue;
  EXPECT_TRUE(gets_a_sun(emissive)) << "without a unit, too";
}

TEST(SkyDome, OfAnotherSkyGetsNoSun) {
  Scene night = under_colours({0.01f, 0.02f, 0.08f}, {0.005f, 0.01f, 0.05f});
  EXPECT_FALSE(gets_a_sun(night));
  Scene overcast = under_colours(kPaintedGrey, kPaintedGrey);
  EXPECT_FALSE(gets_a_sun(overcast));
  Scene dusk = under_colours({0.9f, 0.45f, 0.2f}, kPaintedBlue);
  EXPECT_FALSE(gets_a_sun(dusk));
  Scene measured = under_a_dome();
  EXPECT_FALSE(gets_a_sun(measured)) << "emits more than white, so that its radiance is meant";
}

TEST(SkyDome, GetsNoSunBesideOtherLight) {
  Scene sunny = under_colours(kPaintedBlue, kPaintedBlue);
  sunny.lights.push_back(test::sun(vec3(10.0f), {0, -1, 0}));
  EXPECT_FALSE(gets_a_sun(sunny));
  // A canopy of light over the house
  Scene lit = under_colours(kPaintedBlue, kPaintedBlue);
  lit.materials.push_back(test::lambert(vec3(0.0f), vec3(50.0f)));
  Mesh canopy = box_mesh({-20, 8, -20}, {20, 8.2f, 20});
  canopy.material = 2;
  test::add(lit, std::move(canopy));
  EXPECT_FALSE(gets_a_sun(lit));
}

TEST(SkyDome, IsNotAnyOtherSurface) {
  const auto is_taken = [](Scene scene) {
    const Bounds before = world_bounds(scene);
    const bool taken = take_sky_dome(scene).has_value();
    EXPECT_NE(taken, world_bounds(scene) == before);
    return taken;
  };
  EXPECT_TRUE(is_taken(under_a_dome()));

  Scene dark = under_a_dome();
  dark.materials[1].emission = vec3(0.0f);
  EXPECT_FALSE(is_taken(dark));
  Scene clear = under_a_dome();
  clear.materials[1].alpha_mode = AlphaMode::blend;
  EXPECT_FALSE(is_taken(clear));
  Scene moving = under_a_dome();
  moving.instances[2].dynamic = true;
  EXPECT_FALSE(is_taken(moving));
  // A room with glowing walls, and a tent of light around a product
  Scene room = under_a_dome();
  room.instances[2].world_from_object = glm::mat4(glm::mat3(10.0f / kRadius));
  room.instances.erase(room.instances.begin() + 1);
  EXPECT_FALSE(is_taken(room));
  // A panorama with nothing in it, and one where all else shows its colours, too
  Scene panorama = under_a_dome();
  panorama.instances.erase(panorama.instances.begin(), panorama.instances.begin() + 2);
  EXPECT_FALSE(is_taken(panorama));
  Scene unlit = under_a_dome();
  unlit.materials[0].unlit = true;
  EXPECT_FALSE(is_taken(unlit));
  EXPECT_FALSE(is_taken(Scene{}));
}

}  // namespace
}  // namespace lambent::sky_dome_test
