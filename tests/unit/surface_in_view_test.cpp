// SPDX-License-Identifier: Apache-2.0
// Surfaces that pixels show: textures and bumps are averaged over a footprint.
#include <gtest/gtest.h>

#include <cmath>

#include "raytracing/surface.h"
#include "shared/random.h"
#include "support/hand_made.h"

namespace lambent::surface_in_view_test {
namespace {

/// A unit square in the plane z = 0 that faces +Z.
Scene square(const Material& material) {
  Scene scene;
  scene.materials = {material};
  test::add(scene, test::quad({-0.5f, -0.5f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  return scene;
}

/// A texture of 64 x 64 texels, which a function of column and row gives, without MIPs.
template <class TexelAt>
Texture texture_of(TexelAt texel_at) {
  constexpr int kEdge = 64;
  Texture texture;
  TextureLevel level;
  level.width = level.height = kEdge;
  for (int i = 0; i < kEdge * kEdge; ++i) {
    const glm::u8vec4 texel = texel_at(i % kEdge, i / kEdge);
    level.rgba.insert(level.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
  }
  texture.levels.push_back(std::move(level));
  return texture;
}

/// A texture of which each second block of 2 x 2 texels is the other one.
Texture checked_texture(const glm::u8vec4& one, const glm::u8vec4& other) {
  return texture_of([&](int x, int y) { return (x / 2 + y / 2) % 2 == 0 ? one : other; });
}

/// A normal map's texel for a normal of any length; its alpha has no meaning.
glm::u8vec4 map_texel(const glm::vec3& normal) {
  const glm::vec3 n = 127.5f * glm::normalize(normal) + 127.5f;
  return {std::lround(n.x), std::lround(n.y), std::lround(n.z), 40};
}

constexpr Ray kRay{{0.1043f, 0.2021f, 1.0f}, 0.0f, {0.0f, 0.0f, -1.0f}};

Surface seen(const Scene& scene, float footprint) {
  return seen_surface_at(scene, kRay, make_embree_raytracer(scene)->closest_hit(kRay), footprint);
}

TEST(SurfaceInView, ShowsTheMeanOfItsFootprint) {
  Material material = test::lambert(glm::vec3(1.0f));
  material.base_color_texture.texture = 0;
  Scene scene = square(material);
  scene.textures = {checked_texture({255, 255, 255, 255}, {0, 0, 0, 255})};
  build_mips(scene.textures[0]);
  EXPECT_NEAR(seen(scene, 0.1f).reflectance.diffuse.x, 0.5f, 0.01f);
  // Smaller than a texel, it shows what the texel is
  const Surface near = seen(scene, 1e-4f),
                full = surface_at(scene, kRay, make_embree_raytracer(scene)->closest_hit(kRay));
  EXPECT_EQ(near.reflectance.diffuse.x, full.reflectance.diffuse.x);
  EXPECT_EQ(near.normal_ws, full.normal_ws);
}

TEST(SurfaceInView, BumpsThatAFootprintAveragesOverMakeItsCoatRougher) {
  // Normals lean by this slope to either side
  constexpr float kSlope = 0.25f;
  const glm::u8vec4 right = map_texel({kSlope, 0.0f, 1.0f}),
                    left = map_texel({-kSlope, 0.0f, 1.0f});
  Material material;
  material.roughness = 0.3f;
  material.normal_texture.texture = 0;
  Scene scene = square(material);
  scene.textures = {checked_texture(right, left)};
  build_normal_mips(scene.textures[0]);
  const float own = 0.3f * 0.3f;
  EXPECT_EQ(seen(scene, 1e-4f).reflectance.alpha, own);
  // Their mean is upright. Along both axes together the slopes' variance is the slope's square
  const Surface far = seen(scene, 0.2f);
  EXPECT_GT(far.normal_ws.z, 0.999f);
  const float expected = std::sqrt(own * own + 0.5f * kGgxOverVariance * kSlope * kSlope);
  EXPECT_NEAR(far.reflectance.alpha, expected, 0.05f * expected);
  // Where all lean alike, nothing is averaged over but 8-bit rounding
  scene.textures = {checked_texture(right, right)};
  build_normal_mips(scene.textures[0]);
  EXPECT_EQ(seen(scene, 0.2f).reflectance.alpha, own);
}

TEST(SurfaceInView, AFewSteepBumpsMakeNoCoatRougher) {
  // Tiles of 32 texels, whose edges lean steeply: a quarter of all normals
  Material material;
  material.roughness = 0.2f;
  material.normal_texture.texture = 0;
  Scene scene = square(material);
  const auto tiles = [](int x, int y) {
    const auto lean = [](int i) { return i % 32 < 2 ? -1.0f : i % 32 < 4 ? 1.0f : 0.0f; };
    return map_texel({lean(x), lean(y), 1.0f});
  };
  scene.textures = {texture_of(tiles)};
  build_normal_mips(scene.textures[0]);
  const float own = 0.2f * 0.2f;
  for (const float footprint : {0.5f, 0.9f}) {
    EXPECT_NEAR(seen(scene, footprint).reflectance.alpha, own, 0.3f * own) << footprint;
  }
  // Where most normals scatter, it is rougher
  const auto rough = [&](int x, int y) {
    RandomStream random = make_random_stream(static_cast<uint>(64 * (y / 2) + x / 2), 0, 1);
    const glm::vec2 lean = next_uniform2(random) - 0.5f;
    return map_texel({lean, 1.0f});
  };
  scene.textures = {texture_of(rough)};
  build_normal_mips(scene.textures[0]);
  // Slopes have a variance of 1 / 12 along each axis
  const float expected = std::sqrt(own * own + kGgxOverVariance / 12.0f);
  EXPECT_NEAR(seen(scene, 0.5f).reflectance.alpha, expected, 0.2f * expected);
}

}  // namespace
}  // namespace lambent::surface_in_view_test
