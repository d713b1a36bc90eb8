// SPDX-License-Identifier: Apache-2.0
// Rays that go on at mirrors.
#include "raytracing/mirrors/mirror_math.h"

#include <gtest/gtest.h>

#include <vector>

#include "raytracing/mirrors/find_mirrors.h"
#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::mirrors_test {
namespace {

// Rounding of sums of a few products.
constexpr float kTolerance = 1e-5f;
// Metal of roughness 0 is a little rough (kMinGgxAlpha): over 2 m, the rays that it reflects spread
// by this much [m].
constexpr float kSpread = 0.1f;
constexpr int kWall = 0, kMirror = 1;

Material metal(const vec3& color, float roughness) {
  Material material;
  material.base_color = vec4(color, 1.0f);
  material.metallic = 1.0f;
  material.roughness = roughness;
  material.double_sided = true;
  return material;
}

uint shape_of(const Material& material) {
  return encode_albedo_shape(coated_reflectance(vec3(material.base_color), material.metallic,
                                                material.roughness, material.specular,
                                                material.specular_color, material.ior));
}

/// A mirror in the plane x = 0 that faces a wall in the plane x = 2, and a light between them.
Scene facing(const Material& wall, const Material& mirror) {
  Scene scene;
  scene.materials = {wall, mirror};
  const vec3 up(0.0f, 4.0f, 0.0f), along(0.0f, 0.0f, 4.0f);
  test::add(scene, test::quad({0.0f, -2.0f, -2.0f}, up, along, kMirror));
  test::add(scene, test::quad({2.0f, -2.0f, -2.0f}, along, up, kWall));
  Light light;
  light.type = Light::Type::point;
  light.position_ws = {1.0f, 1.0f, 0.0f};
  light.intensity = vec3(5.0f);
  scene.lights = {light};
  return scene;
}

ShadedHit shade(const World& world, const Ray& ray, bool follow) {
  Hit hit = tracer_of(world).closest_hit(ray);
  ShadeHitsSettings settings;
  settings.follow_mirrors = follow;
  ShadeHitsScratch scratch;
  ShadedHit shaded;
  shade_hits(world, {&ray, 1}, {&hit, 1}, settings, 7, scratch, {&shaded, 1});
  return shaded;
}

vec3 reflected(const ShadedHit& shaded) {
  return shaded.surface.albedo_over_pi * shaded.direct_irradiance;
}

const Ray kTowardsMirror{
    {1.0f, 0.0f, 0.0f}, 0.0f, {-1.0f, 0.0f, 0.0f}, kInfiniteDistance, kRayOfProbe};

TEST(Mirrors, AreSmoothCoatsThatReflectMostOfTheLight) {
  EXPECT_TRUE(is_mirror(shape_of(metal(vec3(0.9f), 0.0f))));
  EXPECT_TRUE(is_mirror(shape_of(metal(vec3(0.9f, 0.6f, 0.5f), 0.4f))));
  EXPECT_FALSE(is_mirror(shape_of(metal(vec3(0.9f), 0.6f)))) << "rough";
  EXPECT_FALSE(is_mirror(shape_of(metal(vec3(0.02f), 0.0f)))) << "dark";
  Material plastic = metal(vec3(0.5f), 0.0f);
  plastic.metallic = 0.0f;
  EXPECT_FALSE(is_mirror(shape_of(plastic)));
  EXPECT_FALSE(is_mirror(encode_albedo_shape(lambert_reflectance(vec3(0.9f)))));
}

TEST(Mirrors, AreFoundAmongMaterialsWhateverTheirTexturesSay) {
  Material textured = metal(vec3(0.9f), 1.0f);
  EXPECT_FALSE(may_be_mirror(textured));
  textured.metallic_roughness_texture.texture = 0;
  EXPECT_TRUE(may_be_mirror(textured));
  Material diamond = metal(vec3(0.0f), 0.0f);
  diamond.metallic = 0.0f;
  EXPECT_FALSE(may_be_mirror(diamond));
  diamond.ior = 2.4f;
  EXPECT_TRUE(may_be_mirror(diamond));
}

TEST(Mirrors, ShowWhatTheyFace) {
  const vec3 tint(0.9f, 0.6f, 0.5f);
  const Scene scene = facing(test::lambert(vec3(0.5f, 0.7f, 0.2f)), metal(tint, 0.0f));
  const World world(scene);
  const ShadedHit mirror = shade(world, kTowardsMirror, false);
  const ShadedHit shown = shade(world, kTowardsMirror, true);
  EXPECT_EQ(mirror.surface.mirror_distance, 0.0f);
  EXPECT_NEAR(shown.surface.mirror_distance, 1.0f, kTolerance);
  EXPECT_NEAR(shown.point.position_ws.x, 2.0f, kTolerance);
  EXPECT_NEAR(length(shown.point.position_ws - vec3(2.0f, 0.0f, 0.0f)), 0.0f, kSpread);
  EXPECT_NEAR(shown.point.viewer_distance, 2.0f, kSpread);
  EXPECT_LT(dot(shown.point.normal_ws, vec3(1.0f, 0.0f, 0.0f)), -1.0f + kTolerance);
  EXPECT_EQ(shown.surface.material, static_cast<uint>(kWall));
  EXPECT_EQ(shown.surface.gi_share, 1.0f);

  // The light of the wall, in the mirror's tint, is added to the mirror's own direct light
  const Ray straight{vec3(0.0f), 0.5f, normalize(shown.point.position_ws), kInfiniteDistance,
                     kRayOfProbe};
  const ShadedHit wall = shade(world, straight, true);
  const vec3 tinted = kPi * mirror.surface.albedo_over_pi * reflected(wall);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(reflected(shown)[c], reflected(mirror)[c] + tinted[c], kTolerance) << c;
    EXPECT_NEAR(shown.surface.albedo_over_pi[c],
                kPi * mirror.surface.albedo_over_pi[c] * wall.surface.albedo_over_pi[c], kTolerance)
        << c;
  }
}

TEST(Mirrors, ReflectTheSkyWithoutLookups) {
  Scene scene = facing(test::lambert(vec3(0.5f)), metal(vec3(0.8f), 0.2f));
  scene.instances.pop_back();
  scene.lights.clear();
  scene.environment.radiance = vec3(3.0f, 2.0f, 1.0f);
  const World world(scene);
  const ShadedHit mirror = shade(world, kTowardsMirror, false);
  const ShadedHit shown = shade(world, kTowardsMirror, true);
  EXPECT_EQ(shown.surface.gi_share, 0.0f);
  EXPECT_EQ(shown.surface.flags & kSurfaceMissed, 0u);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(reflected(shown)[c],
                kPi * mirror.surface.albedo_over_pi[c] * scene.environment.radiance[c], kTolerance)
        << c;
  }
}

TEST(Mirrors, KeepTheirOwnLightWhereTheyShowBlack) {
  const Scene scene = facing(test::lambert(vec3(0.0f)), metal(vec3(0.9f), 0.3f));
  const World world(scene);
  const vec3 mirror = reflected(shade(world, kTowardsMirror, false));
  const vec3 shown = reflected(shade(world, kTowardsMirror, true));
  ASSERT_GT(mirror.x, 0.0f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], mirror[c], kTolerance * mirror[c]) << c;
}

TEST(Mirrors, ThatFaceEachOtherEndRays) {
  const Scene scene = facing(metal(vec3(0.9f), 0.0f), metal(vec3(0.9f), 0.0f));
  const World world(scene);
  const ShadedHit shown = shade(world, kTowardsMirror, true);
  // After an odd number of mirrors the other one is shown, as a surface that the field lights
  static_assert(kMaxMirrors % 2 == 1);
  EXPECT_NEAR(shown.point.position_ws.x, 2.0f, kTolerance);
  EXPECT_NEAR(shown.surface.mirror_distance, 1.0f, kTolerance);
  EXPECT_EQ(shown.surface.gi_share, 1.0f);
}

TEST(Mirrors, TurnDirectionsOutOfTheSurface) {
  const uint shape = shape_of(metal(vec3(0.9f), 0.49f));
  const vec3 normal = normalize(vec3(0.3f, 0.0f, 1.0f)), geometric(0.0f, 0.0f, 1.0f);
  const vec3 to_viewer = normalize(vec3(-0.95f, 0.0f, 0.31f));
  RandomStream random = make_random_stream(1u, 2u, 3u);
  for (int i = 0; i < 200; ++i) {
    const vec3 direction =
        sample_mirror(shape, normal, geometric, to_viewer, next_uniform2(random));
    EXPECT_GE(dot(direction, geometric), 0.0f);
    EXPECT_NEAR(length(direction), 1.0f, kTolerance);
  }
}

}  // namespace
}  // namespace lambent::mirrors_test
